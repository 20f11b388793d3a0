// Characteristic far field. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition far_field_condition{
    .name = "far_field", .help = "characteristic: the undisturbed wind outside", .ghosts = [](const BoundaryFace& at) {
      const auto q = gas::far_field(at.setting.gas, at.inside, at.stream(), at.face, at.setting.reference_speed);
      return Ghosts{q, q};
    }};

}  // namespace spindrift::aero
