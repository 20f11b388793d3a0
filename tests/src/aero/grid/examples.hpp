// What several tests of grids use: boxes cut into blocks whose indices are turned at random, small tiles, files that go.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
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

/// Tiles so small that an example has many.
inline constexpr TilingOptions small_tiles{.across_j = 4, .across_k = 3, .planar_across = 4, .normal = 5, .planar_normal = 5};

/// A file that goes with the test.
struct ScratchFile {
  std::filesystem::path path;
  explicit ScratchFile(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("spindrift_grid_" + std::to_string(::getpid()) + "_" + name)) {}
  ~ScratchFile() { std::filesystem::remove(path); }
  void write(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
};

}  // namespace spindrift::aero
