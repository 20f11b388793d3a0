// Modified dynamic boundaries as a sweep: every wall particle with a ghost node takes its density, and for no-slip or free-slip
// its velocity, from the water round the node (kernels/sph/boundary_modified.hpp). Runs on packed state before the pair sweeps;
// a group writes its own walls only and reads water of the columns its nodes reach, so all groups may run at once.
// Called by tasks.cpp; tested in tests/src/sea/sph/boundary_test.cpp and tests/verification/sea_sph/viscous_flow_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernels/sph/boundary_extrapolated.hpp"
#include "kernels/sph/boundary_modified.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/seeds.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

/// Where the ghost nodes are: from each wall particle, by identity; zero where there is none [m]. Turns with its body.
template <int dim>
class Ghosts {
 public:
  Ghosts() = default;
  explicit Ghosts(const SeedStream<dim>& seeds) {
    const std::array<double, dim> none{};
    seeds.for_each(
        [&](std::size_t id, const Seed<dim>& seed) {
          if (seed.owner == 0 || seed.ghost == none) return;
          if (offset_.empty()) first_ = std::uint32_t(id);
          offset_.resize(id - first_ + 1);
          offset_.back() = seed.ghost;
        },
        [](const SeedPart<dim>& part) { return part.has_ghosts; });
    built_ = offset_;
  }
  bool empty() const { return offset_.empty(); }
  std::array<double, dim> offset(std::uint32_t id) const {
    return id >= first_ && id - first_ < offset_.size() ? offset_[id - first_] : std::array<double, dim>{};
  }
  /// Turns the offsets of a body's particles from how they were built; `turn` from the attitude then to the attitude now.
  void turn(const Solid& solid, const Eigen::Quaterniond& turn) {
    for (std::uint32_t id = solid.first_id; id < solid.first_id + solid.local.size(); ++id)
      if (id >= first_ && id - first_ < offset_.size())
        offset_[id - first_] = from_earth<dim>(turn * to_earth<dim>(built_[id - first_]));
  }

 private:
  std::uint32_t first_ = 0;
  std::vector<std::array<double, dim>> offset_, built_;
};

/// Offset to the ghost node of a wall particle beside the box (low, high) of water: its mirror image in the faces it lies beyond.
template <int dim>
std::array<double, dim> mirror_in_box(const std::array<double, dim>& x, const std::array<double, dim>& low,
                                      const std::array<double, dim>& high) {
  std::array<double, dim> offset{};
  for (int k = 0; k < dim; ++k) {
    if (x[k] < low[k]) offset[k] = 2.0 * (low[k] - x[k]);
    if (x[k] > high[k]) offset[k] = 2.0 * (high[k] - x[k]);
  }
  return offset;
}

/// Sums of one ghost node (in frame of the candidates' shifts) over the water chosen.
template <class Kernel, int dim, class Real>
Vec<double, BoundaryModified<dim>::planes> sums_at_node(const Store<dim, Real>& store, const Candidates<dim, Real>& water,
                                                        int chosen, const Vec<Real, dim>& node, const Kernel& kernel, double mass,
                                                        double rho0) {
  using V = LineWide<Real>;
  constexpr int planes = BoundaryModified<dim>::planes;
  const auto near = water.view();
  Vec<V, planes> sums{};
  for (int n = 0; n < planes; ++n) sums[n] = V(0);
  for (int n = 0; n < chosen; ++n) {
    const std::uint32_t candidate = near.chosen[n];
    const Real* state = store.pack_of(near.cluster[candidate]);
    for (int lane = 0; lane < cluster_size; lane += V::size) {
      const PairState<V, dim> j = load_state<dim, V>(state, lane);
      Vec<V, dim> x;
      for (int k = 0; k < dim; ++k) x[k] = V(node[k] + near.shift[k][candidate]) - j.x[k];
      const V r2 = max(dot(x, x), V(1e-30));
      Vec<V, dim + 1> fields;
      fields[0] = j.deviation;
      for (int k = 0; k < dim; ++k) fields[k + 1] = j.v[k];
      const V volume = V(Real(mass)) / (V(Real(rho0)) + j.deviation);
      sums += BoundaryModified<dim>::pair_terms(x, kernel.value(r2), kernel.slope(r2), volume, fields, V(Real(kernel.h())),
                                                V(Real(1.0 / kernel.h())));
    }
  }
  Vec<double, planes> result;
  for (int n = 0; n < planes; ++n) result[n] = double(sum(sums[n]));
  return result;
}

/// Sets the walls of one group. reach: support plus the rounding of boxes; old: how far particles may have gone since they were
/// sorted into columns [m].
template <class Kernel, int dim, class Real>
void apply_boundary(Store<dim, Real>& store, const Columns<dim>& columns, const Ghosts<dim>& ghosts, const Parameters& p,
                    int group, float reach, double old, const Kernel& kernel, Candidates<dim, Real>& water) {
  const std::array<double, dim> none{};
  for (std::uint32_t cluster = store.groups[group].solid; cluster < store.groups[group].end; ++cluster) {
    Real* state = store.pack_of(cluster);
    std::array<std::array<double, dim>, cluster_size> offset{};
    std::array<double, dim> low, high, anchor;
    low.fill(1e300), high.fill(-1e300);
    const std::size_t first = std::size_t(cluster) * cluster_size;
    bool any = false;
    for (int lane = 0; lane < cluster_size && store.id[first + lane] != no_particle; ++lane) {
      offset[lane] = ghosts.offset(store.id[first + lane]);
      if (offset[lane] == none) continue;
      any = true;
      for (int k = 0; k < dim; ++k) {
        const double at = store.anchor[k][cluster] + double(state[k * cluster_size + lane]) + offset[lane][k];
        low[k] = std::min(low[k], at), high[k] = std::max(high[k], at);
      }
    }
    if (!any) continue;
    std::array<float, dim> box_low, box_high;
    for (int k = 0; k < dim; ++k) {
      anchor[k] = store.anchor[k][cluster];
      box_low[k] = float(low[k] - store.corner[k]), box_high[k] = float(high[k] - store.corner[k]);
      low[k] -= double(reach) + old, high[k] += double(reach) + old;
    }
    water.clear();
    columns.for_overlapping(low, high, [&](const Neighbour<dim>& near) {
      const Group& other = store.groups[near.group];
      water.add(store, box_low, box_high, anchor, other.fluid, other.solid, near.shift, reach);
    });
    for (int lane = 0; lane < cluster_size && store.id[first + lane] != no_particle; ++lane) {
      if (offset[lane] == none) continue;
      Vec<Real, dim> node;
      Vec<double, dim> back, wall, normal;
      std::array<float, dim> point;
      for (int k = 0; k < dim; ++k) {
        node[k] = state[k * cluster_size + lane] + Real(offset[lane][k]);
        point[k] = store.frame(k, cluster) + float(node[k]);
        back[k] = -offset[lane][k], wall[k] = store.v[k][first + lane];
      }
      const int chosen = water.size() > 0 ? water.choose(point, reach) : 0;
      const auto seen =
          BoundaryModified<dim>::seen(sums_at_node(store, water, chosen, node, kernel, p.mass(dim), p.eos.rho0), back, p.h());
      const double deviation = seen.deviation, rho = p.eos.rho0 + deviation;
      store.deviation[first + lane] = deviation;
      state[2 * dim * cluster_size + lane] = Real(deviation);
      state[(2 * dim + 1) * cluster_size + lane] = Real(p.eos.pressure(deviation) / (rho * rho));
      Vec<double, dim> velocity = wall;
      if (seen.water && p.wall != WallChoice::still) {
        const double length = std::sqrt(dot(back, back));
        for (int k = 0; k < dim; ++k) normal[k] = -back[k] / length;
        velocity = BoundaryModified<dim>::velocity(seen.velocity, wall, normal, p.wall == WallChoice::free_slip);
      }
      for (int k = 0; k < dim; ++k) state[(dim + k) * cluster_size + lane] = Real(velocity[k]);
    }
  }
}

/// Particles of a cluster of water that may be within reach of a box of walls (in the frame of `x`), by lane; returns how many.
template <class V, int dim, class Real>
SPINDRIFT_INLINE int lanes_near_box(const Real* water, const Vec<Real, dim>& low, const Vec<Real, dim>& high, Real reach2,
                                    std::array<int, cluster_size>& near) {
  std::array<Real, cluster_size> gap2;
  for (int lane = 0; lane < cluster_size; lane += V::size) {
    V total(0);
    for (int k = 0; k < dim; ++k) {
      const V x = V::load(water + k * cluster_size + lane), gap = max(max(V(low[k]) - x, x - V(high[k])), V(0));
      total += gap * gap;
    }
    total.store(gap2.data() + lane);
  }
  int count = 0;
  for (int lane = 0; lane < cluster_size; ++lane) {
    near[std::size_t(count)] = lane;
    count += gap2[std::size_t(lane)] < reach2;
  }
  return count;
}

/// Extrapolated walls of one group: sixteen walls side by side against the water round them, particle by particle.
template <bool sticks, class Kernel, int dim, class Real>
void extrapolate_to_walls(Store<dim, Real>& store, const Columns<dim>& columns, const Parameters& p, int group, float reach,
                          double old, const Kernel& kernel, Candidates<dim, Real>& water) {
  using V = NativeWide<Real>;
  using Boundary = BoundaryExtrapolated<dim, sticks>;
  constexpr int parts = cluster_size / V::size;
  const Real least = Real(1e-6) * kernel.value(Real(1e-12)), rho0 = Real(p.eos.rho0);
  Vec<V, dim> body_force;
  for (int k = 0; k < dim; ++k) body_force[k] = V(Real(k == dim - 1 ? -p.gravity : k == 0 ? p.drive : 0.0));
  for (std::uint32_t cluster = store.groups[group].solid; cluster < store.groups[group].end; ++cluster) {
    Real* const state = store.pack_of(cluster);
    std::array<double, dim> low, high;
    for (int k = 0; k < dim; ++k) {
      low[k] = store.corner[k] + double(store.low[k][cluster]) - double(reach) - old;
      high[k] = store.corner[k] + double(store.high[k][cluster]) + double(reach) + old;
    }
    water.clear();
    columns.for_overlapping(low, high, [&](const Neighbour<dim>& near) {
      const Group& other = store.groups[near.group];
      if (other.solid > other.fluid) water.add(store, cluster, other.fluid, other.solid, near.shift, reach);
    });
    Vec<V, Boundary::planes> sums[parts] = {};
    if (water.size() > 0) {
      Vec<V, dim> x[parts];
      Vec<Real, dim> box_low, box_high;
      for (int k = 0; k < dim; ++k) {
        for (int part = 0; part < parts; ++part) x[part][k] = V::load(state + k * cluster_size + part * V::size);
        box_low[k] = Real(store.low[k][cluster] - store.frame(k, cluster));
        box_high[k] = Real(store.high[k][cluster] - store.frame(k, cluster));
      }
      const auto near = water.all();
      std::array<int, cluster_size> lanes;
      for (int n = 0; n < water.size(); ++n) {
        const Real* const other = store.pack_of(near.cluster[n]);
        Vec<Real, dim> shift, from, to;
        for (int k = 0; k < dim; ++k)
          shift[k] = near.shift[k][n], from[k] = box_low[k] + shift[k], to[k] = box_high[k] + shift[k];
        const int count = lanes_near_box<V, dim>(other, from, to, Real(reach) * Real(reach), lanes);
        for (int l = 0; l < count; ++l) {
          const int lane = lanes[std::size_t(l)];
          const PairState<V, dim> j = spread_state<dim, V>(other, lane);
          const V rho = V(rho0) + j.deviation, pressure = j.p_rho2 * (rho * rho);
          for (int part = 0; part < parts; ++part) {
            Vec<V, dim> from_j;
            for (int k = 0; k < dim; ++k) from_j[k] = x[part][k] + (V(shift[k]) - j.x[k]);
            Boundary::template add<V>(sums[part], from_j, kernel.value(max(dot(from_j, from_j), V(Real(1e-30)))), pressure, rho,
                                      j.v);
          }
        }
      }
    }
    const std::size_t first = std::size_t(cluster) * cluster_size;
    std::array<Real, cluster_size> deviations;
    for (int part = 0; part < parts; ++part) {
      Real* const planes = state + part * V::size;
      const V pressure = Boundary::pressure(sums[part], body_force, V(least)), deviation = p.eos.deviation_by_newton(pressure);
      const V rho = V(rho0) + deviation;
      deviation.store(planes + 2 * dim * cluster_size);
      (pressure * reciprocal(rho * rho)).store(planes + (2 * dim + 1) * cluster_size);
      deviation.store(deviations.data() + part * V::size);
      if constexpr (sticks)
        for (int k = 0; k < dim; ++k) {
          Real* const v = planes + (dim + k) * cluster_size;
          Boundary::velocity(sums[part], k, V::load(v), V(least)).store(v);
        }
    }
    for (int lane = 0; lane < cluster_size; ++lane) store.deviation[first + lane] = double(deviations[std::size_t(lane)]);
  }
}

}  // namespace spindrift::sph
