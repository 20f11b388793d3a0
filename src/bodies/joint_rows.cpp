// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/joint_rows.hpp"

#include <numeric>

#include "kernels/rigid/rotation.hpp"

namespace spindrift::bodies {

JointRows::JointRows(std::span<const Joint> joints, Poses initial, double length) : length_(length) {
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& joint = joints[k];
    const int rotation = add_driver(joint.rotation, 1.0), translation = add_driver(joint.translation, 1.0 / length);
    const Eigen::Vector3d axis = joint.axis.normalized(), point = joint.point / length;
    const Eigen::Vector3d given =
        joint.second_axis - joint.second_axis.dot(axis) * axis;  // the arms of a cross are perpendicular
    const Eigen::Vector3d second =
        joint.type == JointType::universal ? Eigen::Vector3d(given.normalized()) : perpendicular_to(axis);
    const JointFrame on_i = joint_frame(pose(initial, joint.i), point, axis, second),
                     on_j = joint_frame(pose(initial, joint.j), point, axis, second);
    append_joint(joint.type, joint.i, joint.j, on_i, on_j, rotation, translation, int(k), constraints_);
    if (turns(joint.type)) turning_.push_back({int(k), joint.i, joint.j, on_i, on_j});
  }
  for (const Constraint& c : constraints_) joint_of_row_.insert(joint_of_row_.end(), std::size_t(c.rows()), c.joint);
  all_.resize(joint_of_row_.size());
  std::iota(all_.begin(), all_.end(), 0);
  drive_.resize(drivers_.size());
}

/// Its index; -1 where nothing is prescribed.
int JointRows::add_driver(const std::optional<PrescribedMotion>& motion, double unit) {
  if (!motion) return -1;
  drivers_.push_back({*motion, unit});
  return int(drivers_.size()) - 1;
}

void JointRows::set_time(double t) {
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    const Drive d = drivers_[k].motion.at(t);
    drive_[k] = {d.value * drivers_[k].unit, d.rate * drivers_[k].unit, d.acceleration * drivers_[k].unit};
  }
}

/// value(constraint, pose of i, pose of j, drive) has up to three components, one for each row of the constraint.
template <class Value>
void JointRows::fill(Poses poses, const Value& value, Eigen::VectorXd& rows) const {
  int row = 0;
  for (const Constraint& c : constraints_) {
    const Eigen::Vector3d of = value(c, pose(poses, c.i), pose(poses, c.j), drive(c));
    for (int k = 0; k < c.rows(); ++k) rows[row++] = of[k];
  }
}

void JointRows::residual(Poses poses, Eigen::VectorXd& rows) const {
  fill(
      poses, [](const auto&... of) { return spindrift::residual(of...); }, rows);
}

void JointRows::velocity_side(Poses poses, Eigen::VectorXd& rows) const {
  fill(
      poses, [](const auto&... of) { return spindrift::velocity_side(of...); }, rows);
}

void JointRows::acceleration_side(Poses poses, Eigen::VectorXd& rows) const {
  fill(
      poses, [](const auto&... of) { return spindrift::acceleration_side(of...); }, rows);
}

void JointRows::jacobian(Poses poses, Eigen::MatrixXd& out) const {
  int row = 0;
  for (const Constraint& c : constraints_) {
    const ConstraintRows block = spindrift::jacobian(c, pose(poses, c.i), pose(poses, c.j), drive(c));
    const int n = c.rows();
    if (c.i != earth) {
      out.block(row, 6 * c.i, n, 3) = block.translation_i.topRows(n);
      out.block(row, 6 * c.i + 3, n, 3) = block.rotation_i.topRows(n);
    }
    if (c.j != earth) {
      out.block(row, 6 * c.j, n, 3) = block.translation_j.topRows(n);
      out.block(row, 6 * c.j + 3, n, 3) = block.rotation_j.topRows(n);
    }
    row += n;
  }
}

void JointRows::turn_joints(Poses poses, std::vector<double>& angles) const {
  for (const Turning& j : turning_) {
    double& angle = angles[std::size_t(j.joint)];
    angle = unwrapped(joint_angle(j.on_i, j.on_j, pose(poses, j.i), pose(poses, j.j)), angle);
  }
}

void JointRows::reactions(Poses poses, const Eigen::VectorXd& multipliers, std::vector<Wrench>& on_j) const {
  int row = 0;
  for (const Constraint& c : constraints_) {
    const Pose& at = pose(poses, c.j);
    const ConstraintRows block = spindrift::jacobian(c, pose(poses, c.i), at, drive(c));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (int k = 0; k < c.rows(); ++k, ++row) {
      force += multipliers[row] / length_ * block.translation_j.row(k).transpose();
      moment += multipliers[row] * (at.axes * block.rotation_j.row(k).transpose());
    }
    Wrench& w = on_j[std::size_t(c.joint)];
    w.point = length_ * (at.position + at.axes * c.point_j);
    w.force += force;
    w.moment += moment + (length_ * at.position - w.point).cross(force);
  }
}

}  // namespace spindrift::bodies
