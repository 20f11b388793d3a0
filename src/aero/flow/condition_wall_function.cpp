// Wall whose friction follows from the law of the wall (docs/theory/air.md). SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition wall_function_condition{
    .name = "wall_function",
    .help = "adiabatic wall on a grid whose first cells stand in the logarithmic layer: friction by the law of the wall",
    .surface = Surface::no_slip,
    .wall_law = true,
    .ghosts = no_slip_ghosts,
    .fold = fold_no_slip};

}  // namespace spindrift::aero
