// Independent and dependent coordinates (coordinate partitioning): which coordinates follow from the others through which rows of
// the constraints, and the factor of that square block of the Jacobian. Used by mechanism.cpp; the choice is made in
// kernels/rigid/partition.hpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <span>
#include <vector>

namespace spindrift::bodies {

class PartitionedCoordinates {
 public:
  /// Marks as in BodiesState: `independent` of all coordinates, `active` of all rows; as many dependent coordinates as active
  /// rows.
  void set(std::span<const char> independent, std::span<const char> active);

  const std::vector<int>& independent() const { return independent_; }
  const std::vector<int>& dependent() const { return dependent_; }
  const std::vector<int>& active() const { return active_; }  ///< rows that are solved for

  /// All that follows is of this Jacobian: rows of all constraints, columns of all coordinates.
  void factorise(const Eigen::MatrixXd& jacobian);
  /// u = tangent * (independent u) + drift where C u = side; `jacobian` is the one factorised.
  void solve_tangent(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& side, Eigen::MatrixXd& tangent,
                     Eigen::VectorXd& drift);
  /// Values of the dependent coordinates, in their order, that fulfil these of all rows, the independent ones being 0. At
  /// least one row is active; valid until the next call.
  const Eigen::VectorXd& solve(const Eigen::VectorXd& rows);
  /// Values of the active rows, in their order, that belong to these of the dependent coordinates; at least one row is active.
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& dependent) const { return lu_.transpose().solve(dependent); }

 private:
  std::vector<int> independent_, dependent_, active_;
  Eigen::MatrixXd block_, right_, solution_;
  Eigen::VectorXd gathered_, solved_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace spindrift::bodies
