// Conventional serial staggering. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/coupling_options.hpp"

namespace spindrift::coupling {

extern const CouplingScheme css_scheme{
    .name = "css",
    .help = "bodies first on extrapolated loads, then the rotor on their motion: order predictor_order + 1",
    .keys = {"predictor_order", "accept_unstable"},
    .staggering = [](const CouplingOptions& o) { return Staggering::css(o.predictor_order); },
    .limits = {.added_mass = [](double ratio) { return css_polynomial(1, ratio); },
               .damping = [](double share) { return css_damping_polynomial(1, share); }},
    .judged = "css1"};

}  // namespace spindrift::coupling
