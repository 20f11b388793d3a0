// Parallel staggering on extrapolated data. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme cps2_scheme{.name = "cps2",
                                        .help = "both at once on data extrapolated linearly: second order at the same cost",
                                        .keys = {"accept_unstable"},
                                        .staggering = [](const CouplingOptions&) { return Staggering::cps2(); },
                                        .added_mass = [](const CouplingOptions&, double ratio) { return cps2_polynomial(ratio); },
                                        .judged = [](const CouplingOptions&) { return std::string("cps2"); }};

}  // namespace spindrift::coupling
