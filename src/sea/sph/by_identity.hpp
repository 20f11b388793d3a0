// The state of a sea by identity, dealt out to ranks in runs of identities: what output and checkpoints hold, the same for any
// number of ranks. Rank r of n has the identities from N r/n on, whoever has their particles in its groups. Called by
// particle_sea.cpp; tested in tests/src/sea/sph/by_identity_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/sea_sph.hpp"

namespace spindrift::sph {

struct IdentityRange {
  std::size_t first, last;
};
inline IdentityRange identities_of(std::size_t particles, int rank, int ranks) {
  return {particles * std::size_t(rank) / std::size_t(ranks), particles * std::size_t(rank + 1) / std::size_t(ranks)};
}
inline int rank_of_identity(std::size_t id, std::size_t particles, int ranks) {
  int rank = int(id * std::size_t(ranks) / std::max<std::size_t>(particles, 1));
  while (id < identities_of(particles, rank, ranks).first) --rank;
  while (id >= identities_of(particles, rank, ranks).last) ++rank;
  return rank;
}

/// Values per particle: position, velocity, deviation, and those one step earlier where the step is Verlet's.
template <int dim>
std::size_t values_per_particle(const Parameters& p) {
  return p.step == StepChoice::verlet ? 3 * dim + 2 : 2 * dim + 1;
}

/// Those of the particle in a slot, in this order.
template <int dim, class Real>
void read_values(const Store<dim, Real>& store, std::size_t slot, std::span<double> values) {
  auto out = values.begin();
  for (int k = 0; k < dim; ++k) *out++ = store.x[k][slot];
  for (int k = 0; k < dim; ++k) *out++ = store.v[k][slot];
  *out++ = store.deviation[slot];
  if (out == values.end()) return;
  for (int k = 0; k < dim; ++k) *out++ = store.v_before[k][slot];
  *out++ = store.deviation_before[slot];
}

/// Deals the particles out whose slot is `wanted`: this rank is told of those of its run of identities, here(slot) of its own and
/// came(id, owner, values) of the others', in any order. Collective.
template <int dim, class Real, class Wanted, class Here, class Came>
void deal_out(const SeaSph<dim, Real>& sea, std::size_t particles, MPI_Comm comm, Wanted&& wanted, Here&& here, Came&& came) {
  const Store<dim, Real>& store = sea.store();
  const int ranks = runtime::ranks_in(comm);
  const IdentityRange mine = identities_of(particles, runtime::rank_in(comm), ranks);
  std::vector<double> values(values_per_particle<dim>(sea.parameters()));
  struct Head {
    std::uint32_t id;
    std::uint16_t owner;
  };
  std::vector<runtime::Packer> away(std::size_t(ranks), runtime::Packer{});
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    const std::uint32_t id = store.id[slot];
    if (id == no_particle || !wanted(slot)) continue;
    if (id >= mine.first && id < mine.last) {
      here(slot);
      continue;
    }
    runtime::Packer& to = away[std::size_t(rank_of_identity(id, particles, ranks))];
    read_values(store, slot, values);
    to.put_one(Head{id, store.owner[slot / cluster_size]});
    to.put(std::span<const double>(values));
  }
  if (ranks == 1) return;
  std::vector<runtime::Bytes> parcels;
  for (runtime::Packer& packer : away) parcels.push_back(packer.take());
  for (const runtime::Bytes& bytes : runtime::exchange(comm, parcels))
    for (runtime::Unpacker from(bytes); !from.done();) {
      const Head head = from.one<Head>();
      values = from.many<double>();
      came(head.id, head.owner, std::span<const double>(values));
    }
}

/// This rank's run of identities and their values; lost ones are where they left the sea.
struct ByIdentity {
  IdentityRange range{};
  std::vector<double> values;
};

/// Collective.
template <int dim, class Real>
ByIdentity by_identity(const SeaSph<dim, Real>& sea, std::size_t particles, MPI_Comm comm) {
  const Store<dim, Real>& store = sea.store();
  const std::size_t size = values_per_particle<dim>(sea.parameters());
  ByIdentity mine{identities_of(particles, runtime::rank_in(comm), runtime::ranks_in(comm)), {}};
  mine.values.resize((mine.range.last - mine.range.first) * size);
  const auto of = [&](std::uint32_t id) { return std::span(mine.values).subspan((id - mine.range.first) * size, size); };
  deal_out(
      sea, particles, comm, [](std::size_t) { return true; },
      [&](std::size_t slot) { read_values(store, slot, of(store.id[slot])); },
      [&](std::uint32_t id, std::uint16_t, std::span<const double> values) { std::ranges::copy(values, of(id).begin()); });
  for (const LostParticle<dim>& lost : store.lost) {
    if (lost.id < mine.range.first || lost.id >= mine.range.last) continue;
    double* out = of(lost.id).data();
    for (int k = 0; k < dim; ++k) out[k] = lost.position[k], out[dim + k] = lost.velocity[k];
  }
  return mine;
}

/// Of this rank's run of identities those that `wanted(owner, position)` takes, by rising identity, without room for the others:
/// `reserve(count)`, then `visit(id, owner, values)` for each. Collective.
template <int dim, class Real, class Wanted, class Reserve, class Visit>
void visit_by_identity(const SeaSph<dim, Real>& sea, std::size_t particles, MPI_Comm comm, Wanted&& wanted, Reserve&& reserve,
                       Visit&& visit) {
  const Store<dim, Real>& store = sea.store();
  const std::size_t size = values_per_particle<dim>(sea.parameters());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  // identity; slot, or behind these the place among those that came
  std::vector<std::uint16_t> owners;                           // of those that came
  std::vector<double> came;
  deal_out(
      sea, particles, comm,
      [&](std::size_t slot) {
        std::array<double, dim> x;
        for (int k = 0; k < dim; ++k) x[k] = store.x[k][slot];
        return wanted(store.owner[slot / cluster_size], x);
      },
      [&](std::size_t slot) { found.emplace_back(store.id[slot], std::uint32_t(slot)); },
      [&](std::uint32_t id, std::uint16_t owner, std::span<const double> values) {
        found.emplace_back(id, std::uint32_t(store.slots() + owners.size()));
        owners.push_back(owner), came.insert(came.end(), values.begin(), values.end());
      });
  std::sort(found.begin(), found.end());
  reserve(found.size());
  std::vector<double> own(size);
  for (const auto& [id, place] : found) {
    if (place < store.slots()) {
      read_values(store, place, own);
      visit(id, store.owner[place / cluster_size], std::span<const double>(own));
    } else {
      const std::size_t n = place - store.slots();
      visit(id, owners[n], std::span<const double>(came).subspan(n * size, size));
    }
  }
}

/// Puts a state back: `values` of this rank's run, `owner` as the sea was laid out. Particles go to their groups with the sort
/// that ends this; those outside the domain are lost again. Collective.
template <int dim, class Real>
void set_by_identity(SeaSph<dim, Real>& sea, const IdentityRange& range, std::span<const double> values,
                     std::span<const std::uint16_t> owner, double time, long steps) {
  Store<dim, Real>& store = sea.store();
  const bool verlet = sea.parameters().step == StepChoice::verlet;
  const std::size_t size = values_per_particle<dim>(sea.parameters()), count = range.last - range.first;
  if (values.size() != count * size || owner.size() != count)
    throw std::invalid_argument("sea: the state is of another sea (" + std::to_string(values.size()) + " values, not " +
                                std::to_string(count * size) + ")");
  std::vector<std::vector<std::uint32_t>> of_owner(std::size_t(store.owners));
  for (std::size_t n = 0; n < count; ++n) of_owner[owner[n]].push_back(std::uint32_t(n));
  std::vector<std::pair<std::uint32_t, std::uint16_t>> order;  // place in the run, owner; clusters are of one owner
  for (std::size_t o = 0; o < of_owner.size(); ++o) {
    for (const std::uint32_t n : of_owner[o]) order.emplace_back(n, std::uint16_t(o));
    while (order.size() % cluster_size != 0) order.emplace_back(no_particle, std::uint16_t(o));
  }
  const std::size_t slots = order.size();
  for (int k = 0; k < dim; ++k) {
    store.x[k].assign(slots, 0.0), store.v[k].assign(slots, 0.0);
    if (verlet) store.v_before[k].assign(slots, 0.0);
  }
  store.deviation.assign(slots, 0.0), store.id.assign(slots, no_particle), store.owner.resize(slots / cluster_size);
  if (verlet) store.deviation_before.assign(slots, 0.0);
  store.lost.clear();
  for (std::size_t slot = 0; slot < slots; ++slot) {
    store.owner[slot / cluster_size] = order[slot].second;
    if (order[slot].first == no_particle) continue;
    store.id[slot] = std::uint32_t(range.first) + order[slot].first;
    const double* in = values.data() + order[slot].first * size;
    for (int k = 0; k < dim; ++k) store.x[k][slot] = *in++;
    for (int k = 0; k < dim; ++k) store.v[k][slot] = *in++;
    store.deviation[slot] = *in++;
    if (!verlet) continue;
    for (int k = 0; k < dim; ++k) store.v_before[k][slot] = *in++;
    store.deviation_before[slot] = *in++;
  }
  sea.resume(time, steps);
  sea.sort();
}

}  // namespace spindrift::sph
