// What a pair of particles does to both partners: the terms of kernels/sph put together for one sweep.
// Called by sweep_pairs.hpp with Real = Wide<...> and by the tests with Real = double; tested in
// tests/src/sea/sph/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/continuity.hpp"
#include "kernels/sph/density_diffusion.hpp"
#include "kernels/sph/kernel.hpp"
#include "kernels/sph/momentum.hpp"
#include "kernels/sph/viscosity_laminar_sps.hpp"

namespace spindrift::sph {

/// What a pair law reads of a particle: the planes of `pack`.
template <class Real, int dim>
struct PairState {
  Vec<Real, dim> x, v;
  Real deviation, p_rho2;
};

/// Rates of velocity and density; the viscosity acts along the line of centres, as a pressure. A law adds to `sum_planes` sums of
/// each partner, each a plane of 16 per cluster. All particles of a sea have one mass, which is taken out of the sums.
template <class Kernel, class Viscosity, class Diffusion, class Scalar>
struct LawMotion {
  static constexpr int dim = Kernel::dimensions;
  static constexpr int sum_planes = dim + 1;  ///< acceleration, density rate, per unit mass of the partner
  Kernel kernel;
  Viscosity viscosity;
  Diffusion diffusion;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const Real density_sum = (i.deviation + Real(Scalar(2) * rho0)) + j.deviation;
    Real inverse;
    const Pair<Real, dim> pair = make_pair(kernel, i.x - j.x, i.v - j.v, density_sum, inverse);
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

/// The same with a viscosity that acts along the relative velocity, and with `sub_particle` the stress of unresolved turbulence:
/// then the sweep hands over tau/rho^2 of both partners, `stress_planes` planes per cluster.
template <class Kernel, class Viscosity, class Diffusion, class Scalar, bool sub_particle>
struct LawDrag {
  static constexpr int dim = Kernel::dimensions;
  static constexpr int sum_planes = dim + 1;
  static constexpr int stress_planes = sub_particle ? SymmetricTensor<Scalar, dim>::components : 0;
  Kernel kernel;
  Viscosity viscosity;
  Diffusion diffusion;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    Real inverse;
    const Pair<Real, dim> pair = make_pair(kernel, i.x - j.x, i.v - j.v, density_sum(i, j), inverse);
    add(pair, i, j, inverse, terms(pair, i, j, inverse), to_i, to_j);
  }
  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j,
                                   const SymmetricTensor<Real, dim>& tau_i, const SymmetricTensor<Real, dim>& tau_j,
                                   Vec<Real, sum_planes>& to_i, Vec<Real, sum_planes>& to_j) const {
    Real inverse;
    const Pair<Real, dim> pair = make_pair(kernel, i.x - j.x, i.v - j.v, density_sum(i, j), inverse);
    const SymmetricTensor<Real, dim> tau_sum{tau_i.c + tau_j.c};
    add(pair, i, j, inverse, terms(pair, i, j, inverse) + ViscositySps::acceleration(pair, tau_sum), to_i, to_j);
  }

 private:
  template <class Real>
  SPINDRIFT_INLINE Real density_sum(const PairState<Real, dim>& i, const PairState<Real, dim>& j) const {
    return (i.deviation + Real(Scalar(2) * rho0)) + j.deviation;
  }
  /// Acceleration of i: pressure along x_ij, viscosity along v_ij.
  template <class Real>
  SPINDRIFT_INLINE Vec<Real, dim> terms(const Pair<Real, dim>& pair, const PairState<Real, dim>& i, const PairState<Real, dim>& j,
                                        const Real& inverse) const {
    const Real inverse_density = inverse * (pair.r2 + Real(softening(Scalar(kernel.h()))));
    const Real pressure = momentum_symmetric(pair, i.p_rho2, j.p_rho2, Real(0)), drag = viscosity(pair, inverse_density);
    return pressure * pair.x + drag * pair.v;
  }
  template <class Real>
  SPINDRIFT_INLINE void add(const Pair<Real, dim>& pair, const PairState<Real, dim>& i, const PairState<Real, dim>& j,
                            const Real& inverse, const Vec<Real, dim>& acceleration, Vec<Real, sum_planes>& to_i,
                            Vec<Real, sum_planes>& to_j) const {
    const Real rate = continuity(pair), flow = diffusion(pair, i.deviation, j.deviation, inverse);
    for (int k = 0; k < dim; ++k) to_i[k] += acceleration[k], to_j[k] -= acceleration[k];
    to_i[dim] += rate + flow;
    to_j[dim] += rate - flow;
  }
};

/// Rate of strain, for the sub-particle stress: sums of volume times the symmetric part of v_ji grad W, per unit mass.
template <class Kernel, class Scalar>
struct LawStrain {
  static constexpr int dim = Kernel::dimensions, sum_planes = SymmetricTensor<Scalar, dim>::components;
  Kernel kernel;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const SymmetricTensor<Real, dim> strain = ViscositySps::strain_terms(make_pair(kernel, i.x - j.x, i.v - j.v));
    to_i += (Real(1) / (Real(rho0) + j.deviation)) * strain.c;
    to_j += (Real(1) / (Real(rho0) + i.deviation)) * strain.c;
  }
};

/// Rates between water and solids. The water feels a solid's particle with its weight over water's, Store::weights: so much more
/// or less than what the law says, which is per unit mass of water.
template <class Law>
struct LawOfSolids : Law {
  static constexpr bool weighs = true;
};
template <class Law>
inline constexpr bool weighs = requires {
  Law::weighs;
};

/// How many planes of stress a law reads of each partner.
template <class Law>
inline constexpr int stress_planes = [] {
  if constexpr (requires { Law::stress_planes; })
    return Law::stress_planes;
  else
    return 0;
}();

}  // namespace spindrift::sph
