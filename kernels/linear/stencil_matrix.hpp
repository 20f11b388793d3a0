// The matrix of a box of cells that couple with themselves and their six (planar: four) neighbours: n x n blocks, all
// blocks of a cell together, since the sweeps of block_ilu.hpp use them together. Rows of the matrix are cells, i fastest. Called
// by src/aero/flow; tested in tests/kernels/linear/block_ilu_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kernels/linear/small_block.hpp"

namespace spindrift::linear {

/// A box of cells without ghosts.
struct CellBox {
  int ni = 0, nj = 0, nk = 0;
  std::ptrdiff_t count() const { return std::ptrdiff_t(ni) * nj * nk; }
  std::ptrdiff_t stride(int direction) const { return direction == 0 ? 1 : direction == 1 ? ni : std::ptrdiff_t(ni) * nj; }
};

/// Blocks of a cell: the diagonal, the inverse of its pivot (block_ilu.hpp), then one for each side: i-, i+, j-, j+, k-, k+.
/// Those of sides may be ShortFloats: products and sweeps read little else, and a matrix that only steers towards the solution of
/// the flow's own balances needs no more digits than its differences keep (put_side).
template <int n, class SideNumber = float>
struct StencilMatrix {
  static constexpr int diagonal = 0, pivot = 1;
  float* data = nullptr;
  CellBox box;
  int directions = 3;  ///< 2 where planar: no neighbours in k

  static std::size_t size(const CellBox& box, int directions) {
    return std::size_t(box.count() * stride_of(directions)) + block_overrun;
  }
  std::ptrdiff_t cell_stride() const { return stride_of(directions); }
  /// The diagonal or the pivot.
  float* block(std::ptrdiff_t cell, int slot) const { return data + cell * cell_stride() + slot * n * n; }
  SideNumber* side(std::ptrdiff_t cell, int side) const { return reinterpret_cast<SideNumber*>(block(cell, 2)) + side * n * n; }
  /// A number of a side's block. What rounding takes goes to the diagonal: the sum over a row of blocks, which is all that smooth
  /// changes see, stays that of the matrix.
  void put_side(std::ptrdiff_t cell, int s, int element, float value) const {
    SideNumber& number = side(cell, s)[element];
    number = SideNumber(value);
    block(cell, diagonal)[element] += value - float(number);
  }

 private:
  static std::ptrdiff_t stride_of(int directions) {
    return 2 * n * n + std::ptrdiff_t(directions * n * n * (2 * sizeof(SideNumber) / sizeof(float)));
  }
};

/// Where the numbers of a box with ghosts are: number c of cell (k, j, i) at origin + i + j row + k plane + c component.
struct GhostedBox {
  std::ptrdiff_t origin = 0, row = 0, plane = 0, component = 0;
};

/// y = A x over the cells of the box; x is read in ghosts too. y is [cell][n].
template <int n, class SideNumber>
void multiply(const StencilMatrix<n, SideNumber>& a, const float* x, const GhostedBox& of_x, float* y) {
  const std::array<std::ptrdiff_t, 6> step{-1, 1, -of_x.row, of_x.row, -of_x.plane, of_x.plane};
  const int neighbours = 2 * a.directions;
  std::ptrdiff_t cell = 0;
  for (int k = 0; k < a.box.nk; ++k)
    for (int j = 0; j < a.box.nj; ++j) {
      const float* here = x + of_x.origin + j * of_x.row + k * of_x.plane;
      for (int i = 0; i < a.box.ni; ++i, ++cell, ++here) {
        TwoSums<n> sums;
        sums.multiply_add(a.block(cell, 0), here, of_x.component);
        const SideNumber* block = a.side(cell, 0);
        for (int side = 0; side < neighbours; ++side) sums.multiply_add(block + side * n * n, here + step[side], of_x.component);
        sums.total().store(y + cell * n);
      }
    }
}

}  // namespace spindrift::linear
