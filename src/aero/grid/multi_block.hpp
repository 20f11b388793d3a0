// A structured multi-block grid as geometry: blocks of nodes, how their sides meet, and which sides bound the flow.
// What generators make, readers read and writers write; the solver cuts it into tiles (tiling.hpp) and does not use this again.
// Used throughout src/aero; tested in tests/src/aero/grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::aero {

/// ni x nj x nk cells between (ni+1)(nj+1)(nk+1) nodes; i fastest, then j, then k. (i, j, k) is right-handed: every cell's volume
/// is positive.
struct Block {
  std::string name;
  int ni = 0, nj = 0, nk = 0;
  std::vector<Eigen::Vector3d> nodes;  ///< [m]
  std::size_t node(int k, int j, int i) const { return (std::size_t(k) * (nj + 1) + j) * (ni + 1) + i; }
  std::array<int, 3> cells() const { return {ni, nj, nk}; }
};

/// Side 2d is where index d (0: i, 1: j, 2: k) begins, 2d + 1 where it ends.
enum class Side : std::uint8_t { i_min, i_max, j_min, j_max, k_min, k_max };
inline int direction_of(Side side) { return int(side) / 2; }
inline bool at_end(Side side) { return int(side) % 2 == 1; }

/// A rectangle of cell faces on one side of a block: cells [low, high) in the two directions along the side, lower direction
/// first.
struct Window {
  int block = 0;
  Side side = Side::i_min;
  std::array<int, 2> low{}, high{};
};

/// x' = rotation x + translation.
struct RigidMap {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// Two windows whose faces are the same one by one (1-to-1). Walking along index d of `from.block` is walking along index
/// |orientation[d]| - 1 of `to.block`, backwards where negative; for the direction across, that is out of `from` and into `to`.
/// A connection stands once, not once for each side.
struct Connection {
  Window from, to;
  std::array<int, 3> orientation{1, 2, 3};
  std::optional<RigidMap> periodic = {};  ///< carries points of `from` onto those of `to`
};

/// A window where the flow meets a boundary condition, chosen by the patch's name in the scene.
struct Boundary {
  Window where;
  std::string patch;
};

/// Each face of each block's sides is in exactly one connection or boundary; in a planar grid (one cell in k, flow in the x-z
/// plane, k along -y or y so that volumes are positive) the sides of k are in none.
struct MultiBlockGrid {
  std::vector<Block> blocks;
  std::vector<Connection> connections;
  std::vector<Boundary> boundaries;
  bool planar = false;
};

/// Layers of cells along k of a grid's blocks, with the nodes of these only: what a rank has at once of a grid that is never
/// whole anywhere. Block b has the layers from `first[b]` of the whole on; those behind the first `count[b]` are there to be
/// compared with, and counted in the part that follows. A block may have none, and then no nodes.
struct GridLayers {
  MultiBlockGrid grid;
  std::vector<int> first, count;
};

/// What of a window of a part lies on layers that it counts; empty (high[1] <= low[1]) where nothing does.
inline Window counted(const GridLayers& part, Window w) {
  const int count = part.count[std::size_t(w.block)], nk = part.grid.blocks[std::size_t(w.block)].nk;
  if (direction_of(w.side) != 2)
    w.high[1] = w.high[1] < count ? w.high[1] : count;  // k is the second direction along the side
  else if (at_end(w.side) ? count < nk : count == 0)
    w.high[1] = w.low[1];
  return w;
}

/// Least and greatest coordinates [m].
struct Corners {
  Eigen::Vector3d low, high;
};
inline Corners corners(const MultiBlockGrid& grid) {
  Corners c{grid.blocks.at(0).nodes.at(0), grid.blocks.at(0).nodes.at(0)};
  for (const Block& block : grid.blocks)
    for (const Eigen::Vector3d& x : block.nodes) c.low = c.low.cwiseMin(x), c.high = c.high.cwiseMax(x);
  return c;
}

}  // namespace spindrift::aero
