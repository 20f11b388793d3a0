// Momentum of SPH in the symmetric form: dv_i/dt = - sum_j m_j (p_i/rho_i^2 + p_j/rho_j^2) grad_i W_ij. Monaghan (1992), eq. 3.3.
// Antisymmetric in i and j, and along x_ij: linear and angular momentum are conserved pair by pair.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

/// Factor f of the acceleration of i per unit mass of j, f * x_ij; that of j is -f * x_ij. Arguments p/rho^2 [Pa m6/kg2];
/// further stresses per rho^2 (artificial viscosity) go into `more`.
template <class Real, int dim>
SPINDRIFT_INLINE Real momentum_symmetric(const Pair<Real, dim>& pair, Real p_rho2_i, Real p_rho2_j, Real more) {
  return -((p_rho2_i + p_rho2_j) + more) * pair.slope;
}

}  // namespace spindrift::sph
