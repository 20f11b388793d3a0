// Density diffusion psi = 2 (rho_j - rho_i) x_ji / r^2, Molteni & Colagrossi (2009), Comput. Phys. Commun. 180, eq. 11.
// Acts on the hydrostatic gradient too, so the surface rises slowly; density_diffusion_fourtakas does not.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/density_diffusion.hpp"

namespace spindrift::sph {

template <class Scalar = double>
struct DensityDiffusionMolteni {
  static constexpr std::string_view name = "molteni";
  Scalar delta, c0, h;  ///< [-] (0.1 is usual), [m/s], [m]

  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>& pair, Real deviation_i, Real deviation_j, Real inverse) const {
    return Real(Scalar(4) * delta * h * c0) * (deviation_i - deviation_j) * (pair.r2 * pair.slope) * inverse;
  }
};

static_assert(DensityDiffusion<DensityDiffusionMolteni<>>);

}  // namespace spindrift::sph
