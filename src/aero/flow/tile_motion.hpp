// Where the blocks of a moving grid are, were and will be, and what moving does to a tile's nodes, metrics and face speeds.
// Face speeds follow from positions, so that any motion keeps a uniform stream. Called by tasks.cpp and by whoever places a
// grid; tested in tests/src/aero/flow and tests/src/aero/grid_motion_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

#include "src/aero/flow/physical_time.hpp"
#include "src/aero/flow/tile_arrays.hpp"

namespace spindrift::aero {

/// Where a block of the grid is at the end of a step: its nodes as made, changed by `shape` where there is one, then carried by
/// `map`.
struct BlockPose {
  RigidMap map;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> shape;
  /// In place of `shape` where it goes by the node's index in its block: (index, node as made) -> node.
  std::function<Eigen::Vector3d(const Index&, const Eigen::Vector3d&)> shape_at = {};
};

class TileMotion {
 public:
  /// Both are to outlive it.
  TileMotion(TileArrays& arrays, const PhysicalTime& time)
      : arrays_(arrays), time_(time), periodic_(arrays.grid.tiling().periodic) {}

  /// Whether the grid was built as moving, in unsteady flow.
  bool moves() const { return time_.unsteady() && !arrays_.tiles.empty() && arrays_.tiles[0].geometry->moving(); }
  /// Where the blocks are at the end of the next physical step, by block, or one pose for all. To be called before each step; a
  /// step without it leaves the grid where it is. Throws std::invalid_argument where the grid cannot move so.
  void move_to(std::vector<BlockPose> poses);
  /// Puts the blocks where the last step left them and, one step before it, `before`: starts and restarts away from the nodes as
  /// made. Two steps before it, which third order asks for, `long_before`; none: the grid stood still until `before`.
  /// What save() keeps of rigid poses is placed by load(); of shapes it keeps nothing, place them after it.
  void place(std::vector<BlockPose> before, std::vector<BlockPose> now, std::vector<BlockPose> long_before = {});

  /// A physical step begins.
  void begin_step();
  /// Nodes, metrics and face speeds of the new time level.
  void move(FlowTile& tile) const;
  /// Maps across periodic links of the grid where it is.
  const std::vector<RigidMap>& periodic() const { return periodic_; }

  /// Rigid poses at present and one step ago, of third order two steps ago too, for a restart.
  void save(std::vector<double>& to) const;
  void load(std::span<const double> from);

 private:
  const BlockPose& pose(const std::vector<BlockPose>& poses, const FlowTile& tile) const;
  void check(const std::vector<BlockPose>& poses) const;

  TileArrays& arrays_;
  const PhysicalTime& time_;
  std::vector<BlockPose> long_before_{1}, before_{1}, now_{1},
      next_{1};  ///< two steps ago, of third order; one step ago; now; at the end of the next step
  std::vector<RigidMap> periodic_;
};

}  // namespace spindrift::aero
