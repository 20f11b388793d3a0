// Outflow of known pressure. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition outflow_condition{.name = "outflow",
                                                 .help = "pressure given, all else from inside",
                                                 .ghosts =
                                                     [](const BoundaryFace& at) {
                                                       const auto q =
                                                           gas::outflow_pressure(at.setting.gas, at.inside, at.stream(), at.face);
                                                       return Ghosts{q, q};
                                                     },
                                                 .fold =
                                                     [](const FoldedFace& at) {
                                                       for (int c = 1; c < 5; ++c) at.follow(c, 1.0f, c);
                                                     }};

}  // namespace spindrift::aero
