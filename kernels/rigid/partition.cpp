// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/partition.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace spindrift {

PartitionChoice choose_partition(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& weight, std::span<char> active,
                                 std::span<char> independent) {
  std::fill(active.begin(), active.end(), char(0));
  std::fill(independent.begin(), independent.end(), char(1));
  PartitionChoice choice;
  if (jacobian.rows() == 0) return choice;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(jacobian * weight.asDiagonal());
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
  const double largest = lu.maxPivot();
  for (Eigen::Index k = 0; k < pivots.size() && pivots[k] > partition_pivot_ratio * largest; ++k) choice.rank = int(k) + 1;
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    const int place = int(lu.permutationP().indices()[row]);
    if (place < choice.rank) active[std::size_t(row)] = 1;
    if (place == choice.rank - 1) choice.weakest_row = int(row);
  }
  for (int k = 0; k < choice.rank; ++k) independent[std::size_t(lu.permutationQ().indices()[k])] = 0;
  if (choice.rank > 0) choice.pivot_ratio = pivots[choice.rank - 1] / largest;
  return choice;
}

}  // namespace spindrift
