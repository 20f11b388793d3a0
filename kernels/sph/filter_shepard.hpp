// Shepard filter of density, order zero: rho_i = sum_j m_j W_ij / sum_j (m_j/rho_j) W_ij, the particle itself included.
// Shepard (1968), Proc. 23rd ACM Nat. Conf.; in SPH Panizzo (2004), and the filter of Leble & Barakos (2016), section 4.4.
// Reproduces constants, also at free surfaces. Called by src/sea/sph/filters.hpp; tested in tests/kernels/sph/filter_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

/// Interpolates any field f; of the density it is the filter above, because m_j W_ij = V_j W_ij rho_j.
struct FilterShepard {
  static constexpr int planes = 2;  ///< sums of W/rho_j and of W f_j/rho_j

  template <class Real>
  SPINDRIFT_INLINE static Vec<Real, planes> pair_terms(Real w, Real inverse_rho_j, Real f_j) {
    return {{w * inverse_rho_j, w * inverse_rho_j * f_j}};
  }
  static double value(const Vec<double, planes>& sums) { return sums[1] / sums[0]; }
};

}  // namespace spindrift::sph
