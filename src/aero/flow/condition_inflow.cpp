// Inflow of known velocity and temperature. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition inflow_condition{
    .name = "inflow",
    .help = "wind and temperature given, pressure from inside; all given where the wind is faster than sound",
    .ghosts =
        [](const BoundaryFace& at) {
          const auto q = gas::inflow_velocity(at.setting.gas, at.inside, at.stream(), at.face);
          return Ghosts{q, q};
        },
    .fold = [](const FoldedFace& at) { at.follow(0, 1.0f, 0); }};

}  // namespace spindrift::aero
