// What a pair of particles does to both partners: the terms of kernels/sph put together for one sweep.
// Called by sweep_pairs.hpp with Real = Wide<...> and by the tests with Real = double; tested in
// tests/src/sea/sph/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/continuity.hpp"
#include "kernels/sph/density_diffusion.hpp"
#include "kernels/sph/kernel.hpp"
#include "kernels/sph/momentum.hpp"
#include "kernels/sph/viscosity_artificial.hpp"

namespace spindrift::sph {

/// What a pair law reads of a particle: the planes of `pack`.
template <class Real, int dim>
struct PairState {
  Vec<Real, dim> x, v;
  Real deviation, p_rho2;
};

/// Rates of velocity and density. A law adds to `sum_planes` sums of each partner, each a plane of 16 per cluster. All particles
/// of a sea have one mass, which is taken out of the sums.
template <class Kernel, class Diffusion, class Scalar>
struct LawMotion {
  static constexpr int dim = Kernel::dimensions;
  static constexpr int sum_planes = dim + 1;  ///< acceleration, density rate, per unit mass of the partner
  Kernel kernel;
  ViscosityArtificial<Scalar> viscosity;
  Diffusion diffusion;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const Pair<Real, dim> pair = make_pair(kernel, i.x - j.x, i.v - j.v);
    const Real density_sum = (i.deviation + Real(Scalar(2) * rho0)) + j.deviation;
    const Real inverse = reciprocal(density_sum * (pair.r2 + Real(softening(Scalar(kernel.h())))));
    const Real factor = momentum_symmetric(pair, i.p_rho2, j.p_rho2, viscosity(pair, inverse));
    const Real rate = continuity(pair), flow = diffusion(pair, i.deviation, j.deviation, inverse);
    for (int k = 0; k < dim; ++k) {
      to_i[k] += factor * pair.x[k];
      to_j[k] -= factor * pair.x[k];
    }
    to_i[dim] += rate + flow;
    to_j[dim] += rate - flow;
  }
};

}  // namespace spindrift::sph
