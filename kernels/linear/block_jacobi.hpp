// Block-Jacobi: each cell's own block inverted, neighbours left out. In the place where block ILU keeps its pivots
// (block_ilu.hpp). Called by src/aero/flow/preconditioner.cpp; tested in tests/src/aero/flow/linear_solver_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/linear/stencil_matrix.hpp"

namespace spindrift::linear {

/// Inverts the diagonal blocks into the pivots. Returns the first cell whose block is singular, or -1.
template <int n, class SideNumber>
std::ptrdiff_t factor_diagonal(const StencilMatrix<n, SideNumber>& a) {
  const std::ptrdiff_t cells = a.box.count();
  for (std::ptrdiff_t cell = 0; cell < cells; ++cell)
    if (!invert<n>(a.block(cell, a.diagonal), a.block(cell, a.pivot))) return cell;
  return -1;
}

/// z = (diagonal of a)^-1 r; both [cell][n]; may be the same.
template <int n, class SideNumber>
void solve_diagonal(const StencilMatrix<n, SideNumber>& a, const float* r, float* z) {
  const std::ptrdiff_t cells = a.box.count();
  for (std::ptrdiff_t cell = 0; cell < cells; ++cell) multiply<n>(a.block(cell, a.pivot), r + cell * n, z + cell * n);
}

}  // namespace spindrift::linear
