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
  using Vector = Eigen::Matrix<double, dim + 1, 1>;

  /// What a ghost node gathers from the water round it: moments of the kernel, and of the density (or a velocity component).
  struct Moments {
    Matrix a = Matrix::Zero();
    Vector b = Vector::Zero();
  };

  /// Adds one water particle: x = node - particle [m], W, its slope, volume V [m^dim], value f (density deviation, velocity).
  static void gather(Moments& m, const Vec<double, dim>& x, double w, double slope, double volume, double f) {
    Vector test;  // W and its gradient at the node
    test(0) = w;
    for (int k = 0; k < dim; ++k) test(k + 1) = slope * x[k];
    Vector position;  // 1 and particle - node
    position(0) = 1.0;
    for (int k = 0; k < dim; ++k) position(k + 1) = -x[k];
    m.a += volume * test * position.transpose();
    m.b += volume * f * test;
  }

  /// Value at the wall particle, `offset` [m] from the ghost node; `none` where the node sees no water, order zero where it sees
  /// little.
  static double value(const Moments& m, const Vec<double, dim>& offset, double h, double none) {
    if (m.a(0, 0) < 1e-3) return none;  // kernel sum: 1 in bulk, 1/2 at a flat surface
    Matrix scaled = m.a;                // columns in h, rows in 1/h: entries of order one
    Vector right = m.b;
    for (int k = 1; k <= dim; ++k) scaled.col(k) /= h, scaled.row(k) *= h, right(k) *= h;
    const Eigen::FullPivLU<Matrix> factors(scaled);
    constexpr double smallest_pivot_ratio = 1e-2;
    const auto pivots = factors.matrixLU().diagonal().cwiseAbs();
    if (pivots.minCoeff() < smallest_pivot_ratio * pivots.maxCoeff()) return m.b(0) / m.a(0, 0);
    const Vector field = factors.solve(right);  // value and h * gradient at the node
    double result = field(0);
    for (int k = 0; k < dim; ++k) result += field(k + 1) * offset[k] / h;
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
