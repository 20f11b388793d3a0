// Loads that belong to the bodies themselves: weight, constant forces and moments at points, springs and dampers in joints.
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

/// Moment about a joint's axis, or force along it, by how far and how fast body j has turned or slid against body i.
struct JointLaw {
  int i = earth, j = earth;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< axes of body i, unit
  Eigen::Vector3d point_i = Eigen::Vector3d::Zero(),
                  point_j = Eigen::Vector3d::Zero();  ///< body axes, from the centres of mass [m]
  bool turns = true;                                  ///< angle within half a turn; else distance
  double stiffness = 0.0, rest = 0.0;                 ///< [N m/rad, rad] or [N/m, m]
  double damping = 0.0, quadratic_damping = 0.0;      ///< per rate, per rate squared
  double friction = 0.0;                              ///< Coulomb's; below creep_rate it falls to nothing linearly
  std::vector<double> places, loads;                  ///< table of the load on body j, added; may be empty

  static constexpr double creep_rate = 1e-3;  ///< [rad/s], [m/s]

  struct Deflection {
    double place, rate;
  };
  Deflection deflection(std::span<const Motion> bodies) const;
  /// On body j, positive about or along the axis [N m] or [N].
  double load(const Deflection& at) const;
  /// Adds such a load to body j, and its opposite to body i.
  void add(double load, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
};
LoadSource joint_law_source(std::vector<JointLaw> laws);

}  // namespace spindrift::bodies
