// Iteration with the factor of steepest descent. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/relaxation_steepest_descent.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme steepest_descent_scheme{
    .name = "steepest_descent",
    .help = "iterated with the factor of steepest descent, two evaluations each",
    .keys = strong_keys({"composition", "relaxation"}),
    .strong = [](const CouplingOptions& o) { return strong_scheme(RelaxationSteepestDescent(o.relaxation)); }};

}  // namespace spindrift::coupling
