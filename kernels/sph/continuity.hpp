// Continuity of SPH: d rho_i/dt = sum_j m_j v_ij . grad_i W_ij. Monaghan (1992), eq. 2.18.
// The term of a pair is the same number for both partners (v_ij and grad_i W_ij change sign together), so it is computed once.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

/// Density rate per unit mass of the partner [1/(m3 s)], for i and for j.
template <class Real, int dim>
SPINDRIFT_INLINE Real continuity(const Pair<Real, dim>& pair) {
  return pair.v_dot_x * pair.slope;
}

}  // namespace spindrift::sph
