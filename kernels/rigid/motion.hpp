// Where a rigid body is and how it moves: the kinematic half of what the physics modules exchange.
// Frames: docs/user/conventions.md. Quaternion kinematics after Nikravesh (1988), chapter 6.
// Used by every module that meets a body; tested in tests/kernels/rigid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// State of one rigid body. Earth frame: right-handed, x downwind, z up, origin at still water.
struct Motion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< centre of mass, earth frame [m]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< turns body axes into earth axes, unit norm
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< of the centre of mass, earth frame [m/s]
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();               ///< angular velocity, BODY axes [rad/s]

  /// Earth position [m] of a point given in body axes from the centre of mass [m].
  Eigen::Vector3d point(const Eigen::Vector3d& body_point) const { return position + attitude * body_point; }
  /// Earth velocity [m/s] of that point when it is fixed to the body.
  Eigen::Vector3d point_velocity(const Eigen::Vector3d& body_point) const {
    return velocity + attitude * omega.cross(body_point);
  }
  Eigen::Vector3d omega_earth() const { return attitude * omega; }

  friend bool operator==(const Motion&, const Motion&) = default;
};

}  // namespace spindrift
