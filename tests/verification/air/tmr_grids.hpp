// Grids of NASA's Turbulence Modeling Resource as multi-block grids: the C grid round a NACA 0012 aerofoil.
// Used by tests/verification/air and perf/air. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero::testing {

/// Two-dimensional formatted Plot3D, one block: i as in the file, j away from the first line, one cell of width 1 m.
inline Block read_plane(const std::string& path) {
  std::ifstream file(path);
  int blocks = 0, ni = 0, nj = 0;
  if (!(file >> blocks >> ni >> nj) || blocks != 1) throw std::runtime_error("cannot read " + path);
  std::vector<double> x(std::size_t(ni) * nj), z(x.size());
  for (double& value : x) file >> value;
  for (double& value : z) file >> value;
  if (!file) throw std::runtime_error("too few numbers in " + path);
  Block block{.name = "plane", .ni = ni - 1, .nj = nj - 1, .nk = 1, .nodes = {}};
  // (i, j) turns right-handed about -y, so k runs along -y.
  for (int k = 0; k < 2; ++k)
    for (std::size_t n = 0; n < x.size(); ++n) block.nodes.emplace_back(x[n], -double(k), z[n]);
  return block;
}

/// The C grid: wake cut, aerofoil ("wall") and far field ("far"). Cells along the cut on either side: `wake`.
inline MultiBlockGrid tmr_c_grid(const std::string& path, int wake) {
  MultiBlockGrid grid;
  grid.planar = true;
  grid.blocks.push_back(read_plane(path));
  const int ni = grid.blocks[0].ni, nj = grid.blocks[0].nj;
  grid.connections.push_back({.from = {0, Side::j_min, {0, 0}, {wake, 1}},
                              .to = {0, Side::j_min, {ni - wake, 0}, {ni, 1}},
                              .orientation = {-1, -2, 3}});
  grid.boundaries.push_back({{0, Side::j_min, {wake, 0}, {ni - wake, 1}}, "wall"});
  grid.boundaries.push_back({{0, Side::j_max, {0, 0}, {ni, 1}}, "far"});
  grid.boundaries.push_back({{0, Side::i_min, {0, 0}, {nj, 1}}, "far"});
  grid.boundaries.push_back({{0, Side::i_max, {0, 0}, {nj, 1}}, "far"});
  return grid;
}

}  // namespace spindrift::aero::testing
