// Wall that the gas sticks to, resolved by the grid. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition no_slip_condition{.name = "no_slip",
                                                 .help = "wall; adiabatic where it has no temperature_K",
                                                 .keys = {"temperature_K"},
                                                 .surface = Surface::no_slip,
                                                 .ghosts = no_slip_ghosts,
                                                 .fold = fold_no_slip};

}  // namespace spindrift::aero
