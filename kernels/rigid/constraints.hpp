// The primitive constraints joints are made of: residual, analytic Jacobian, and the right-hand sides of the velocity and
// acceleration equations, C u = nu and C du/dt = gamma, with u = (velocity, earth; angular velocity, body axes) of each body.
// After Nikravesh (1988), chapters 6-7, and Haug (1989), chapter 9 (spherical, dot-1, dot-2), with drivers as moving directions.
// Composed into joints by kernels/rigid/joints.hpp; used by src/bodies/system.cpp; Jacobian and gamma tested against differences
// in tests/kernels/rigid/joints_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kernels/rigid/prescribed_motion.hpp"

namespace spindrift {

/// A body as constraints see it. Lengths in any one unit (the bodies' system uses its own reference length).
struct Pose {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< body axes to earth axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< centre of mass, earth
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< earth
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< angular velocity, EARTH axes
};

/// One constraint between bodies i and j. `earth` is the fixed frame.
struct Constraint {
  static constexpr int earth = -1;
  enum class Kind {
    point,           ///< the two points coincide: three rows, earth axes
    perpendicular,   ///< direction i is perpendicular to direction j: cos = 0
    driven_angle,    ///< direction j has turned about axis i by the prescribed angle: sin(angle - prescribed) = 0
    distance_along,  ///< direction i times (point j - point i) equals the prescribed distance (zero without driver)
  };
  Kind kind = Kind::point;
  int i = earth, j = earth;
  Eigen::Vector3d point_i = Eigen::Vector3d::Zero(), point_j = Eigen::Vector3d::Zero();  ///< body axes, from the centre of mass
  Eigen::Vector3d direction_i = Eigen::Vector3d::UnitX(), direction_j = Eigen::Vector3d::UnitX();  ///< body axes, unit
  Eigen::Vector3d axis_i = Eigen::Vector3d::UnitX();  ///< axis of a driven angle, body axes, perpendicular to direction_i
  int driver = -1;                                    ///< index of its prescribed motion, -1 for none
  int joint = -1;                                     ///< whose it is, for messages

  int rows() const { return kind == Kind::point ? 3 : 1; }
};

/// Rows of the Jacobian: columns of body i (translation, rotation) and of body j. Only the first rows() rows are set.
struct ConstraintRows {
  Eigen::Matrix3d translation_i, rotation_i, translation_j, rotation_j;
};

/// Residual, zero when satisfied; the first rows() entries count.
Eigen::Vector3d residual(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive);

/// Analytic Jacobian of the residual.
ConstraintRows jacobian(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive);

/// nu of C u = nu: what the drivers ask of the velocities.
Eigen::Vector3d velocity_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive);

/// gamma of C du/dt = gamma: centripetal, Coriolis and driver terms.
Eigen::Vector3d acceleration_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive);

}  // namespace spindrift
