// The conditions of all joints and of what drives them, a row each, at given poses of the bodies. Lengths are in units of the one
// that it was made with. Used by mechanism.cpp; the rows of each kind of joint are in kernels/rigid/joints.hpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "src/bodies/system.hpp"

namespace spindrift::bodies {

class JointRows {
 public:
  using Poses = std::span<const Pose>;

  /// Of joints between bodies that are at `initial`; length [m] is the unit of lengths.
  JointRows(std::span<const Joint> joints, Poses initial, double length);

  int count() const { return int(joint_of_row_.size()); }
  std::span<const int> all() const { return all_; }  ///< their numbers
  int joint_of(int row) const { return joint_of_row_[std::size_t(row)]; }

  /// Brings the prescribed motions to time t [s]: all that follows is of that time.
  void set_time(double t);
  void residual(Poses poses, Eigen::VectorXd& rows) const;
  /// With respect to translations in earth axes and rotations in body axes; `out` is count() by 6 per body, zero at first.
  void jacobian(Poses poses, Eigen::MatrixXd& out) const;
  /// nu of C u = nu, and gamma of C u' = gamma.
  void velocity_side(Poses poses, Eigen::VectorXd& rows) const;
  void acceleration_side(Poses poses, Eigen::VectorXd& rows) const;
  /// Angles of the joints that turn, continued from those in `angles` [rad].
  void turn_joints(Poses poses, std::vector<double>& angles) const;
  /// What each joint does to its body j [N, N m] where the rows have these multipliers.
  void reactions(Poses poses, const Eigen::VectorXd& multipliers, std::vector<Wrench>& on_j) const;

 private:
  const Pose& pose(Poses poses, int body) const { return body == earth ? earth_pose_ : poses[std::size_t(body)]; }
  const Drive& drive(const Constraint& c) const { return c.driver < 0 ? no_drive_ : drive_[std::size_t(c.driver)]; }
  int add_driver(const std::optional<PrescribedMotion>& motion, double unit);
  template <class Value>
  void fill(Poses poses, const Value& value, Eigen::VectorXd& rows) const;

  struct Turning {
    int joint, i, j;
    JointFrame on_i, on_j;
  };
  struct Driver {
    PrescribedMotion motion;
    double unit;  // 1 for angles, one over the length for distances
  };
  double length_;
  std::vector<Constraint> constraints_;
  std::vector<int> joint_of_row_, all_;
  std::vector<Turning> turning_;
  std::vector<Driver> drivers_;
  std::vector<Drive> drive_;
  const Drive no_drive_{};
  const Pose earth_pose_{};
};

}  // namespace spindrift::bodies
