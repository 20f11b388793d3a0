// Is this a grid the solver can run on? Sizes, positive volumes, each face of each side in one connection or boundary,
// connections that fit in shape, handedness and coordinates. Called after a grid is read or generated; tested in
// tests/src/aero/grid/checks_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

struct CheckOptions {
  double match_tolerance = 1e-3;  ///< how far two nodes that a connection joins may lie apart, in shortest edges beside them
  int examples = 3;               ///< places named of each kind of fault in each block
  bool nodes = true;              ///< else only what can be told without them
};

/// What is wrong, each a sentence that names block and cell; empty where nothing is.
std::vector<std::string> grid_faults(const MultiBlockGrid& grid, const CheckOptions& options = {});

/// Throws scene::SceneError where there are more ranks than tiles: each needs one.
void require_ranks(std::size_t tiles, int ranks);

/// Throws scene::SceneError with all faults; `source` is the file or the key that asked for the grid.
void require_sound(const MultiBlockGrid& grid, const std::string& source, const CheckOptions& options = {});

}  // namespace spindrift::aero
