// Newton with a Jacobian by differences. SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/newton.hpp"
#include "src/coupling/strong_scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme newton_scheme{.name = "newton",
                                          .help = "Newton with a Jacobian by differences, one evaluation per row",
                                          .keys = strong_keys({"composition"}),
                                          .strong = [](const CouplingOptions&) { return strong_scheme(Newton(1e-9)); }};

}  // namespace spindrift::coupling
