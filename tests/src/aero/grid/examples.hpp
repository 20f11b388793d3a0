// Grids that several tests use: boxes cut into blocks whose indices are turned at random.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/split.hpp"
#include "src/aero/grid/store.hpp"
#include "src/aero/grid/tiling.hpp"

namespace spindrift::aero {

inline std::vector<Index> right_handed_axes(bool planar) {
  std::vector<Index> all;
  for (int a = -3; a <= 3; ++a)
    for (int b = -3; b <= 3; ++b)
      for (int c = -3; c <= 3; ++c) {
        if (a * b * c == 0 || std::abs(a) == std::abs(b) || std::abs(b) == std::abs(c) || std::abs(a) == std::abs(c)) continue;
        if (planar && c != 3) continue;
        if (IndexMap{{a, b, c}, {}}.handedness() == 1) all.push_back({a, b, c});
      }
  return all;
}

inline void turn_blocks(MultiBlockGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  const auto all = right_handed_axes(grid.planar);
  for (int b = 0; b < int(grid.blocks.size()); ++b) reorient(grid, b, all[random() % all.size()]);
}

/// Eight blocks (four in a planar grid) of uneven size, turned.
inline MultiBlockGrid turned_box(const MultiBlockGrid& box, unsigned seed) {
  const Block& b = box.blocks[0];
  const std::array<std::vector<int>, 3> cuts{
      {{b.ni / 2 - 1}, {b.nj / 2}, box.planar ? std::vector<int>{} : std::vector<int>{b.nk / 2 + 1}}};
  MultiBlockGrid grid = split_at(box, std::span(&cuts, 1));
  turn_blocks(grid, seed);
  return grid;
}

}  // namespace spindrift::aero
