// Laws of kernels/rigid/partition.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/partition.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace spindrift;

TEST_CASE("the partition has as many dependent columns and active rows as the Jacobian has rank", "[rigid][fast]") {
  Eigen::MatrixXd jacobian(4, 5);
  jacobian << 1, 0, 2, 0, 0,  //
      0, 3, 0, 0, 1,          //
      2, 3, 4, 0, 1,          // twice the first plus the second: redundant
      0, 0, 0, 1e-3, 0;
  std::vector<char> active(4), independent(5);
  const PartitionChoice choice = choose_partition(jacobian, Eigen::VectorXd::Ones(5), active, independent);
  CHECK(choice.rank == 3);
  CHECK(std::count(active.begin(), active.end(), 1) == 3);
  CHECK(std::count(independent.begin(), independent.end(), 0) == 3);
  CHECK(active[3] == 1);  // small, but not redundant
  CHECK(choice.weakest_row == 3);
  // the block of active rows and dependent columns is regular
  Eigen::Matrix3d block;
  int r = 0;
  for (int row = 0; row < 4; ++row) {
    if (!active[std::size_t(row)]) continue;
    int c = 0;
    for (int column = 0; column < 5; ++column)
      if (!independent[std::size_t(column)]) block(r, c++) = jacobian(row, column);
    ++r;
  }
  CHECK(std::abs(block.determinant()) > 1e-4);
}

TEST_CASE("of two columns that serve alike, the one with the smaller weight is left independent", "[rigid][fast]") {
  Eigen::MatrixXd jacobian(1, 2);
  jacobian << 1, -1;
  std::vector<char> active(1), independent(2);
  choose_partition(jacobian, Eigen::Vector2d(0.5, 1.0), active, independent);
  CHECK(independent[0] == 1);
  choose_partition(jacobian, Eigen::Vector2d(1.0, 0.5), active, independent);
  CHECK(independent[1] == 1);
}

TEST_CASE("without constraints everything is independent", "[rigid][fast]") {
  std::vector<char> independent(6);
  CHECK(choose_partition(Eigen::MatrixXd(0, 6), Eigen::VectorXd::Ones(6), {}, independent).rank == 0);
  CHECK(std::count(independent.begin(), independent.end(), 1) == 6);
}
