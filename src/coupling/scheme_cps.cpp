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
    .added_mass = [](const CouplingOptions&, double ratio) { return cps_polynomial(ratio); },
    .judged = [](const CouplingOptions&) { return std::string("cps"); }};

}  // namespace spindrift::coupling
