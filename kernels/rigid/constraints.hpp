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

namespace detail {

/// Direction on body i that a driven angle makes perpendicular to direction j: direction_i turned by the prescribed angle + 90
/// deg.
inline Eigen::Vector3d driven_direction(const Constraint& c, const Drive& drive) {
  return std::cos(drive.value) * c.axis_i.cross(c.direction_i) - std::sin(drive.value) * c.direction_i;
}

}  // namespace detail

/// Residual, zero when satisfied; the first rows() entries count.
inline Eigen::Vector3d residual(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  switch (c.kind) {
    case Constraint::Kind::point:
      return j.position + j.axes * c.point_j - i.position - i.axes * c.point_i;
    case Constraint::Kind::perpendicular:
      return {(i.axes * c.direction_i).dot(j.axes * c.direction_j), 0, 0};
    case Constraint::Kind::driven_angle:
      return {(i.axes * detail::driven_direction(c, drive)).dot(j.axes * c.direction_j), 0, 0};
    case Constraint::Kind::distance_along:
      break;
  }
  const Eigen::Vector3d between = j.position + j.axes * c.point_j - i.position - i.axes * c.point_i;
  return {(i.axes * c.direction_i).dot(between) - drive.value, 0, 0};
}

/// Analytic Jacobian of the residual.
inline ConstraintRows jacobian(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  ConstraintRows rows;
  const auto cross_rows = [](const Eigen::Matrix3d& axes, const Eigen::Vector3d& body_point) -> Eigen::Matrix3d {
    Eigen::Matrix3d m;  // axes * skew(body_point), column by column
    m.col(0) = axes * Eigen::Vector3d(0, body_point.z(), -body_point.y());
    m.col(1) = axes * Eigen::Vector3d(-body_point.z(), 0, body_point.x());
    m.col(2) = axes * Eigen::Vector3d(body_point.y(), -body_point.x(), 0);
    return m;
  };
  switch (c.kind) {
    case Constraint::Kind::point:
      rows.translation_i = -Eigen::Matrix3d::Identity();
      rows.translation_j = Eigen::Matrix3d::Identity();
      rows.rotation_i = cross_rows(i.axes, c.point_i);
      rows.rotation_j = -cross_rows(j.axes, c.point_j);
      return rows;
    case Constraint::Kind::perpendicular:
    case Constraint::Kind::driven_angle: {
      const Eigen::Vector3d body_direction =
          c.kind == Constraint::Kind::perpendicular ? c.direction_i : detail::driven_direction(c, drive);
      const Eigen::Vector3d normal = (i.axes * body_direction).cross(j.axes * c.direction_j);
      rows.translation_i.row(0).setZero();
      rows.translation_j.row(0).setZero();
      rows.rotation_i.row(0) = normal.transpose() * i.axes;
      rows.rotation_j.row(0) = -normal.transpose() * j.axes;
      return rows;
    }
    case Constraint::Kind::distance_along:
      break;
  }
  const Eigen::Vector3d direction = i.axes * c.direction_i;
  const Eigen::Vector3d reach = j.position + j.axes * c.point_j - i.position;  // from the centre of i to the point on j
  rows.translation_i.row(0) = -direction.transpose();
  rows.translation_j.row(0) = direction.transpose();
  rows.rotation_i.row(0) = direction.cross(reach).transpose() * i.axes;
  rows.rotation_j.row(0) = (j.axes * c.point_j).cross(direction).transpose() * j.axes;
  return rows;
}

/// nu of C u = nu: what the drivers ask of the velocities.
inline Eigen::Vector3d velocity_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  if (c.kind == Constraint::Kind::distance_along) return {drive.rate, 0, 0};
  if (c.kind != Constraint::Kind::driven_angle) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d p = i.axes * detail::driven_direction(c, drive), s = j.axes * c.direction_j;
  return {-drive.rate * (i.axes * c.axis_i).dot(p.cross(s)), 0, 0};
}

/// gamma of C du/dt = gamma: centripetal, Coriolis and driver terms.
inline Eigen::Vector3d acceleration_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  using Eigen::Vector3d;
  switch (c.kind) {
    case Constraint::Kind::point:
      return i.spin.cross(i.spin.cross(i.axes * c.point_i)) - j.spin.cross(j.spin.cross(j.axes * c.point_j));
    case Constraint::Kind::perpendicular:
    case Constraint::Kind::driven_angle: {
      const bool driven = c.kind == Constraint::Kind::driven_angle;
      const Vector3d p = i.axes * (driven ? detail::driven_direction(c, drive) : c.direction_i), s = j.axes * c.direction_j;
      const Vector3d axis = driven ? Vector3d(i.axes * c.axis_i) : Vector3d(Vector3d::Zero());
      const Vector3d p_spin = i.spin + drive.rate * axis;  // p turns with body i and with the driver
      const Vector3d normal = p.cross(s), normal_rate = p_spin.cross(p).cross(s) + p.cross(j.spin.cross(s));
      const Vector3d driver = drive.acceleration * axis + drive.rate * i.spin.cross(axis);
      return {-(driver.dot(normal) + (p_spin - j.spin).dot(normal_rate)), 0, 0};
    }
    case Constraint::Kind::distance_along:
      break;
  }
  const Vector3d a = i.axes * c.point_i, b = j.axes * c.point_j, direction = i.axes * c.direction_i;
  const Vector3d between = j.position + b - i.position - a;
  const Vector3d between_rate = j.velocity + j.spin.cross(b) - i.velocity - i.spin.cross(a);
  return {-(direction.dot(j.spin.cross(j.spin.cross(b)) - i.spin.cross(i.spin.cross(a))) +
            2.0 * i.spin.cross(direction).dot(between_rate) + i.spin.cross(i.spin.cross(direction)).dot(between)) +
              drive.acceleration,
          0, 0};
}

}  // namespace spindrift
