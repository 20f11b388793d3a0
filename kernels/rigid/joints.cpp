// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/joints.hpp"

#include <Eigen/Geometry>

namespace spindrift {

Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis) {
  Eigen::Index smallest;
  axis.cwiseAbs().minCoeff(&smallest);
  return Eigen::Vector3d::Unit(smallest).cross(axis).normalized();
}

JointFrame joint_frame(const Pose& pose, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                       const Eigen::Vector3d& second) {
  const Eigen::Matrix3d to_body = pose.axes.transpose();
  return {to_body * (point - pose.position), to_body * axis, to_body * second, to_body * axis.cross(second)};
}

void append_joint(JointType type, int i, int j, const JointFrame& on_i, const JointFrame& on_j, int rotation_driver,
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
  const bool planar = type == JointType::planar;
  if (!slides(type) && !planar) constraints.push_back(base);
  if (type == JointType::universal) perpendicular(on_i.axis, on_j.second);
  if (type == JointType::revolute || type == JointType::fixed || slides(type) || planar) {
    perpendicular(on_i.second, on_j.axis);
    perpendicular(on_i.third, on_j.axis);
  }
  if (slides(type)) {
    along(on_i.second, -1);
    along(on_i.third, -1);
  }
  if (planar) along(on_i.axis, -1);
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

double joint_angle(const JointFrame& on_i, const JointFrame& on_j, const Pose& i, const Pose& j) {
  const Eigen::Vector3d turned = j.axes * on_j.second;
  return std::atan2((i.axes * on_i.third).dot(turned), (i.axes * on_i.second).dot(turned));
}

}  // namespace spindrift
