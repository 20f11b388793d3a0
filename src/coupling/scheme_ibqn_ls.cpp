// Interface block quasi-Newton. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/ibqn_ls.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme ibqn_ls_scheme{
    .name = "ibqn_ls",
    .help = "interface block quasi-Newton, a model of each part by least squares",
    .keys = strong_keys({"relaxation", "reuse_windows", "filter"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(IbqnLs(o.relaxation, learning(o))); }};

}  // namespace spindrift::coupling
