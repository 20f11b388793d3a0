// Joints as lists of primitive constraints, and the angle a joint has turned.
// Rows: spherical 3, universal 4, cylindrical 4, revolute 5, translational 5, fixed 6; a driver adds one (Nikravesh 1988, chapter
// 7). Used by src/bodies/system.cpp; tested in tests/kernels/rigid/joints_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/rigid/constraints.hpp"

namespace spindrift {

enum class JointType { fixed, revolute, spherical, universal, translational, cylindrical };
inline constexpr std::array<std::string_view, 6> joint_type_names{"fixed",     "revolute",      "spherical",
                                                                  "universal", "translational", "cylindrical"};
inline constexpr std::optional<JointType> joint_type_named(std::string_view name) {
  for (std::size_t i = 0; i < joint_type_names.size(); ++i)
    if (joint_type_names[i] == name) return JointType(i);
  return std::nullopt;
}
inline constexpr bool turns(JointType t) { return t == JointType::revolute || t == JointType::cylindrical; }
inline constexpr bool slides(JointType t) { return t == JointType::translational || t == JointType::cylindrical; }

/// Where a joint sits on one body: point from the centre of mass and a right-handed triad (axis, second, third), body axes.
struct JointFrame {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX(), second = Eigen::Vector3d::UnitY(), third = Eigen::Vector3d::UnitZ();
};

/// A unit vector perpendicular to `axis`, the same for the same axis.
inline Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis) {
  Eigen::Index smallest;
  axis.cwiseAbs().minCoeff(&smallest);
  return Eigen::Vector3d::Unit(smallest).cross(axis).normalized();
}

/// The frame on a body in the given pose of a joint at `point` with `axis` and `second` (perpendicular unit vectors), earth axes.
inline JointFrame joint_frame(const Pose& pose, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                              const Eigen::Vector3d& second) {
  const Eigen::Matrix3d to_body = pose.axes.transpose();
  return {to_body * (point - pose.position), to_body * axis, to_body * second, to_body * axis.cross(second)};
}

/// Appends the constraints of a joint between bodies i and j. A universal joint has its cross along i.axis and j.second.
/// rotation_driver, translation_driver: indices of prescribed motions, -1 for none (kinds that allow them: turns(), slides()).
inline void append_joint(JointType type, int i, int j, const JointFrame& on_i, const JointFrame& on_j, int rotation_driver,
                         int translation_driver, int joint, std::vector<Constraint>& constraints) {
  Constraint base;
  base.i = i;
  base.j = j;
  base.point_i = on_i.point;
  base.point_j = on_j.point;
  base.joint = joint;
  const auto perpendicular = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    Constraint c = base;
    c.kind = Constraint::Kind::perpendicular;
    c.direction_i = a;
    c.direction_j = b;
    constraints.push_back(c);
  };
  const auto along = [&](const Eigen::Vector3d& a, int driver) {
    Constraint c = base;
    c.kind = Constraint::Kind::distance_along;
    c.direction_i = a;
    c.driver = driver;
    constraints.push_back(c);
  };
  if (!slides(type)) constraints.push_back(base);
  if (type == JointType::universal) perpendicular(on_i.axis, on_j.second);
  if (type == JointType::revolute || type == JointType::fixed || slides(type)) {
    perpendicular(on_i.second, on_j.axis);
    perpendicular(on_i.third, on_j.axis);
  }
  if (slides(type)) {
    along(on_i.second, -1);
    along(on_i.third, -1);
  }
  if (type == JointType::fixed || type == JointType::translational) perpendicular(on_i.second, on_j.third);
  if (rotation_driver >= 0) {
    Constraint c = base;
    c.kind = Constraint::Kind::driven_angle;
    c.axis_i = on_i.axis;
    c.direction_i = on_i.second;
    c.direction_j = on_j.second;
    c.driver = rotation_driver;
    constraints.push_back(c);
  }
  if (translation_driver >= 0) along(on_i.axis, translation_driver);
}

/// Angle [rad] body j has turned against body i about the joint's axis, in (-pi, pi].
inline double joint_angle(const JointFrame& on_i, const JointFrame& on_j, const Pose& i, const Pose& j) {
  const Eigen::Vector3d turned = j.axes * on_j.second;
  return std::atan2((i.axes * on_i.third).dot(turned), (i.axes * on_i.second).dot(turned));
}

/// The angle equal to `wrapped` up to full turns and nearest to `previous`.
inline double unwrapped(double wrapped, double previous) {
  return wrapped + 2.0 * pi * std::round((previous - wrapped) / (2.0 * pi));
}

}  // namespace spindrift
