// Artificial viscosity: Pi_ij = -alpha c0 mu_ij / rho_ij for approaching particles, mu_ij = h v_ij.x_ij / (r^2 + 0.01 h^2), else
// zero. Monaghan (1992), eq. 4.1 with beta = 0 and c = c0; alpha = 0.1 in Leble & Barakos (2016), section 2.2.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

template <class Scalar = double>
struct ViscosityArtificial {
  Scalar alpha, c0, h;  ///< [-], [m/s], [m]

  /// Pi_ij >= 0 [Pa m6/kg2], to be added to the pressures of momentum_symmetric. `inverse` is 1 / ((rho_i + rho_j)(r^2 + 0.01
  /// h^2)).
  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>& pair, Real inverse) const {
    using std::min;
    return Real(Scalar(-2) * alpha * c0 * h) * (min(pair.v_dot_x, Real(0)) * inverse);
  }

  /// Kinematic viscosity [m2/s] of the same term acting on all pairs: alpha c0 h / (2 (dim + 2)). Monaghan (2005), Rep. Prog.
  /// Phys. 68, eq. 8.8. Acting on approaching pairs only it dissipates about half of that in shear.
  double equivalent_kinematic(int dim) const { return double(alpha * c0 * h) / (2.0 * (dim + 2)); }
};

}  // namespace spindrift::sph
