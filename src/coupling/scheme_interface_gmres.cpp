// Newton with a Krylov method on the interface. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/interface_gmres.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme interface_gmres_scheme{
    .name = "interface_gmres",
    .help = "Newton with a Krylov method on the interface",
    .keys = strong_keys({"composition", "relaxation", "reuse_windows", "filter"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(InterfaceGmres(o.relaxation, learning(o))); }};

}  // namespace spindrift::coupling
