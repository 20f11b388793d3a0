// Density diffusion psi = 2 (rho_j - rho_i - rho^H_ij) x_ji / r^2, Fourtakas et al. (2019), Comput. Fluids 190, eq. 8. rho^H_ij,
// the hydrostatic difference, is linearised: rho0 g (z_i - z_j) / c0^2. The full Tait form needs a pow in the pair loop and
// differs by the fraction (gamma - 1)/2 * g |z_ij| / c0^2: 0.1 % at c0 = 10 sqrt(g H) and pairs H/30 apart.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/density_diffusion.hpp"

namespace spindrift::sph {

template <class Scalar = double>
struct DensityDiffusionFourtakas {
  static constexpr std::string_view name = "fourtakas";
  Scalar delta, c0, h;       ///< [-], [m/s], [m]
  Scalar hydrostatic_slope;  ///< rho0 g / c0^2 [kg/m4]

  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>& pair, Real deviation_i, Real deviation_j, Real inverse) const {
    const Real difference = (deviation_i - deviation_j) + Real(hydrostatic_slope) * pair.x[dim - 1];
    return Real(Scalar(4) * delta * h * c0) * difference * (pair.r2 * pair.slope) * inverse;
  }
};
static_assert(DensityDiffusion<DensityDiffusionFourtakas<>>);

}  // namespace spindrift::sph
