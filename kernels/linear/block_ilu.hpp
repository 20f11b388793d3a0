// Block ILU(0) of a box of cells (Meijerink & van der Vorst 1977 in blocks): on a structured 7-point stencil it changes the
// diagonal only, so that factors are the inverted pivots beside the matrix itself. Neighbours outside the box take no part: each
// box is factored by itself, and the result depends on how a grid is cut into boxes, not on who works on them. i is fastest and
// is to be the direction of strongest coupling (across walls). Called by src/aero/flow; tested in
// tests/kernels/linear/block_ilu_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/linear/stencil_matrix.hpp"

namespace spindrift::linear {

/// Fills the pivots: inverse of D_c - sum over lower neighbours m of A_cm P_m A_mc. Returns the first cell whose pivot is
/// singular, or -1.
template <int n>
std::ptrdiff_t factor(const StencilMatrix<n>& a) {
  std::ptrdiff_t cell = 0;
  for (int k = 0; k < a.box.nk; ++k)
    for (int j = 0; j < a.box.nj; ++j)
      for (int i = 0; i < a.box.ni; ++i, ++cell) {
        float pivot[n * n + block_overrun];
        for (int e = 0; e < n * n; ++e) pivot[e] = a.block(cell, StencilMatrix<n>::diagonal)[e];
        const std::array<int, 3> index{i, j, k};
        for (int d = 0; d < a.directions; ++d) {
          if (index[d] == 0) continue;
          const std::ptrdiff_t before = cell - a.box.stride(d);
          subtract_product<n>(a.block(cell, StencilMatrix<n>::sides + 2 * d), a.block(before, StencilMatrix<n>::pivot),
                              a.block(before, StencilMatrix<n>::sides + 2 * d + 1), pivot);
        }
        if (!invert<n>(pivot, a.block(cell, StencilMatrix<n>::pivot))) return cell;
      }
  return -1;
}

/// z = (ILU of a)^-1 r; both [cell][n]; may be the same.
template <int n>
void solve(const StencilMatrix<n>& a, const float* r, float* z) {
  const CellBox& box = a.box;
  const std::ptrdiff_t row = box.stride(1) * n, plane = box.stride(2) * n;
  constexpr int lower = StencilMatrix<n>::sides, upper = StencilMatrix<n>::sides + 1;
  float rest[8];
  std::ptrdiff_t cell = 0;
  for (int k = 0; k < box.nk; ++k)
    for (int j = 0; j < box.nj; ++j)
      for (int i = 0; i < box.ni; ++i, ++cell) {
        float* here = z + cell * n;
        TwoSums<n> sums;
        if (a.directions > 2 && k > 0) sums.multiply_add(a.block(cell, lower + 4), here - plane);
        if (j > 0) sums.multiply_add(a.block(cell, lower + 2), here - row);
        if (i > 0) sums.multiply_add(a.block(cell, lower), here - n);
        sums.total().store(rest);
        for (int c = 0; c < n; ++c) rest[c] = r[cell * n + c] - rest[c];
        multiply<n>(a.block(cell, StencilMatrix<n>::pivot), rest, here);
      }
  for (int k = box.nk - 1; k >= 0; --k)
    for (int j = box.nj - 1; j >= 0; --j)
      for (int i = box.ni - 1; i >= 0; --i) {
        --cell;
        float* here = z + cell * n;
        TwoSums<n> sums;
        if (a.directions > 2 && k + 1 < box.nk) sums.multiply_add(a.block(cell, upper + 4), here + plane);
        if (j + 1 < box.nj) sums.multiply_add(a.block(cell, upper + 2), here + row);
        if (i + 1 < box.ni) sums.multiply_add(a.block(cell, upper), here + n);
        if (i + 1 == box.ni && j + 1 == box.nj && (a.directions < 3 || k + 1 == box.nk)) continue;
        sums.total().store(rest);
        float change[n];
        multiply<n>(a.block(cell, StencilMatrix<n>::pivot), rest, change);
        for (int c = 0; c < n; ++c) here[c] -= change[c];
      }
}

}  // namespace spindrift::linear
