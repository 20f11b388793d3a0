// Laminar viscosity with the sub-particle-scale (SPS) model of turbulence.
// Laminar, Lo & Shao (2002), Appl. Ocean Res. 24, eq. 10:
//   dv_i/dt = sum_j m_j 4 nu x_ij.grad W_ij / ((rho_i + rho_j) r^2) v_ij
// without their 0.01 h^2 beside r^2: x_ij.grad W_ij / r^2 = W'/r stays finite, and the addition takes 1 to 4 % of the viscosity.
// SPS, Dalrymple & Rogers (2006), Coast. Eng. 53, eq. 17:
//   dv_i/dt = sum_j m_j (tau_i/rho_i^2 + tau_j/rho_j^2) . grad W_ij,  nu_t = (C_s delta)^2 |S|,  |S|^2 = 2 S:S,
//   tau/rho = 2 nu_t S - (2/3) k 1 - (2/3) C_I delta^2 |S|^2 1,  C_s = 0.12, C_I = 0.0066, with k taken up by the pressure.
// For pair laws; tested in tests/kernels/sph/viscosity_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

template <class Scalar = double>
struct ViscosityLaminar {
  Scalar nu;  ///< kinematic viscosity [m2/s]

  /// Factor f of the acceleration of i per unit mass of j, f * v_ij; that of j is -f * v_ij.
  /// `inverse_density_sum` is 1 / (rho_i + rho_j).
  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>& pair, Real inverse_density_sum) const {
    return Real(Scalar(4) * nu) * pair.slope * inverse_density_sum;
  }
};

/// Symmetric tensor by its upper triangle: xx, xz, zz in 2-D; xx, xy, xz, yy, yz, zz in 3-D.
template <class Real, int dim>
struct SymmetricTensor {
  static constexpr int components = dim * (dim + 1) / 2;
  Vec<Real, components> c;
  static constexpr int place(int a, int b) { return a <= b ? a * dim - a * (a - 1) / 2 + (b - a) : place(b, a); }
  Real& operator()(int a, int b) { return c[place(a, b)]; }
  const Real& operator()(int a, int b) const { return c[place(a, b)]; }
};

struct ViscositySps {
  double smagorinsky = 0.12, isotropic = 0.0066;

  /// tau/rho [m2/s2] from the strain rate S [1/s]; delta is the particle spacing [m].
  template <int dim>
  SymmetricTensor<double, dim> stress(const SymmetricTensor<double, dim>& strain, double delta) const {
    double s2 = 0.0;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) s2 += 2.0 * strain(a, b) * strain(a, b);
    const double nu_t = smagorinsky * smagorinsky * delta * delta * std::sqrt(s2);
    SymmetricTensor<double, dim> tau;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b)
        tau(a, b) = 2.0 * nu_t * strain(a, b) - (a == b ? 2.0 / 3.0 * isotropic * delta * delta * s2 : 0.0);
    return tau;
  }

  /// Term of one partner in the strain rate of i, times its volume: (v_j - v_i) grad W made symmetric. The same for the partner.
  template <class Real, int dim>
  SPINDRIFT_INLINE static SymmetricTensor<Real, dim> strain_terms(const Pair<Real, dim>& pair) {
    SymmetricTensor<Real, dim> s;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b)
        s(a, b) = Real(scalar_of<Real>(-0.5)) * pair.slope * (pair.v[a] * pair.x[b] + pair.v[b] * pair.x[a]);
    return s;
  }

  /// Acceleration of i per unit mass of j from the sum of both tau/rho^2; that of j is the opposite.
  template <class Real, int dim>
  SPINDRIFT_INLINE static Vec<Real, dim> acceleration(const Pair<Real, dim>& pair,
                                                      const SymmetricTensor<Real, dim>& tau_rho2_sum) {
    Vec<Real, dim> a;
    for (int k = 0; k < dim; ++k) {
      a[k] = tau_rho2_sum(k, 0) * pair.x[0];
      for (int b = 1; b < dim; ++b) a[k] += tau_rho2_sum(k, b) * pair.x[b];
      a[k] *= pair.slope;
    }
    return a;
  }
};

}  // namespace spindrift::sph
