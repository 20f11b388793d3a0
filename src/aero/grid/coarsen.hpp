// A grid of every second node, for marches that begin on coarser grids. Called by src/run/flow_case.cpp and perf/air; tested
// in tests/src/aero/flow/transfer_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Why every second node makes no grid of the same blocks, windows and patches: which count or edge of a window is odd. Empty
/// where it does. Directions of one cell (k of planar grids) stay as they are.
std::string why_not_halved(const MultiBlockGrid& grid);

/// The grid of every second node; it must have passed why_not_halved().
MultiBlockGrid halved(const MultiBlockGrid& grid);

}  // namespace spindrift::aero
