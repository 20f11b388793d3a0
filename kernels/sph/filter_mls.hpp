// Moving-least-squares filter of density, order one: rho_i = sum_j m_j (b0 + b . x_ij) W_ij with A (b0, b) = (1, 0), A = sum_j
// V_j W_ij y y^T, y = (1, x_ij). Dilts (1999), Int. J. Numer. Meth. Eng. 44; in SPH Colagrossi & Landrini (2003), J. Comput.
// Phys. 191, section 4. Since A is symmetric, rho_i is the first component of A^-1 sum_j m_j W_ij y: one sweep gives all.
// Reproduces linear fields, so it keeps the hydrostatic gradient that the Shepard filter flattens.
// Called by src/sea/sph/filters.hpp; tested in tests/kernels/sph/filter_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

template <int dim>
struct FilterMls {
  static constexpr int n = dim + 1, matrix_planes = n * (n + 1) / 2;
  static constexpr int planes =
      matrix_planes + n;  ///< lower triangle of A by rows, then the right-hand side; all without the mass

  /// Terms of one partner with the field value f_j (density, or its deviation); `x` is x_i - x_j, the particle itself has x = 0.
  /// Offsets are scaled by h, which keeps A well conditioned.
  template <class Real>
  SPINDRIFT_INLINE static Vec<Real, planes> pair_terms(Real w, Real inverse_rho_j, Real f_j, const Vec<Real, dim>& x,
                                                       Real inverse_h) {
    const Real weight = w * inverse_rho_j;
    Real y[n];
    y[0] = Real(1);
    for (int k = 0; k < dim; ++k) y[k + 1] = x[k] * inverse_h;
    Vec<Real, planes> terms;
    int at = 0;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column <= row; ++column) terms[at++] = weight * (y[row] * y[column]);
    for (int row = 0; row < n; ++row) terms[at++] = weight * f_j * y[row];
    return terms;
  }

  /// Filtered value, or that of order zero where too few partners determine a gradient (splashes).
  static double value(const Vec<double, planes>& sums) {
    Eigen::Matrix<double, n, n> a;
    Eigen::Matrix<double, n, 1> b;
    int at = 0;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column <= row; ++column) a(row, column) = a(column, row) = sums[at++];
    for (int row = 0; row < n; ++row) b(row) = sums[at++];
    const Eigen::LDLT<Eigen::Matrix<double, n, n>> factors(a);
    const auto pivots = factors.vectorD();
    constexpr double smallest_pivot_ratio = 1e-3;  // a regular neighbourhood has about 0.2 (second moment of the kernel in h^2)
    if (pivots.minCoeff() < smallest_pivot_ratio * pivots.maxCoeff()) return b(0) / a(0, 0);
    return factors.solve(b)(0);
  }
};

}  // namespace spindrift::sph
