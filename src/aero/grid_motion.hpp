// A resolved flow's grid that follows walls which turn and heave: [aero.flow.motion]. The whole grid moves as the walls do, or
// each node takes a share of their motion that an elliptic problem spreads between what moves and what is held
// (grid/node_field.hpp). Rigid motions taken in part, not displacements: cells near the walls turn with them and keep their
// shape. Options declared in grid_motion.cpp; used by src/run/flow_case.cpp; tested in tests/src/aero/grid_motion_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid_motion_options.hpp"

namespace spindrift::aero {

/// A turn (rotation vector [rad]) about a centre, then a shift [m].
struct TurnAndShift {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), centre = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
};
/// Where a share of the motion takes a point; none leaves every bit.
Eigen::Vector3d moved(const TurnAndShift& motion, double share, const Eigen::Vector3d& x);

class GridMotion {
 public:
  /// `grid` as made; it must outlive this. `held` and `sliding`: patches that stay, and that keep to their plane; all others
  /// move. Throws scene::SceneError where a patch cannot do so, or cells fold at an extreme of the motion.
  GridMotion(const MultiBlockGrid& grid, const GridMotionOptions& options, const std::vector<std::string>& held,
             const std::vector<std::string>& sliding);

  TurnAndShift at(double t) const;
  Eigen::Vector3d axis() const;
  /// Of all blocks at time t [s].
  std::vector<BlockPose> poses(double t) const;
  MultiBlockGrid moved_grid(double t) const;
  /// For people: how the grid follows.
  std::string description() const;
  const std::vector<std::vector<double>>& shares() const { return shares_; }  ///< by block and node; empty where all move as one

 private:
  void check_plane() const;
  void check_patches(const std::vector<std::string>& sliding) const;
  void check_cells(double t) const;

  const MultiBlockGrid& grid_;
  GridMotionOptions options_;
  std::vector<std::vector<double>> shares_;
  int unknowns_ = 0, cycles_ = 0;
};

}  // namespace spindrift::aero
