// A direct solver for some hundreds of 5 x 5 block rows: elimination without exchange of block rows in the envelope that reverse
// Cuthill-McKee numbering leaves (George & Liu 1981), each pivot block inverted with exchange. Every process has the whole matrix
// and makes the same numbers of it. Used by coarse_correction.cpp; tested in tests/src/aero/flow/coarse_correction_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace spindrift::aero {

class BlockElimination {
 public:
  static constexpr int n = 5;
  struct Entry {
    int row, column;
    std::array<double, 25> block;  ///< column by column
  };
  /// Entries of the same place add up; the pattern must be symmetric after that, with a diagonal. Keeps its memory for the next
  /// matrix. Throws SingularMatrix naming the row of a singular pivot; then it has no factors.
  void factorise(int rows, std::span<const Entry> entries);
  /// x = A^-1 b, of the matrix last factorised; both [row][5], may be the same.
  void solve(std::span<const double> b, std::span<double> x) const;

 private:
  /// Row i of the lower part and column i of the upper one: [5][blocks of the envelope][5], the inner index running along the
  /// sum.
  std::size_t at(int i, int part) const {
    return begin_[std::size_t(i)] + std::size_t(part) * std::size_t(n) * std::size_t(i - low_[std::size_t(i)]);
  }
  std::vector<int> place_, low_;  ///< number of a row in the elimination; first column of its envelope
  std::vector<std::size_t> begin_;
  std::vector<double> lower_, upper_, pivots_;  ///< pivots: inverted diagonal blocks, by rows
};

}  // namespace spindrift::aero
