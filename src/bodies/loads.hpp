// Loads that belong to the bodies themselves: weight, and constant forces and moments at points.
// Springs and dampers between bodies are mooring lines (src/moorings, model spring_damper with anchor_body).
// Used by src/coupling; tested in tests/src/bodies/system_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/bodies/model.hpp"

namespace spindrift::bodies {

/// Weight of every body, `gravity` m/s2 along `down`.
LoadSource gravity_source(std::span<const Body> bodies, double gravity_m_s2,
                          const Eigen::Vector3d& down = -Eigen::Vector3d::UnitZ());

/// A constant force and moment at a point of a body.
struct PointLoad {
  int body = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< body axes, from the centre of mass [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
  bool follows_body = false;                         ///< force and moment turn with the body; else they keep earth axes
};
LoadSource point_load_source(std::string name, std::vector<PointLoad> loads);

}  // namespace spindrift::bodies
