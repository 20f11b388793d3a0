// Joints as lists of primitive constraints, and the angle a joint has turned.
// Rows: spherical 3, planar 3, universal 4, cylindrical 4, revolute 5, translational 5, fixed 6; a driver adds one (Nikravesh
// 1988, chapter 7). Used by src/bodies/system.cpp; tested in tests/kernels/rigid/joints_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/rigid/constraints.hpp"

namespace spindrift {

enum class JointType { fixed, revolute, spherical, universal, translational, cylindrical, planar };
inline constexpr std::array<std::string_view, 7> joint_type_names{"fixed",         "revolute",    "spherical", "universal",
                                                                  "translational", "cylindrical", "planar"};
inline constexpr bool turns(JointType t) { return t == JointType::revolute || t == JointType::cylindrical; }
inline constexpr bool slides(JointType t) { return t == JointType::translational || t == JointType::cylindrical; }

/// Where a joint sits on one body: point from the centre of mass and a right-handed triad (axis, second, third), body axes.
struct JointFrame {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX(), second = Eigen::Vector3d::UnitY(), third = Eigen::Vector3d::UnitZ();
};

/// A unit vector perpendicular to `axis`, the same for the same axis.
Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis);

/// The frame on a body in the given pose of a joint at `point` with `axis` and `second` (perpendicular unit vectors), earth axes.
JointFrame joint_frame(const Pose& pose, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                       const Eigen::Vector3d& second);

/// Appends the constraints of a joint between bodies i and j. A universal joint has its cross along i.axis and j.second.
/// rotation_driver, translation_driver: indices of prescribed motions, -1 for none (kinds that allow them: turns(), slides()).
void append_joint(JointType type, int i, int j, const JointFrame& on_i, const JointFrame& on_j, int rotation_driver,
                  int translation_driver, int joint, std::vector<Constraint>& constraints);

/// Angle [rad] body j has turned against body i about the joint's axis, in (-pi, pi].
double joint_angle(const JointFrame& on_i, const JointFrame& on_j, const Pose& i, const Pose& j);

/// The angle equal to `wrapped` up to full turns and nearest to `previous`.
inline double unwrapped(double wrapped, double previous) {
  return wrapped + 2.0 * pi * std::round((previous - wrapped) / (2.0 * pi));
}

}  // namespace spindrift
