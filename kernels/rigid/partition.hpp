// Choice of independent coordinates and of independent constraint rows by a fully pivoted factorisation of the constraint
// Jacobian. Coordinate partitioning: Wehage & Haug (1982), J. Mech. Design 104; Nikravesh (1988), chapter 13. Full pivoting also
// finds the rank, so that rows which follow from others (redundant constraints) are left out of the solution and can be named.
// Used by src/bodies/mechanism.cpp; tested in tests/kernels/rigid/partition_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

namespace spindrift {

/// Pivots below this fraction of the largest one count as zero: the row is redundant (or the position singular).
/// Jacobian entries of closed loops repeat to about 1e-15; a four-bar within 1e-8 rad of its singular position is called
/// singular.
inline constexpr double partition_pivot_ratio = 1e-9;

struct PartitionChoice {
  int rank = 0;
  int weakest_row = -1;      ///< row of the smallest pivot that was kept
  double pivot_ratio = 1.0;  ///< that pivot over the largest
};

/// Marks in `active` the rows and clears in `independent` the columns of the pivots; columns count with their `weight` (a column
/// with a small weight is rather left independent). Deterministic.
PartitionChoice choose_partition(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& weight, std::span<char> active,
                                 std::span<char> independent);

}  // namespace spindrift
