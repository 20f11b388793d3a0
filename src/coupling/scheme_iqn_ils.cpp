// Interface quasi-Newton, inverse Jacobian by least squares. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/iqn_ils.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme iqn_ils_scheme{
    .name = "iqn_ils",
    .help = "interface quasi-Newton, inverse Jacobian by least squares",
    .keys = strong_keys({"composition", "relaxation", "reuse_windows", "filter"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(IqnIls(o.relaxation, learning(o))); }};

}  // namespace spindrift::coupling
