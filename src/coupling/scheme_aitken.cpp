// Iteration with Aitken's factor. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/relaxation_aitken.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme aitken_scheme{
    .name = "aitken",
    .help = "iterated with Aitken's factor",
    .keys = strong_keys({"composition", "relaxation"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(RelaxationAitken(o.relaxation)); }};

}  // namespace spindrift::coupling
