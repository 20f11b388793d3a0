// Where loads along a blade are taken from a rotor grid: one station for each row of wall faces, with its directions. What the
// solver sums over the faces of a row becomes newtons per metre here. Used by the loads of a resolved rotor; tested in
// tests/src/aero/rotor_grid/pitching_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <vector>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// A row of wall faces between two coaxial surfaces; rotor frame.
struct BladeStation {
  int block = 0, k = 0;      ///< faces (k, j, i = 0) of the block, all j
  double radius = 0.0;       ///< of its middle [m]
  double length = 0.0;       ///< difference of the surfaces' radii [m]
  double chord = 0.0;        ///< from the leading edge to the middle of the trailing edge, mean of both surfaces [m]
  double wetted_area = 0.0;  ///< sum of the faces' areas [m2]
  Eigen::Vector3d quarter = Eigen::Vector3d::Zero();     ///< point at a quarter of the chord [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();      ///< downwind along the rotor's axis
  Eigen::Vector3d tangential = Eigen::Vector3d::Zero();  ///< in the direction of rotation, in the rotor's plane
  Eigen::Vector3d chordwise = Eigen::Vector3d::Zero();   ///< from trailing to leading edge, unit
};

/// Load per length of radius [N/m].
struct StationLoad {
  double normal = 0.0, tangential = 0.0;
};
inline StationLoad load_at(const BladeStation& s, const Eigen::Vector3d& force) {
  return {force.dot(s.normal) / s.length, force.dot(s.tangential) / s.length};
}

/// Appends, for each blade, the stations of the layers that a part of a rotor's grid counts, from root to tip: found by the walls
/// named blade_N.
void add_stations(const GridLayers& part, std::vector<std::vector<BladeStation>>& blades);

}  // namespace spindrift::aero
