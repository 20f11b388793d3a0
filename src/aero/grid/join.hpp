// Cuts of a grid, where one side of a block meets itself as behind the body of a C grid, moved into the middle of a block. The
// cells beside such a cut are a wake's, flat and strongly coupled across it; an approximate inverse by tiles takes what lies in
// another tile for a wall. Called by src/aero/flow_grid.cpp; tested in tests/src/aero/grid/join_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// The same cells, in other blocks: each block whose side meets itself is split at the ends of that cut, and the parts on both
/// sides of it become one. Cuts whose lines would be longer than `longest` cells stay. The grid must have passed check().
MultiBlockGrid join_cuts(MultiBlockGrid grid, int longest);

}  // namespace spindrift::aero
