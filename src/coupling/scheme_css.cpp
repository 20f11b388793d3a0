// Conventional serial staggering. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/coupling_options.hpp"

namespace spindrift::coupling {

extern const CouplingScheme css_scheme{
    .name = "css",
    .help = "bodies first on extrapolated loads, then the rotor on their motion: order 1, 2, 2 for predictor_order 0, 1, 2",
    .keys = {"predictor_order", "accept_unstable"},
    .staggering = [](const CouplingOptions& o) { return Staggering::css(o.predictor_order); },
    .added_mass = [](const CouplingOptions& o, double ratio) { return css_polynomial(o.predictor_order, ratio); },
    .judged = [](const CouplingOptions& o) { return "css" + std::to_string(o.predictor_order); }};

}  // namespace spindrift::coupling
