// The pair sweep: every pair of particles within reach once, both partners updated ("symmetric"), one particle against 16 lanes
// at a time. A group adds to itself and its forward neighbours; groups of one colour (columns.hpp) may run at once. No locks;
// the order of the terms of every sum is fixed by the scene and the sorting. Layouts tried and their speeds:
// docs/developer/notes/sea.md. Called by sea_sph.hpp; tested in tests/src/sea/sph/sweep_test.cpp against all pairs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/sea/sph/laws.hpp"
#include "src/sea/sph/search.hpp"

namespace spindrift::sph {

template <int dim, class V, class Real = scalar_of<V>>
SPINDRIFT_INLINE PairState<V, dim> load_state(const Real* planes, int lane) {
  PairState<V, dim> s;
  for (int k = 0; k < dim; ++k) {
    s.x[k] = V::load(planes + k * cluster_size + lane);
    s.v[k] = V::load(planes + (dim + k) * cluster_size + lane);
  }
  s.deviation = V::load(planes + 2 * dim * cluster_size + lane);
  s.p_rho2 = V::load(planes + (2 * dim + 1) * cluster_size + lane);
  return s;
}
/// One particle in all lanes.
template <int dim, class V, class Real = scalar_of<V>>
SPINDRIFT_INLINE PairState<V, dim> spread_state(const Real* planes, int lane) {
  PairState<V, dim> s;
  for (int k = 0; k < dim; ++k) {
    s.x[k] = V(planes[k * cluster_size + lane]);
    s.v[k] = V(planes[(dim + k) * cluster_size + lane]);
  }
  s.deviation = V(planes[2 * dim * cluster_size + lane]);
  s.p_rho2 = V(planes[(2 * dim + 1) * cluster_size + lane]);
  return s;
}
template <int planes, class V, class Real = scalar_of<V>>
SPINDRIFT_INLINE Vec<V, planes> load_sums(const Real* from, int lane) {
  Vec<V, planes> sums;
  for (int n = 0; n < planes; ++n) sums[n] = V::load(from + n * cluster_size + lane);
  return sums;
}
template <int planes, class V, class Real = scalar_of<V>>
SPINDRIFT_INLINE void store_sums(const Vec<V, planes>& sums, Real* to, int lane) {
  for (int n = 0; n < planes; ++n) sums[n].store(to + n * cluster_size + lane);
}

/// The sub-particle stress of one particle in all lanes; nothing for laws without.
struct NoStress {};
template <class Law, class V, int dim, class Real = scalar_of<V>>
SPINDRIFT_INLINE auto spread_stress(const Store<dim, Real>& store, std::uint32_t cluster, int lane) {
  if constexpr (stress_planes < Law >> 0) {
    SymmetricTensor<V, dim> tau;
    const Real* planes = store.stress.data() + std::size_t(cluster) * (stress_planes<Law> * cluster_size);
    for (int n = 0; n < stress_planes<Law>; ++n) tau.c[n] = V(planes[n * cluster_size + lane]);
    return tau;
  } else {
    return NoStress{};
  }
}

/// Which of the two partners has a weight of its own: the other's sums grow with it.
enum class Heavy { neither, i, j };

/// One particle, spread over all lanes, against one cluster; `both`: its partners are updated too. weight: that of the heavy one.
template <bool both, Heavy heavy, class Law, class V, class Stress, int dim, class Real = scalar_of<V>>
SPINDRIFT_INLINE void particle_against_cluster(Vec<V, Law::sum_planes>& to_i, const PairState<V, dim>& i, const Stress& tau_i,
                                               const Real* state, const Real* stress, Real* sums, const Law& law,
                                               [[maybe_unused]] Real weight = Real(1)) {
  using Sums = Vec<V, Law::sum_planes>;
  for (int lane = 0; lane < cluster_size; lane += V::size) {
    const auto add = [&](Sums& of_i, Sums& of_j) {
      if constexpr (stress_planes < Law >> 0)
        law(i, load_state<dim, V>(state, lane), tau_i, SymmetricTensor<V, dim>{load_sums<stress_planes<Law>, V>(stress, lane)},
            of_i, of_j);
      else
        law(i, load_state<dim, V>(state, lane), of_i, of_j);
    };
    Sums to_j = load_sums<Law::sum_planes, V>(sums, lane);
    if constexpr (heavy == Heavy::j) {
      Sums from_j{};
      add(from_j, to_j);
      to_i += V(weight) * from_j;
    } else if constexpr (heavy == Heavy::i) {
      Sums from_i{};
      add(to_i, from_i);
      to_j += V(weight) * from_i;
    } else {
      add(to_i, to_j);
    }
    if constexpr (both) store_sums<Law::sum_planes, V>(to_j, sums, lane);
  }
}

/// One particle against the first `count` chosen candidates. weight: its own, where it is the heavy one.
template <Heavy heavy, class Law, class V, class Stress, int dim, class Real>
SPINDRIFT_INLINE void particle_against_chosen(Vec<V, Law::sum_planes>& to_i, const PairState<V, dim>& i, const Stress& tau_i,
                                              const Store<dim, Real>& store, const Candidates<dim, Real>& candidates, int count,
                                              const Law& shared_law, Real weight = Real(1)) {
  const Law law = shared_law;  // a copy that no store can alias, so that its constants stay in registers
  const typename Candidates<dim, Real>::View near = candidates.view();
  const Real *const pack = store.pack.data(), *const stress = store.stress.data();
  Vec<V, Law::sum_planes> received = to_i;
  for (int n = 0; n < count; ++n) {
    const std::uint32_t candidate = near.chosen[n];
    const std::size_t other = near.cluster[candidate];
    PairState<V, dim> seen = i;
    for (int k = 0; k < dim; ++k) seen.x[k] += V(near.shift[k][candidate]);
    if constexpr (heavy == Heavy::j) weight = Real(store.weight_of(other));
    particle_against_cluster<true, heavy>(received, seen, tau_i, pack + other * (pack_planes<dim> * cluster_size),
                                          stress + other * (stress_planes<Law> * cluster_size), near.sums[candidate], law,
                                          weight);
  }
  to_i = received;
}

/// The same where one partner is a solid's, which may have a weight.
template <Heavy heavy, class Law, class V, class Stress, int dim, class Real>
SPINDRIFT_INLINE void water_against_solids(Vec<V, Law::sum_planes>& to_i, const PairState<V, dim>& i, const Stress& tau_i,
                                           const Store<dim, Real>& store, const Candidates<dim, Real>& candidates, int count,
                                           const Law& law, double weight) {
  if constexpr (weighs<Law>)
    if (!store.weights.empty())
      return particle_against_chosen<heavy>(to_i, i, tau_i, store, candidates, count, law, Real(weight));
  particle_against_chosen<Heavy::neither>(to_i, i, tau_i, store, candidates, count, law);
}

/// Where a sweep adds up: for each cluster of own groups the planes of its law, zero before. `carried`: what groups add to those
/// of the next row of columns, and is then added to `own` (join_carried). Both may be the same where one thread sweeps.
template <class Real>
struct SweepSums {
  Real *own, *carried;
  std::size_t carried_stride;  ///< numbers from one cluster to the next: the same for all laws, so that groups keep their places
};

/// What one cluster meets in a sweep, found anew for each; one per thread.
template <int dim, class Real>
struct NeighbourLists {
  Candidates<dim, Real> water, solid;
  Array<Real> unused;  ///< what a sweep adds to groups of other ranks and to images
  void reserve(std::size_t clusters) { water.reserve(clusters), solid.reserve(clusters); }
  void clear() { water.clear(), solid.clear(); }
};

/// The pairs of cluster `mine` with all that it meets; sums: its own. Pairs inside a cluster of water are computed from both
/// ends, one-sided. `inside`: with the pairs inside the cluster.
// flatten: gcc 12 leaves calls of functions that are marked to be inlined always, which cost a twentieth of a sweep.
template <bool is_water, class LawWater, class LawSolid, int dim, class Real>
__attribute__((flatten)) void sweep_cluster(const Store<dim, Real>& store, Real* sums, std::uint32_t mine,
                                            NeighbourLists<dim, Real>& meets, float reach, bool inside, const LawWater& water,
                                            const LawSolid& solid) {
  using V = LineWide<Real>;
  const Real* state = store.pack_of(mine);
  constexpr int planes = LawWater::sum_planes;
  static_assert(planes == LawSolid::sum_planes && stress_planes<LawWater> == stress_planes<LawSolid>);
  const Real* stress = store.stress.data() + std::size_t(mine) * (stress_planes<LawWater> * cluster_size);
  std::array<float, dim> corner;
  for (int k = 0; k < dim; ++k) corner[k] = store.frame(k, mine);
  for (int lane = 0; lane < cluster_size; ++lane) {
    if (store.id[mine * cluster_size + lane] == no_particle) break;  // empty lanes are the last ones
    std::array<float, dim> point;
    for (int k = 0; k < dim; ++k) point[k] = corner[k] + float(state[k * cluster_size + lane]);
    const PairState<V, dim> i = spread_state<dim, V>(state, lane);
    const auto tau_i = spread_stress<LawWater, V>(store, mine, lane);
    Vec<V, planes> to_i{};
    if constexpr (is_water) {
      if (inside) particle_against_cluster<false, Heavy::neither>(to_i, i, tau_i, state, stress, sums, water);
      particle_against_chosen<Heavy::neither>(to_i, i, tau_i, store, meets.water, meets.water.choose(point, reach), water);
      if (meets.solid.size() > 0)
        water_against_solids<Heavy::j>(to_i, i, tau_i, store, meets.solid, meets.solid.choose(point, reach), solid, 1.0);
    } else {
      water_against_solids<Heavy::i>(to_i, i, tau_i, store, meets.water, meets.water.choose(point, reach), solid,
                                     store.weight_of(mine));
    }
    for (int n = 0; n < planes; ++n) sums[n * cluster_size + lane] += sum(to_i[n]);
  }
}

/// The pairs of one group: water with water by the law `water`, water with walls and bodies by `solid`. Solids do not meet each
/// other. reach: support plus the rounding of boxes [m]. is_own: tells of groups whether this rank owns them. Of a group of
/// another rank only its pairs with own groups are computed, in the order in which that rank computes them, so that the sums of
/// own groups have the same bits on any number of ranks.
template <class LawWater, class LawSolid, int dim, class Real, class IsOwn>
void sweep_pairs(const Store<dim, Real>& store, SweepSums<Real> sums, const Columns<dim>& columns, int group, float reach,
                 NeighbourLists<dim, Real>& meets, const LawWater& water, const LawSolid& solid, IsOwn&& is_own) {
  constexpr std::size_t size = LawWater::sum_planes * cluster_size;
  const Group& own = store.groups[group];
  const bool all = is_own(group);
  const std::array<double, dim> here{};
  meets.unused.assign(store.longest * size, Real(0));
  const auto sums_of = [&](std::uint32_t cluster) { return all ? sums.own + cluster * size : meets.unused.data(); };
  const auto add_neighbours = [&](std::uint32_t mine, bool with_solids) {
    columns.for_forward(group, [&](const Neighbour<dim>& near) {
      const bool mine_to_add = is_own(near.group);
      if (!all && !mine_to_add) return;
      const Group& other = store.groups[near.group];
      const bool carries = mine_to_add && near.in_next_row;
      const std::size_t stride = carries ? sums.carried_stride : size;
      Real* const to = carries       ? sums.carried + other.fluid * stride
                       : mine_to_add ? sums.own + other.fluid * stride
                                     : meets.unused.data();
      meets.water.add(store, mine, other.fluid, other.solid, near.shift, reach, to, stride);
      if (with_solids)
        meets.solid.add(store, mine, other.solid, other.end, near.shift, reach, to + (other.solid - other.fluid) * stride,
                        stride);
    });
  };
  for (std::uint32_t mine = own.fluid; mine < own.solid; ++mine) {
    meets.clear();
    if (all) {
      meets.water.add(store, mine, mine + 1, own.solid, here, reach, sums_of(mine + 1), size);
      meets.solid.add(store, mine, own.solid, own.end, here, reach, sums_of(own.solid), size);
    }
    add_neighbours(mine, true);
    sweep_cluster<true>(store, sums_of(mine), mine, meets, reach, all, water, solid);
  }
  for (std::uint32_t mine = own.solid; mine < own.end; ++mine) {
    meets.clear();
    add_neighbours(mine, false);
    if (meets.water.size() > 0) sweep_cluster<false>(store, sums_of(mine), mine, meets, reach, false, water, solid);
  }
}

/// The same where this rank owns all groups.
template <class LawWater, class LawSolid, int dim, class Real>
void sweep_pairs(const Store<dim, Real>& store, SweepSums<Real> sums, const Columns<dim>& columns, int group, float reach,
                 NeighbourLists<dim, Real>& meets, const LawWater& water, const LawSolid& solid) {
  sweep_pairs(store, sums, columns, group, reach, meets, water, solid, [](int) { return true; });
}

/// Adds what was carried to the sums of a group, and empties it for the next sweep. size: numbers of `own` for each cluster.
template <int dim, class Real>
void join_carried(const Store<dim, Real>& store, SweepSums<Real> sums, int group, std::size_t size) {
  const Group& own = store.groups[group];
  for (std::uint32_t cluster = own.fluid; cluster < own.end; ++cluster) {
    Real *const to = sums.own + cluster * size, *const from = sums.carried + cluster * sums.carried_stride;
    for (std::size_t n = 0; n < size; ++n) to[n] += from[n], from[n] = Real(0);
  }
}

}  // namespace spindrift::sph
