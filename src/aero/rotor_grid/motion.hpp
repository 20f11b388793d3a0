// The rotor's grid in the earth frame: nodes turned by the rotor's azimuth about its own axis and carried by the hub's motion.
// Positions are a function of (motion, azimuth), so a window may be repeated. Used where the grid moves; tested in
// tests/src/aero/rotor_grid/motion_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <span>

#include "kernels/rigid/motion.hpp"

namespace spindrift::aero {

/// Where the rotor is: its hub as a rigid body whose axes are the rotor frame at azimuth zero (x the axis downwind, z along blade
/// 1), and how far and how fast it has turned on it, positive about x.
struct RotorPose {
  Motion hub;            ///< position of the hub, attitude, velocity, omega of the body that carries the bearing
  double azimuth = 0.0;  ///< [rad]
  double speed = 0.0;    ///< [rad/s]

  Eigen::Quaterniond attitude() const {
    return hub.attitude * Eigen::Quaterniond(Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitX()));
  }
  /// Angular velocity of the blades, earth frame [rad/s].
  Eigen::Vector3d omega() const { return hub.attitude * (hub.omega + speed * Eigen::Vector3d::UnitX()); }
  /// Earth position of a point of the rotor frame [m].
  Eigen::Vector3d point(const Eigen::Vector3d& x) const { return hub.position + attitude() * x; }
  /// Its velocity where it is fixed to the rotor [m/s].
  Eigen::Vector3d velocity(const Eigen::Vector3d& x) const { return hub.velocity + omega().cross(attitude() * x); }
};

/// Nodes of the rotor frame placed in the earth frame; `rotor` and `earth` may be the same.
inline void place_nodes(const RotorPose& pose, std::span<const Eigen::Vector3d> rotor, std::span<Eigen::Vector3d> earth) {
  const Eigen::Matrix3d turn = pose.attitude().toRotationMatrix();
  for (std::size_t n = 0; n < rotor.size(); ++n) earth[n] = turn * rotor[n] + pose.hub.position;
}

}  // namespace spindrift::aero
