// mDBC, modified dynamic boundary: density of a wall particle extrapolated from a ghost node mirrored into the water, by a
// first-order consistent interpolation. English et al. (2022), Comput. Part. Mech. 9, eqs. 9-14; interpolation of Liu & Liu
// (2006), Appl. Numer. Math. 56. For the walls of src/sea/sph; tested in tests/kernels/sph/boundary_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

template <int dim>
struct BoundaryModified {
  using Matrix = Eigen::Matrix<double, dim + 1, dim + 1>;

  static constexpr int n = dim + 1, fields = dim + 1;  ///< fields: density deviation, velocity
  /// Sums of a ghost node over the water: the matrix by rows, then a right-hand side for each field.
  static constexpr int planes = n * (n + fields);

  /// Terms of one water particle: x = node - particle [m], W, its slope, volume V [m^dim], values of the fields. Lengths are in
  /// units of h, so that the entries are of order one.
  template <class Real>
  SPINDRIFT_INLINE static Vec<Real, planes> pair_terms(const Vec<Real, dim>& x, Real w, Real slope, Real volume,
                                                       const Vec<Real, fields>& values, Real h, Real inverse_h) {
    Real test[n];  // V times W and its gradient at the node
    test[0] = volume * w;
    for (int k = 0; k < dim; ++k) test[k + 1] = (volume * slope * h) * x[k];
    Vec<Real, planes> terms;
    for (int row = 0; row < n; ++row) {
      terms[row * n] = test[row];
      for (int k = 0; k < dim; ++k) terms[row * n + k + 1] = -(test[row] * (x[k] * inverse_h));  // particle - node
      for (int field = 0; field < fields; ++field) terms[n * n + field * n + row] = test[row] * values[field];
    }
    return terms;
  }

  /// What a wall particle takes from its node: whether the node sees water at all, the density deviation carried on linearly
  /// from the node to the particle, the velocity at the node.
  struct Seen {
    bool water = false;
    double deviation = 0.0;
    Vec<double, dim> velocity{};
  };
  /// `offset`: wall particle - node [m]. Of order zero where too few particles determine a gradient.
  static Seen seen(const Vec<double, planes>& sums, const Vec<double, dim>& offset, double h) {
    Seen result;
    constexpr double least_kernel_sum = 1e-3;  // 1 in bulk, 1/2 at a flat surface
    if (!(sums[0] > least_kernel_sum)) return result;
    result.water = true;
    Matrix a;
    Eigen::Matrix<double, n, fields> b;
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) a(row, column) = sums[row * n + column];
      for (int field = 0; field < fields; ++field) b(row, field) = sums[n * n + field * n + row];
    }
    const Eigen::FullPivLU<Matrix> factors(a);
    constexpr double smallest_pivot_ratio = 1e-2;
    const auto pivots = factors.matrixLU().diagonal().cwiseAbs();
    Eigen::Matrix<double, n, fields> value = b / a(0, 0);
    if (pivots.minCoeff() >= smallest_pivot_ratio * pivots.maxCoeff())
      value = factors.solve(b);  // value and h * gradient at the node
    else
      value.template bottomRows<dim>().setZero();
    result.deviation = value(0, 0);
    for (int k = 0; k < dim; ++k) {
      result.deviation += value(k + 1, 0) * offset[k] / h;
      result.velocity[k] = value(0, k + 1);
    }
    return result;
  }

  /// Velocity of a wall particle that makes the flow stick (no-slip) or slide (free-slip) at the wall: mirror of the water's at
  /// the node.
  static Vec<double, dim> velocity(const Vec<double, dim>& water, const Vec<double, dim>& wall, const Vec<double, dim>& normal,
                                   bool slip) {
    const Vec<double, dim> relative = water - wall;
    if (!slip) return wall - relative;
    return wall + relative - (2.0 * dot(relative, normal)) * normal;
  }
};

}  // namespace spindrift::sph
