// Density diffusion psi = 2 (rho_j - rho_i - rho^H_ij) x_ji / r^2, Fourtakas et al. (2019), Comput. Fluids 190, eq. 8. rho^H_ij,
// the hydrostatic difference, is taken from the slope at the mean density of the pair: at rest d rho/dz = -(rho0 g/c0^2)
// (rho/rho0)^(2 - gamma), here to first order in rho - rho0. The full Tait form needs a pow in the pair loop and differs by
// 1e-3 of itself at c0 = 10 sqrt(g H). (With the slope at rho0 alone still water crept up by 0.025 d in 1e5 steps.)
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/density_diffusion.hpp"
#include "kernels/sph/eos_tait.hpp"

namespace spindrift::sph {

template <class Scalar = double>
class DensityDiffusionFourtakas {
 public:
  static constexpr std::string_view name = "fourtakas";

  DensityDiffusionFourtakas(double delta, double h, const EosTait& eos, double gravity)
      : strength_(Scalar(4.0 * delta * h * eos.c0)),
        slope_(Scalar(eos.rho0 * gravity / (eos.c0 * eos.c0))),
        stiffening_(Scalar(0.5 * (EosTait::gamma - 2.0) * gravity / (eos.c0 * eos.c0))) {}

  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>& pair, Real deviation_i, Real deviation_j, Real inverse) const {
    const Real slope = Real(slope_) - Real(stiffening_) * (deviation_i + deviation_j);
    const Real difference = (deviation_i - deviation_j) + slope * pair.x[dim - 1];
    return Real(strength_) * difference * (pair.r2 * pair.slope) * inverse;
  }

 private:
  Scalar strength_, slope_, stiffening_;  ///< [m2/s], rho0 g/c0^2 [kg/m4], (gamma - 2) g/(2 c0^2) [1/m]
};
static_assert(DensityDiffusion<DensityDiffusionFourtakas<>>);

}  // namespace spindrift::sph
