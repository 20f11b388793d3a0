// Iteration with a constant factor. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/relaxation_constant.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme relaxation_scheme{
    .name = "relaxation",
    .help = "iterated with a constant factor; 1 is the plain fixed point",
    .keys = strong_keys({"composition", "relaxation"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(RelaxationConstant(o.relaxation)); }};

}  // namespace spindrift::coupling
