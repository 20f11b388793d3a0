// Plane of symmetry. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition symmetry_condition{
    .name = "symmetry",
    .help = "plane of symmetry",
    .surface = Surface::mirror,
    .ghosts =
        [](const BoundaryFace& at) {
          return Ghosts{gas::mirrored(at.inside, at.face), gas::mirrored(at.next(), at.face)};
        },
    .fold = fold_mirror};

}  // namespace spindrift::aero
