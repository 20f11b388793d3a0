// Sweeps done every so many steps: density filters (Shepard, MLS) and particle shifting. A pair law gathers sums, then each
// particle of a group uses its own.
// Called by sea_sph.cpp; tested in tests/src/sea/sph/filters_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/filter_mls.hpp"
#include "kernels/sph/filter_shepard.hpp"
#include "kernels/sph/shifting.hpp"
#include "src/sea/sph/laws.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// Filters work on the deviation from rho0, which they reproduce as they reproduce constants: small numbers keep their digits in
/// float.
template <class Kernel, class Scalar>
struct LawShepard {
  static constexpr int dim = Kernel::dimensions, sum_planes = FilterShepard::planes;
  Kernel kernel;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const Real w = kernel.value(make_pair(kernel, i.x - j.x, i.v - j.v).r2);
    to_i += FilterShepard::pair_terms(w, Real(Real(1) / (Real(rho0) + j.deviation)), j.deviation);
    to_j += FilterShepard::pair_terms(w, Real(Real(1) / (Real(rho0) + i.deviation)), i.deviation);
  }
};

template <class Kernel, class Scalar>
struct LawMls {
  static constexpr int dim = Kernel::dimensions, sum_planes = FilterMls<dim>::planes;
  Kernel kernel;
  Scalar rho0;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const Pair<Real, dim> pair = make_pair(kernel, i.x - j.x, i.v - j.v);
    const Real w = kernel.value(pair.r2), inverse_h = Real(Scalar(1.0 / kernel.h()));
    to_i += FilterMls<dim>::pair_terms(w, Real(Real(1) / (Real(rho0) + j.deviation)), j.deviation, pair.x, inverse_h);
    to_j += FilterMls<dim>::pair_terms(w, Real(Real(1) / (Real(rho0) + i.deviation)), i.deviation, Real(-1) * pair.x, inverse_h);
  }
};

template <class Kernel>
struct LawShifting {
  static constexpr int dim = Kernel::dimensions, sum_planes = Shifting<dim>::planes;
  Kernel kernel;

  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, dim>& i, const PairState<Real, dim>& j, Vec<Real, sum_planes>& to_i,
                                   Vec<Real, sum_planes>& to_j) const {
    const Vec<Real, sum_planes> terms = Shifting<dim>::pair_terms(make_pair(kernel, i.x - j.x, i.v - j.v));
    for (int k = 0; k < dim; ++k) to_i[k] += terms[k], to_j[k] -= terms[k];
    to_i[dim] += terms[dim], to_j[dim] += terms[dim];
  }
};

/// Calls visit(slot, sums of the slot in double) for the water of a group.
template <int planes, int dim, class Real, class Visit>
void for_water(Store<dim, Real>& store, const Array<Real>& all_sums, int group, Visit&& visit) {
  for (std::uint32_t cluster = store.groups[group].fluid; cluster < store.groups[group].solid; ++cluster) {
    for (int lane = 0; lane < cluster_size; ++lane) {
      const std::size_t slot = std::size_t(cluster) * cluster_size + lane;
      if (store.id[slot] == no_particle) break;
      Vec<double, planes> sums;
      for (int n = 0; n < planes; ++n)
        sums[n] = double(all_sums[std::size_t(cluster) * planes * cluster_size + n * cluster_size + lane]);
      visit(slot, sums);
    }
  }
}

template <int dim, class Real>
void apply_shepard(Store<dim, Real>& store, const Array<Real>& sums, int group) {
  for_water<FilterShepard::planes>(store, sums, group,
                                   [&](std::size_t slot, const auto& s) { store.deviation[slot] = FilterShepard::value(s); });
}
template <int dim, class Real>
void apply_mls(Store<dim, Real>& store, const Array<Real>& sums, int group) {
  for_water<FilterMls<dim>::planes>(store, sums, group,
                                    [&](std::size_t slot, const auto& s) { store.deviation[slot] = FilterMls<dim>::value(s); });
}
/// Sub-particle stress tau/rho^2 of a group from the sums of LawStrain; walls have none.
template <int dim, class Real>
void apply_stress(Store<dim, Real>& store, const Array<Real>& sums, const Parameters& p, int group) {
  constexpr int planes = SymmetricTensor<double, dim>::components;
  const Group& range = store.groups[group];
  std::fill(store.stress.begin() + std::size_t(range.solid) * (planes * cluster_size),
            store.stress.begin() + std::size_t(range.end) * (planes * cluster_size), Real(0));
  for (std::uint32_t cluster = range.fluid; cluster < range.solid; ++cluster) {
    const Real* from = sums.data() + std::size_t(cluster) * (planes * cluster_size);
    Real* to = store.stress.data() + std::size_t(cluster) * (planes * cluster_size);
    for (int lane = 0; lane < cluster_size; ++lane) {
      SymmetricTensor<double, dim> strain;
      for (int n = 0; n < planes; ++n) strain.c[n] = p.mass(dim) * double(from[n * cluster_size + lane]);
      const double rho = p.eos.rho0 + double(store.pack_of(cluster)[2 * dim * cluster_size + lane]);
      const SymmetricTensor<double, dim> tau = ViscositySps{}.stress(strain, p.spacing);
      for (int n = 0; n < planes; ++n) to[n * cluster_size + lane] = Real(tau.c[n] / rho);
    }
  }
}
/// Moves the water of a group; returns the largest displacement [m].
template <int dim, class Real>
double apply_shifting(Store<dim, Real>& store, const Array<Real>& sums, const Parameters& p, int group, double dt) {
  Shifting<dim> shifting;
  shifting.strength = p.shifting;
  const double volume = std::pow(p.spacing, dim);
  double longest = 0.0;
  for_water<Shifting<dim>::planes>(store, sums, group, [&](std::size_t slot, const auto& s) {
    Vec<double, dim> gradient, v;
    for (int k = 0; k < dim; ++k) gradient[k] = volume * s[k], v[k] = store.v[k][slot];
    const Vec<double, dim> dx = shifting.shift(gradient, volume * s[dim], std::sqrt(dot(v, v)), p.h(), dt);
    for (int k = 0; k < dim; ++k) store.x[k][slot] += dx[k];
    longest = std::max(longest, std::sqrt(dot(dx, dx)));
  });
  return longest;
}

}  // namespace spindrift::sph
