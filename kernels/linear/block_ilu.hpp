// Block ILU(0) of a box of cells (Meijerink & van der Vorst 1977 in blocks): on a structured 7-point stencil it changes the
// diagonal only, so that factors are the inverted pivots beside the matrix itself. Neighbours outside the box take no part: each
// box is factored by itself, and the result depends on how a grid is cut into boxes, not on who works on them. i is fastest and
// is to be the direction of strongest coupling (across walls). Called by src/aero/flow; tested in
// tests/kernels/linear/block_ilu_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "kernels/linear/stencil_matrix.hpp"

namespace spindrift::linear {

/// Calls body(cell, index) for all cells, each after its lower neighbours. Lines are taken four at a time, each a cell behind the
/// one before: what is done in a row then does not wait for each other, where along one line every cell waits for the last one.
template <class Body>
SPINDRIFT_INLINE void lower_first(const CellBox& box, Body&& body) {
  constexpr int lines = 4;
  for (int k = 0; k < box.nk; ++k)
    for (int first = 0; first < box.nj; first += lines) {
      const int count = std::min(lines, box.nj - first);
      for (int step = 0; step < box.ni + count - 1; ++step)
        for (int line = std::max(0, step - box.ni + 1); line < std::min(count, step + 1); ++line) {
          const int j = first + line, i = step - line;
          body((std::ptrdiff_t(k) * box.nj + j) * box.ni + i, std::array{i, j, k});
        }
    }
}
/// The same after its upper neighbours.
template <class Body>
SPINDRIFT_INLINE void upper_first(const CellBox& box, Body&& body) {
  const std::ptrdiff_t last = box.count() - 1;
  lower_first(box, [&](std::ptrdiff_t cell, const std::array<int, 3>& from_end) {
    body(last - cell, std::array{box.ni - 1 - from_end[0], box.nj - 1 - from_end[1], box.nk - 1 - from_end[2]});
  });
}

/// Fills the pivots: inverse of D_c - sum over lower neighbours m of A_cm P_m A_mc. Returns a cell whose pivot is singular, the
/// first in the order of lower_first, or -1.
template <int n, class SideNumber>
std::ptrdiff_t factor(const StencilMatrix<n, SideNumber>& a) {
  std::ptrdiff_t singular = -1;
  lower_first(a.box, [&](std::ptrdiff_t cell, const std::array<int, 3>& index) {
    if (singular >= 0) return;
    float pivot[n * n + block_overrun];
    for (int e = 0; e < n * n; ++e) pivot[e] = a.block(cell, a.diagonal)[e];
    for (int d = 0; d < a.directions; ++d) {
      if (index[std::size_t(d)] == 0) continue;
      const std::ptrdiff_t before = cell - a.box.stride(d);
      subtract_product<n>(a.side(cell, 2 * d), a.block(before, a.pivot), a.side(before, 2 * d + 1), pivot);
    }
    if (!invert<n>(pivot, a.block(cell, a.pivot))) singular = cell;
  });
  return singular;
}

/// z = (ILU of a)^-1 r; both [cell][n]; may be the same.
template <int n, class SideNumber>
void solve(const StencilMatrix<n, SideNumber>& a, const float* r, float* z) {
  const CellBox& box = a.box;
  const std::ptrdiff_t row = box.stride(1) * n, plane = box.stride(2) * n;
  float rest[8];
  lower_first(box, [&](std::ptrdiff_t cell, const std::array<int, 3>& index) {
    float* here = z + cell * n;
    TwoSums<n> sums;
    if (a.directions > 2 && index[2] > 0) sums.multiply_add(a.side(cell, 4), here - plane);
    if (index[1] > 0) sums.multiply_add(a.side(cell, 2), here - row);
    if (index[0] > 0) sums.multiply_add(a.side(cell, 0), here - n);
    difference(Column<n>::load_alone(r + cell * n), sums.total()).store(rest);
    multiply<n>(a.block(cell, a.pivot), rest, here);
  });
  upper_first(box, [&](std::ptrdiff_t cell, const std::array<int, 3>& index) {
    float* here = z + cell * n;
    TwoSums<n> sums;
    if (a.directions > 2 && index[2] + 1 < box.nk) sums.multiply_add(a.side(cell, 5), here + plane);
    if (index[1] + 1 < box.nj) sums.multiply_add(a.side(cell, 3), here + row);
    if (index[0] + 1 < box.ni) sums.multiply_add(a.side(cell, 1), here + n);
    if (cell + 1 == box.count()) return;
    sums.total().store(rest);
    TwoSums<n> change;
    change.multiply_add(a.block(cell, a.pivot), rest);
    difference(Column<n>::load_alone(here), change.total()).store(here);
  });
}

}  // namespace spindrift::linear
