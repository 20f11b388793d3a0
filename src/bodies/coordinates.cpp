// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/coordinates.hpp"

namespace spindrift::bodies {

void PartitionedCoordinates::set(std::span<const char> independent, std::span<const char> active) {
  independent_.clear();
  dependent_.clear();
  active_.clear();
  for (std::size_t k = 0; k < independent.size(); ++k) (independent[k] ? independent_ : dependent_).push_back(int(k));
  for (std::size_t k = 0; k < active.size(); ++k)
    if (active[k]) active_.push_back(int(k));
  const Eigen::Index rank = Eigen::Index(active_.size()), free = Eigen::Index(independent_.size());
  block_.resize(rank, rank);
  right_.resize(rank, free + 1);
  solution_.resize(rank, free + 1);
  solved_.resize(rank);
  gathered_.resize(rank);
}

void PartitionedCoordinates::factorise(const Eigen::MatrixXd& jacobian) {
  for (std::size_t c = 0; c < dependent_.size(); ++c)
    for (std::size_t r = 0; r < active_.size(); ++r)
      block_(Eigen::Index(r), Eigen::Index(c)) = jacobian(active_[r], dependent_[c]);
  if (!active_.empty()) lu_.compute(block_);
}

void PartitionedCoordinates::solve_tangent(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& side, Eigen::MatrixXd& tangent,
                                           Eigen::VectorXd& drift) {
  const Eigen::Index free = Eigen::Index(independent_.size());
  for (std::size_t r = 0; r < active_.size(); ++r)
    for (Eigen::Index c = 0; c < free; ++c) right_(Eigen::Index(r), c) = -jacobian(active_[r], independent_[std::size_t(c)]);
  for (std::size_t r = 0; r < active_.size(); ++r) right_(Eigen::Index(r), free) = side[active_[r]];
  if (!active_.empty()) solution_ = lu_.solve(right_);
  tangent.setZero();
  drift.setZero();
  for (Eigen::Index c = 0; c < free; ++c) tangent(independent_[std::size_t(c)], c) = 1.0;
  for (std::size_t r = 0; r < dependent_.size(); ++r) {
    tangent.row(dependent_[r]) = solution_.row(Eigen::Index(r)).head(free);
    drift[dependent_[r]] = solution_(Eigen::Index(r), free);
  }
}

const Eigen::VectorXd& PartitionedCoordinates::solve(const Eigen::VectorXd& rows) {
  for (std::size_t r = 0; r < active_.size(); ++r) gathered_[Eigen::Index(r)] = rows[active_[r]];
  solved_ = lu_.solve(gathered_);
  return solved_;
}

}  // namespace spindrift::bodies
