// Nested grids: every second node of a multi-block grid. Used by the generators of this folder; tested in
// tests/src/aero/rotor_grid/rotor_grid_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Of a grid in three dimensions. Throws NumericalFailure where a block's cells or a window's edges are odd numbers.
MultiBlockGrid coarsened(const MultiBlockGrid& fine);

}  // namespace spindrift::aero
