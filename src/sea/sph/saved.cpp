// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/saved.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace spindrift::sph {
namespace {

/// The arrays of the state, in the order in which they are saved.
template <class StoreType, int dim, class Visit>
void for_arrays(StoreType& store, bool with_before, Visit&& visit) {
  for (int k = 0; k < dim; ++k) visit(store.x[k]);
  for (int k = 0; k < dim; ++k) visit(store.v[k]);
  visit(store.deviation);
  if (!with_before) return;
  for (int k = 0; k < dim; ++k) visit(store.v_before[k]);
  visit(store.deviation_before);
}

template <int dim>
int arrays(const Parameters& p) {
  return p.step == StepChoice::verlet ? 3 * dim + 2 : 2 * dim + 1;
}

}  // namespace

template <int dim>
void Saved<dim>::put(runtime::Packer& packer) const {
  packer.put_one(plan);
  packer.put_one(energy);
  packer.put(std::span(motions));
  packer.put(std::span(groups));
  packer.put(std::span(owner));
  packer.put(std::span(anchor));
  packer.put(std::span(id));
  packer.put(std::span(values));
  packer.put(std::span(lost));
}

template <int dim>
Saved<dim> Saved<dim>::take(runtime::Unpacker& from) {
  Saved s;
  s.plan = from.one<std::array<double, numbers>>();
  s.energy = from.one<EnergyFlow>();
  s.motions = from.many<double>();
  s.groups = from.many<std::int32_t>();
  s.owner = from.many<std::uint16_t>();
  s.anchor = from.many<double>();
  s.id = from.many<std::uint32_t>();
  s.values = from.many<double>();
  s.lost = from.many<LostParticle<dim>>();
  return s;
}

template <int dim, class Real>
Saved<dim> save_groups(const SeaState<dim, Real>& sea, std::span<const int> groups) {
  const Store<dim, Real>& store = sea.store;
  const Plan& plan = sea.plan;
  Saved<dim> s;
  s.plan = {plan.time,
            double(plan.steps),
            plan.left,
            plan.dt,
            double(plan.planned),
            plan.speed,
            plan.acceleration,
            plan.limit,
            plan.drift,
            plan.solid_drift,
            plan.travel,
            plan.solid_travel,
            plan.shifted,
            plan.solid_path,
            double(sea.work.steps),
            double(sea.work.evaluations),
            double(sea.work.sorts)};
  s.energy = sea.energy;
  for (const Solid& solid : sea.solids) {
    const Motion& m = solid.motion;
    for (int k = 0; k < 3; ++k) s.motions.push_back(m.position[k]);
    for (int k = 0; k < 4; ++k) s.motions.push_back(m.attitude.coeffs()[k]);
    for (int k = 0; k < 3; ++k) s.motions.push_back(m.velocity[k]);
    for (int k = 0; k < 3; ++k) s.motions.push_back(m.omega[k]);
  }
  s.lost = store.lost;
  std::size_t clusters = 0;
  for (const int g : groups) clusters += store.groups[std::size_t(g)].end - store.groups[std::size_t(g)].fluid;
  s.owner.reserve(clusters), s.anchor.reserve(clusters * dim), s.id.reserve(clusters * cluster_size);
  s.values.reserve(clusters * cluster_size * std::size_t(arrays<dim>(sea.p)));
  const auto append = [](auto& to, const auto& from, std::size_t first, std::size_t last) {
    to.insert(to.end(), from.begin() + std::ptrdiff_t(first), from.begin() + std::ptrdiff_t(last));
  };
  for (const int g : groups) {
    const Group& group = store.groups[std::size_t(g)];
    s.groups.insert(s.groups.end(), {g, std::int32_t(group.solid - group.fluid), std::int32_t(group.end - group.solid)});
    append(s.owner, store.owner, group.fluid, group.end);
    for (std::uint32_t cluster = group.fluid; cluster < group.end; ++cluster)
      for (int k = 0; k < dim; ++k) s.anchor.push_back(store.anchor[k][cluster]);
    const std::size_t first = std::size_t(group.fluid) * cluster_size, last = std::size_t(group.end) * cluster_size;
    append(s.id, store.id, first, last);
    for_arrays<const Store<dim, Real>, dim>(store, sea.p.step == StepChoice::verlet,
                                            [&](const auto& array) { append(s.values, array, first, last); });
  }
  return s;
}

template <int dim, class Real>
void restore_groups(SeaState<dim, Real>& sea, std::span<const Saved<dim>> pieces) {
  // Where each group is: piece, its place among that piece's clusters.
  struct Place {
    const Saved<dim>* piece = nullptr;
    std::size_t cluster = 0;
    std::uint32_t water = 0, solid = 0;
  };
  std::vector<Place> places(std::size_t(sea.columns.groups()), Place{});
  for (const Saved<dim>& piece : pieces) {
    std::size_t cluster = 0;
    for (std::size_t n = 0; n < piece.groups.size(); n += 3) {
      Place& place = places.at(std::size_t(piece.groups[n]));
      if (place.piece != nullptr)
        throw std::invalid_argument("sea: group " + std::to_string(piece.groups[n]) + " is given twice");
      place = {&piece, cluster, std::uint32_t(piece.groups[n + 1]), std::uint32_t(piece.groups[n + 2])};
      cluster += place.water + place.solid;
    }
    const std::size_t slots = cluster * cluster_size;
    if (piece.owner.size() != cluster || piece.anchor.size() != cluster * dim || piece.id.size() != slots ||
        piece.values.size() != slots * std::size_t(arrays<dim>(sea.p)))
      throw std::invalid_argument("sea: a saved state does not hold what its groups say, or was made with another step");
  }
  Store<dim, Real>& store = sea.store;
  store.groups.assign(std::size_t(sea.columns.groups_and_images()), Group{});
  std::size_t clusters = 0;
  store.longest = 0;
  for (const int g : sea.subdomain.own) {
    const Place& place = places[std::size_t(g)];
    if (place.piece == nullptr) throw std::invalid_argument("sea: a saved state lacks group " + std::to_string(g));
    Group& group = store.groups[std::size_t(g)];
    group.fluid = std::uint32_t(clusters), group.solid = group.fluid + place.water, group.end = group.solid + place.solid;
    clusters = group.end;
    store.longest = std::max<std::size_t>(store.longest, place.water + place.solid);
  }
  store.owner.resize(clusters), store.id.resize(clusters * cluster_size);
  for (int k = 0; k < dim; ++k) store.anchor[k].resize(clusters);
  for_arrays<Store<dim, Real>, dim>(store, sea.p.step == StepChoice::verlet,
                                    [&](auto& array) { array.resize(clusters * cluster_size); });
  for (const int g : sea.subdomain.own) {
    const Place& place = places[std::size_t(g)];
    const Saved<dim>& piece = *place.piece;
    const std::size_t to = store.groups[std::size_t(g)].fluid, count = place.water + place.solid;
    std::copy_n(piece.owner.begin() + std::ptrdiff_t(place.cluster), count, store.owner.begin() + std::ptrdiff_t(to));
    for (std::size_t n = 0; n < count; ++n)
      for (int k = 0; k < dim; ++k) store.anchor[k][to + n] = piece.anchor[(place.cluster + n) * dim + std::size_t(k)];
    const std::size_t from = place.cluster * cluster_size, slots = count * cluster_size;
    std::copy_n(piece.id.begin() + std::ptrdiff_t(from), slots, store.id.begin() + std::ptrdiff_t(to * cluster_size));
    std::size_t value = from * std::size_t(arrays<dim>(sea.p));
    for_arrays<Store<dim, Real>, dim>(store, sea.p.step == StepChoice::verlet, [&](auto& array) {
      std::copy_n(piece.values.begin() + std::ptrdiff_t(value), slots, array.begin() + std::ptrdiff_t(to * cluster_size));
      value += slots;
    });
  }
  // A window that failed may have ended between a sweep and the task that joins what it carried.
  std::fill(store.carried.begin(), store.carried.end(), Real(0));
  const Saved<dim>& s = pieces.front();
  store.lost = s.lost;
  Plan& plan = sea.plan;
  const auto& n = s.plan;
  plan = Plan{};
  plan.time = n[0], plan.steps = long(n[1]), plan.left = n[2], plan.dt = plan.last_dt = n[3], plan.planned = int(n[4]),
  plan.speed = n[5];
  plan.acceleration = n[6], plan.limit = n[7], plan.drift = n[8], plan.solid_drift = n[9], plan.travel = n[10];
  plan.solid_travel = n[11], plan.solid_path = n[13];
  for (const Saved<dim>& piece : pieces)
    plan.shifted = std::max(plan.shifted, piece.plan[12]);  // each rank's own since the last check of the limits
  sea.energy = s.energy;
  sea.work = {long(n[14]), long(n[15]), long(n[16])};
  if (s.motions.size() != 13 * sea.solids.size())
    throw std::invalid_argument("sea: a saved state has " + std::to_string(s.motions.size() / 13) + " bodies, the scene " +
                                std::to_string(sea.solids.size()));
  for (std::size_t b = 0; b < sea.solids.size(); ++b) {
    const double* from = &s.motions[13 * b];
    Motion& m = sea.solids[b].motion;
    for (int k = 0; k < 3; ++k) m.position[k] = from[k], m.velocity[k] = from[7 + k], m.omega[k] = from[10 + k];
    for (int k = 0; k < 4; ++k) m.attitude.coeffs()[k] = from[3 + k];
    sea.follow(sea.solids[b]);
  }
}

#define SPINDRIFT_SPH_INSTANTIATE(dim, Real)                                                    \
  template Saved<dim> save_groups<dim, Real>(const SeaState<dim, Real>&, std::span<const int>); \
  template void restore_groups<dim, Real>(SeaState<dim, Real>&, std::span<const Saved<dim>>);
SPINDRIFT_SPH_INSTANTIATE(2, float)
SPINDRIFT_SPH_INSTANTIATE(2, double)
SPINDRIFT_SPH_INSTANTIATE(3, float)
SPINDRIFT_SPH_INSTANTIATE(3, double)
#undef SPINDRIFT_SPH_INSTANTIATE
template struct Saved<2>;
template struct Saved<3>;

}  // namespace spindrift::sph
