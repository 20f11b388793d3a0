// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/constraints.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace spindrift {

namespace {

/// Direction on body i that a driven angle makes perpendicular to direction j: direction_i turned by the prescribed angle + 90
/// deg.
Eigen::Vector3d driven_direction(const Constraint& c, const Drive& drive) {
  return std::cos(drive.value) * c.axis_i.cross(c.direction_i) - std::sin(drive.value) * c.direction_i;
}

}  // namespace

Eigen::Vector3d residual(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  switch (c.kind) {
    case Constraint::Kind::point:
      return j.position + j.axes * c.point_j - i.position - i.axes * c.point_i;
    case Constraint::Kind::perpendicular:
      return {(i.axes * c.direction_i).dot(j.axes * c.direction_j), 0, 0};
    case Constraint::Kind::driven_angle:
      return {(i.axes * driven_direction(c, drive)).dot(j.axes * c.direction_j), 0, 0};
    case Constraint::Kind::distance_along:
      break;
  }
  const Eigen::Vector3d between = j.position + j.axes * c.point_j - i.position - i.axes * c.point_i;
  return {(i.axes * c.direction_i).dot(between) - drive.value, 0, 0};
}

ConstraintRows jacobian(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
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
          c.kind == Constraint::Kind::perpendicular ? c.direction_i : driven_direction(c, drive);
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

Eigen::Vector3d velocity_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  if (c.kind == Constraint::Kind::distance_along) return {drive.rate, 0, 0};
  if (c.kind != Constraint::Kind::driven_angle) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d p = i.axes * driven_direction(c, drive), s = j.axes * c.direction_j;
  return {-drive.rate * (i.axes * c.axis_i).dot(p.cross(s)), 0, 0};
}

Eigen::Vector3d acceleration_side(const Constraint& c, const Pose& i, const Pose& j, const Drive& drive) {
  using Eigen::Vector3d;
  switch (c.kind) {
    case Constraint::Kind::point:
      return i.spin.cross(i.spin.cross(i.axes * c.point_i)) - j.spin.cross(j.spin.cross(j.axes * c.point_j));
    case Constraint::Kind::perpendicular:
    case Constraint::Kind::driven_angle: {
      const bool driven = c.kind == Constraint::Kind::driven_angle;
      const Vector3d p = i.axes * (driven ? driven_direction(c, drive) : c.direction_i), s = j.axes * c.direction_j;
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
