// Conventional parallel staggering. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme cps_scheme{
    .name = "cps",
    .help = "both at once on what they had at the window's start, as in Leble & Barakos (2016): first order",
    .keys = {"accept_unstable"},
    .staggering = [](const CouplingOptions&) { return Staggering::cps(); },
    .limits = {.added_mass = cps_polynomial, .damping = cps_damping_polynomial},
    .judged = "cps"};

}  // namespace spindrift::coupling
