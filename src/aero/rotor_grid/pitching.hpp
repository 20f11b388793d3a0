// Blade pitch as motion of a rotor grid's nodes: near the blade they turn rigidly about its axis, towards the box of the O-grid
// and outboard of the tip the turn fades to nothing. Positions are a function of the pitch alone, so that a moving grid may be
// put anywhere at any time. Used where blades pitch during a run; tested in tests/src/aero/rotor_grid/pitching_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/rotor_grid/layout.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// Radii of the surfaces of nodes of a ring, or of layers of it [m].
std::vector<double> surface_radii(const Block& ring);

class BladePitching {
 public:
  /// Of a grid made from the same turbine and spec, whose nodes are those of zero change. `described`: its blocks, whose nodes
  /// are not needed; `radii`: of its surfaces of nodes [m], by k of the ring. Rows follow.
  BladePitching(const MultiBlockGrid& described, std::span<const double> radii, const Turbine& turbine,
                const RotorGridSpec& spec);
  /// Rings of a part of the grid. `needed`: which k will be asked for, as a rule those of this rank's tiles; none: all.
  void add_rows(const GridLayers& part, const std::function<bool(int k)>& needed);

  /// Only ring and plug of a sector move.
  bool moves(int block) const { return block % blocks_of_sector < 2; }
  /// Where a node as made goes, or all nodes of a block, when the blade's pitch has changed by `change` [rad] from the grid's,
  /// nose into the wind positive. Good for changes up to about 20 deg (docs/theory/rotor_grid.md); beyond, make a grid at a pitch
  /// nearby.
  Eigen::Vector3d node(int block, int k, int j, int i, double change, const Eigen::Vector3d& as_made) const;
  void move(Block& as_made, int block, double change) const;
  /// Share of the turn that node (k, j, i) of a moving block takes: 1 at the blade, 0 at the box.
  double share(int block, int k, int j, int i) const;
  /// Unit vector along the blade of a block's sector.
  Eigen::Vector3d axis(int block) const;

  static constexpr int blocks_of_sector = 10;
  /// Within which grids of all resolutions stay whole and their cells good [rad].
  static constexpr double most_change = 15.0 * radians_per_degree;

 private:
  int blades_;
  double precone_, hub_radius_, root_chord_;
  std::vector<std::vector<double>> ring_share_;  ///< of sector 1, by k as its nodes, where needed; all sectors are alike
  std::vector<double> outboard_;                 ///< by k of the ring
  int span_, ring_row_;                          ///< nodes of a ring's i
};

}  // namespace spindrift::aero
