// The nodes of one coaxial surface of a rotor grid: the O round the section, the H lines of the sector, the plug beyond the tip.
// Recipe: docs/theory/rotor_grid.md. Called by rotor_grid.cpp, each surface by itself; tested in
// tests/src/aero/rotor_grid/rotor_grid_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <vector>

#include "kernels/grid/elliptic.hpp"
#include "src/aero/rotor_grid/layout.hpp"

namespace spindrift::aero {

/// Nodes (s, x) of r = const.
struct Plane {
  double r = 0.0;
  RingShape ring{};  ///< i from the trailing edge along the pressure side, j outward
  std::vector<Eigen::Vector2d> ring_nodes;
  int across = 0, axial = 0;             ///< cells of the H lines, the box included
  std::vector<Eigen::Vector2d> h_nodes;  ///< at J + (across + 1) I, J along s, I along x
  int chordwise = 0, edge = 0;           ///< cells of the plug
  std::vector<Eigen::Vector2d>
      plug_nodes;  ///< at i + (chordwise + 1) j, i towards the leading edge, j towards the suction side; none inboard
  const Eigen::Vector2d& h(int J, int I) const { return h_nodes[std::size_t(I) * std::size_t(across + 1) + std::size_t(J)]; }
  const Eigen::Vector2d& plug(int i, int j) const {
    return plug_nodes[std::size_t(j) * std::size_t(chordwise + 1) + std::size_t(i)];
  }
};

/// Node (J, I) of the H lines that node i of the O's outer side lies on.
struct BoxNode {
  int J, I;
};
BoxNode box_node(const RotorGridSizes& sizes, int roll, int i);

/// Surface k of the layout.
Plane make_plane(const BladeSurface& blade, const RotorLayout& layout, int k);

}  // namespace spindrift::aero
