// Morison's equation for a moving cylinder element in moving water, and for its flat ends (Morison et al. 1950; relative form
// with Froude-Krylov kept whole: Chakrabarti 1987, ch. 6; DNV-RP-C205, 6.2). The term in the body's own acceleration is not here
// but in the mass matrix of the body. Equations: docs/theory/sea_engineering.md, section 3. Called by src/sea; tested in
// tests/kernels/waves/wave_kernels_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

/// Part of a vector across a unit axis.
inline Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& axis) { return v - v.dot(axis) * axis; }

/// Transverse drag [N] on a projected area [m2]; `relative` is water minus body velocity [m/s].
inline Eigen::Vector3d drag_across(double density, double coefficient, double area, const Eigen::Vector3d& relative,
                                   const Eigen::Vector3d& axis) {
  const Eigen::Vector3d v = across(relative, axis);
  return 0.5 * density * coefficient * area * v.norm() * v;
}

/// Drag [N] of a flat end along the axis, on the area of the disc [m2].
inline Eigen::Vector3d drag_end(double density, double coefficient, double area, const Eigen::Vector3d& relative,
                                const Eigen::Vector3d& axis) {
  const double v = relative.dot(axis);
  return 0.5 * density * coefficient * area * std::abs(v) * v * axis;
}

/// Added mass [kg] of a flat end moving along its axis, on the mass of water in a hemisphere over it; of its radius, R^3 [m3].
inline double added_mass_end(double density, double coefficient, double cube) {
  return coefficient * density * 2.0 / 3.0 * pi * cube;
}

/// Cross product as a matrix: cross_matrix(a) b = a x b.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// Adds the inertia K [kg] of water at `arm` [m] from the reference point to a 6x6 mass matrix [force; moment] about that point.
inline void add_point_inertia(const Eigen::Matrix3d& k, const Eigen::Vector3d& arm, Eigen::Matrix<double, 6, 6>& mass) {
  const Eigen::Matrix3d a = cross_matrix(arm), ka = k * a, ak = a * k;
  mass.topLeftCorner<3, 3>() += k;
  mass.topRightCorner<3, 3>() -= ka;
  mass.bottomLeftCorner<3, 3>() += ak;
  mass.bottomRightCorner<3, 3>() -= ak * a;
}

}  // namespace spindrift::waves
