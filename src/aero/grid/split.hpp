// The same grid in other blocks: cut into more of them, or with a block's indices turned. For load balance by hand, for imports
// whose blocks are few, and for tests that blocks cost and change nothing. Called by tests and perf/air; tested in
// tests/src/aero/grid/tiling_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid/tiling.hpp"

namespace spindrift::aero {

/// Each block cut at the given cell indices (ascending, inside the block), per block and direction.
MultiBlockGrid split_at(const MultiBlockGrid& grid, std::span<const std::array<std::vector<int>, 3>> cuts);

/// A one-block grid cut into about `parts` blocks (never more) along the boundaries of its tiles, so that the tiles stay as they
/// are.
MultiBlockGrid split(const MultiBlockGrid& grid, int parts, std::span<const std::string> walls,
                     const TilingOptions& options = {});

/// Block `number` re-indexed: its new direction d walks along its old direction |axes[d]| - 1, backwards where negative. Axes
/// that are a mirror image make a left-handed block right-handed.
void reorient(MultiBlockGrid& grid, int number, const Index& axes);

/// The window of a side that covers a layer of cells just inside or outside of it.
Window window_on(int block, Side side, const Box& cells);

}  // namespace spindrift::aero
