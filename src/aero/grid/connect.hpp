// Finds where blocks meet from coordinates alone, for grids that come without connectivity: side faces whose corners coincide,
// gathered into windows. Called after read_plot3d where no neutral map is given; tested in tests/src/aero/grid/files_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Adds connections for all faces that coincide (within `tolerance` of their shortest edge) and boundaries for all others, a
/// patch per side named BLOCK:SIDE ("2:j_min"). Periodic sides coincide with nothing: they become boundaries. Existing windows
/// are replaced.
void connect_by_coordinates(MultiBlockGrid& grid, double tolerance = 1e-3);

/// Sets the periodic map of a connection whose windows do not lie on one another: a translation, else the rigid motion of least
/// squares (Kabsch 1976). Returns 0, or how far nodes lie apart under the best motion where none fits.
double find_periodic_map(const MultiBlockGrid& grid, Connection& connection);

}  // namespace spindrift::aero
