// Lines in the log while a large rotor grid, its tiles and its wall distances are made, which takes half a minute at the paper's
// size. Used by resolved_air.cpp and src/run/flow_case.cpp; tested in tests/src/coupling/grid_progress_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/rotor_grid/rotor_grid.hpp"

namespace spindrift::coupling {

/// Says what is being made every 10 s, with the time that is left of it; small grids are done before. `clock` gives seconds
/// (tests bring their own).
aero::GridProgress grid_progress(std::function<double()> clock = {});

}  // namespace spindrift::coupling
