// Groups by counting, clusters by halving (see ordering.hpp). Cost at the reference scene: docs/developer/notes/sea.md.
// Called through ordering.hpp; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/ordering.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/mpi/exchange.hpp"

namespace spindrift::sph {
namespace {

constexpr std::uint32_t lost_key = no_particle - 1;

template <class T>
void reorder_by(Array<T>& values, const Array<std::uint32_t>& source, T empty) {
  Array<T> sorted(source.size());
  for (std::size_t slot = 0; slot < source.size(); ++slot)
    sorted[slot] = source[slot] == no_particle ? empty : values[source[slot]];
  values.swap(sorted);
}

}  // namespace

/// Halves until clusters are left; sizes are multiples of cluster_size but for the last.
template <int dim, class Real>
void Sorting<dim, Real>::halve(std::span<Item> items) {
  if (items.size() <= cluster_size) {
    std::sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return;
  }
  std::array<double, dim> low = items[0].x, high = items[0].x;
  for (const Item& item : items)
    for (int k = 0; k < dim; ++k) low[k] = std::min(low[k], item.x[k]), high[k] = std::max(high[k], item.x[k]);
  int axis = 0;
  for (int k = 1; k < dim; ++k)
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  const std::size_t clusters = (items.size() + cluster_size - 1) / cluster_size;
  const std::size_t left = (clusters / 2) * cluster_size;
  std::nth_element(items.begin(), items.begin() + left, items.end(), [axis](const auto& a, const auto& b) {
    return a.x[axis] < b.x[axis] || (a.x[axis] == b.x[axis] && a.id < b.id);
  });
  halve(items.first(left));
  halve(items.subspan(left));
}

/// The arrays that move with a particle, in a fixed order.
template <int dim, class Real>
std::vector<Array<double>*> Sorting<dim, Real>::state() {
  std::vector<Array<double>*> arrays;
  for (int k = 0; k < dim; ++k) arrays.push_back(&store_.x[k]);
  for (int k = 0; k < dim; ++k) arrays.push_back(&store_.v[k]);
  arrays.push_back(&store_.deviation);
  if (arrays_ > 2 * dim + 2) {
    for (int k = 0; k < dim; ++k) arrays.push_back(&store_.v_before[k]);
    arrays.push_back(&store_.deviation_before);
  }
  return arrays;
}

template <int dim, class Real>
void Sorting<dim, Real>::begin() {
  store_.pack = {}, store_.sums = {}, store_.stress = {}, store_.extra_sums = {};
  store_.id.resize(store_.slots());  // the halo's go
  key_.assign(store_.slots(), no_particle);
}

template <int dim, class Real>
void Sorting<dim, Real>::classify(int part) {
  const Domain<dim>& domain = columns_.domain();
  const auto [first, last] = range(store_.slots(), part);
  for (std::size_t slot = first; slot < last; ++slot) {
    if (store_.id[slot] == no_particle) continue;
    std::array<double, dim> x;
    for (int k = 0; k < dim; ++k) {
      if (domain.periodic[k]) {
        const double length = domain.high[k] - domain.low[k];
        store_.x[k][slot] -= length * std::floor((store_.x[k][slot] - domain.low[k]) / length);
      }
      if (domain.mirrored && k == 1 && store_.x[k][slot] < domain.low[k]) {  // its image is in the tank now
        store_.x[k][slot] = domain.image(store_.x[k][slot]), store_.v[k][slot] = -store_.v[k][slot];
        if (!store_.v_before[k].empty()) store_.v_before[k][slot] = -store_.v_before[k][slot];
      }
      x[k] = store_.x[k][slot];
    }
    key_[slot] = domain.contains(x) && !(store_.owner[slot / cluster_size] == 0 && domain.passed_edge(x))
                     ? std::uint32_t(columns_.group(x) * store_.owners + store_.owner[slot / cluster_size])
                     : lost_key;
  }
}

template <int dim, class Real>
void Sorting<dim, Real>::migrate(MPI_Comm comm) {
  const auto arrays = state();
  std::vector<runtime::Packer> away(std::size_t(runtime::ranks_in(comm)));
  runtime::Packer lost;
  for (std::size_t slot = 0; slot < key_.size(); ++slot) {
    if (key_[slot] == no_particle) continue;
    if (key_[slot] == lost_key) {
      LostParticle<dim> particle{store_.id[slot], {}, {}};
      for (int k = 0; k < dim; ++k) particle.position[k] = store_.x[k][slot], particle.velocity[k] = store_.v[k][slot];
      lost.put_one(particle);
      key_[slot] = no_particle;
      continue;
    }
    const int group = int(key_[slot]) / store_.owners;
    if (subdomain_.owns(group)) continue;
    runtime::Packer& to = away[std::size_t(subdomain_.rank_of_group[std::size_t(group)])];
    to.put_one(key_[slot]);
    to.put_one(store_.id[slot]);
    for (const Array<double>* array : arrays) to.put_one((*array)[slot]);
    key_[slot] = no_particle;
  }
  std::vector<runtime::Bytes> parcels;
  for (auto& packer : away) parcels.push_back(packer.take());
  for (const runtime::Bytes& bytes : runtime::exchange(comm, parcels)) {
    for (runtime::Unpacker from(bytes); !from.done();) {
      key_.push_back(from.one<std::uint32_t>());
      store_.id.push_back(from.one<std::uint32_t>());
      for (Array<double>* array : arrays) array->push_back(from.one<double>());
    }
  }
  const std::size_t known = store_.lost.size();
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, lost.take()))
    for (runtime::Unpacker from(bytes); !from.done();) store_.lost.push_back(from.one<LostParticle<dim>>());
  std::sort(store_.lost.begin() + std::ptrdiff_t(known), store_.lost.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });

  // Count, then put each particle into its bin.
  std::vector<std::uint32_t> place(std::size_t(columns_.groups()), 0);  // of a group among the own ones
  for (std::size_t n = 0; n < subdomain_.own.size(); ++n) place[std::size_t(subdomain_.own[n])] = std::uint32_t(n);
  const auto bin_of = [&](std::uint32_t key) {
    return bin(place[key / std::uint32_t(store_.owners)], int(key % std::uint32_t(store_.owners)));
  };
  first_.assign(subdomain_.own.size() * std::size_t(store_.owners) + 1, 0);
  for (const std::uint32_t key : key_)
    if (key != no_particle) ++first_[bin_of(key) + 1];
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  items_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t slot = 0; slot < key_.size(); ++slot) {
    if (key_[slot] == no_particle) continue;
    Item& item = items_[next[bin_of(key_[slot])]++];
    for (int k = 0; k < dim; ++k) item.x[k] = store_.x[k][slot];
    item.id = store_.id[slot], item.slot = std::uint32_t(slot);
  }
  key_ = {};
}

template <int dim, class Real>
void Sorting<dim, Real>::halve(int part) {
  // Bins differ much in size: each part takes those whose first particle lies in its share.
  const auto [low, high] = range(items_.size(), part);
  for (std::size_t n = 0; n + 1 < first_.size(); ++n)
    if (first_[n] >= low && first_[n] < high && first_[n + 1] > first_[n])
      halve(std::span(items_).subspan(first_[n], first_[n + 1] - first_[n]));
}

template <int dim, class Real>
void Sorting<dim, Real>::lay_out() {
  store_.groups.assign(std::size_t(columns_.groups_and_images()), Group{});
  store_.owner.clear();
  store_.longest = 0;
  for (std::size_t own = 0; own < subdomain_.own.size(); ++own) {
    Group& group = store_.groups[std::size_t(subdomain_.own[own])];
    group.fluid = std::uint32_t(store_.owner.size());
    for (int owner = 0; owner < store_.owners; ++owner) {
      if (owner == 1) group.solid = std::uint32_t(store_.owner.size());
      store_.owner.insert(store_.owner.end(), clusters_of(bin(own, owner)), std::uint16_t(owner));
    }
    group.end = std::uint32_t(store_.owner.size());
    if (store_.owners == 1) group.solid = group.end;
    store_.longest = std::max<std::size_t>(store_.longest, group.end - group.fluid);
  }
  source_.assign(store_.owner.size() * cluster_size, no_particle);
  std::size_t slot = 0;
  for (std::size_t n = 0; n + 1 < first_.size(); ++n) {
    for (std::size_t item = first_[n]; item < first_[n + 1]; ++item) source_[slot + item - first_[n]] = items_[item].slot;
    slot += clusters_of(n) * cluster_size;
  }
  items_ = {};
}

template <int dim, class Real>
void Sorting<dim, Real>::reorder(int array) {
  if (array == arrays_ - 1) return reorder_by(store_.id, source_, no_particle);
  // Not through state(): while another task swaps its array, only this one's may be looked at.
  if (array < dim) return reorder_by(store_.x[array], source_, 0.0);
  if (array < 2 * dim) return reorder_by(store_.v[array - dim], source_, 0.0);
  if (array == 2 * dim) return reorder_by(store_.deviation, source_, 0.0);
  if (array < 3 * dim + 1) return reorder_by(store_.v_before[array - 2 * dim - 1], source_, 0.0);
  reorder_by(store_.deviation_before, source_, 0.0);
}

template <int dim, class Real>
void Sorting<dim, Real>::anchor(int part) {
  const auto [first, last] = range(store_.clusters(), part);
  for (int k = 0; k < dim; ++k) {
    for (std::size_t cluster = first; cluster < last; ++cluster) {
      double low = 1e300, high = -1e300;
      for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size; ++slot)
        if (store_.id[slot] != no_particle) low = std::min(low, store_.x[k][slot]), high = std::max(high, store_.x[k][slot]);
      store_.anchor[k][cluster] = anchor_step_ * std::round(0.5 * (low + high) / anchor_step_);
    }
  }
}

template <int dim, class Real>
void Sorting<dim, Real>::exchange_halo(MPI_Comm comm) {
  exchange_halo_structure(store_, columns_, subdomain_, comm);
  source_ = {};
}

template <int dim, class Real>
void Sorting<dim, Real>::all(MPI_Comm comm) {
  begin();
  for (int part = 0; part < parts; ++part) classify(part);
  migrate(comm);
  for (int part = 0; part < parts; ++part) halve(part);
  lay_out();
  const int count = arrays();
  for (int array = 0; array < count; ++array) reorder(array);
  make_anchors();
  for (int part = 0; part < parts; ++part) anchor(part);
  exchange_halo(comm);
}

template <int dim, class Real>
void Sorting<dim, Real>::make_anchors() {
  for (int k = 0; k < dim; ++k) store_.anchor[k].resize(store_.clusters());
}

/// The structure of the images, behind that of the halo.
template <int dim, class Real>
void append_images(Store<dim, Real>& store, const Columns<dim>& columns, const Subdomain& subdomain) {
  for (const int image : subdomain.images) {
    const Group of = store.groups[std::size_t(columns.source(image))];
    Group& group = store.groups[std::size_t(image)];
    group.fluid = std::uint32_t(store.owner.size());
    group.solid = group.fluid + (of.solid - of.fluid), group.end = group.fluid + (of.end - of.fluid);
    for (std::uint32_t cluster = of.fluid; cluster < of.end; ++cluster) {
      store.owner.push_back(store.owner[cluster]);
      for (std::uint32_t lane = 0; lane < cluster_size; ++lane) store.id.push_back(store.id[cluster * cluster_size + lane]);
      for (int k = 0; k < dim; ++k)
        store.anchor[k].push_back(k == 1 ? columns.domain().image(store.anchor[k][cluster]) : store.anchor[k][cluster]);
    }
  }
}

template <int dim, class Real>
void exchange_halo_structure(Store<dim, Real>& store, const Columns<dim>& columns, const Subdomain& subdomain, MPI_Comm comm) {
  store.corner = columns.domain().low;
  std::vector<runtime::Bytes> parcels(std::size_t(runtime::ranks_in(comm)));
  for (const Subdomain::Border& border : subdomain.borders) {
    runtime::Packer packer;
    for (const int g : border.sent) {
      const Group& group = store.groups[std::size_t(g)];
      const std::size_t count = group.end - group.fluid;
      packer.put_one(group.solid - group.fluid);
      packer.put(std::span<const std::uint16_t>(store.owner.data() + group.fluid, count));
      packer.put(std::span<const std::uint32_t>(store.id.data() + std::size_t(group.fluid) * cluster_size, count * cluster_size));
      for (int k = 0; k < dim; ++k) packer.put(std::span<const double>(store.anchor[k].data() + group.fluid, count));
    }
    parcels[std::size_t(border.rank)] = packer.take();
  }
  if (runtime::ranks_in(comm) > 1) {
    const auto came = runtime::exchange(comm, parcels);
    const auto append = [](auto& to, const auto& values) { to.insert(to.end(), values.begin(), values.end()); };
    for (const Subdomain::Border& border : subdomain.borders) {
      runtime::Unpacker from(came[std::size_t(border.rank)]);
      for (const int g : border.received) {
        Group& group = store.groups[std::size_t(g)];
        group.fluid = std::uint32_t(store.owner.size());
        group.solid = group.fluid + from.one<std::uint32_t>();
        append(store.owner, from.many<std::uint16_t>());
        append(store.id, from.many<std::uint32_t>());
        for (int k = 0; k < dim; ++k) append(store.anchor[k], from.many<double>());
        group.end = std::uint32_t(store.owner.size());
        store.longest = std::max<std::size_t>(store.longest, group.end - group.fluid);
      }
    }
  }
  append_images(store, columns, subdomain);
  store.pack.resize(store.all_clusters() * pack_planes<dim> * cluster_size);
  store.sums.resize(store.all_clusters() * sum_planes<dim> * cluster_size);
  store.stress.resize(store.all_clusters() * std::size_t(store.stress_planes) * cluster_size);
  for (std::size_t n = 0; n < store.extra_sums.size(); ++n)
    store.extra_sums[n].resize(store.all_clusters() * std::size_t(store.extra_planes[n]) * cluster_size);
  for (int k = 0; k < dim; ++k) {
    // The search reads boxes a register at a time: one register more than there are clusters.
    store.low[k].resize(store.all_clusters() + cluster_size);
    store.high[k].resize(store.all_clusters() + cluster_size);
  }
}

template <int dim, class Real>
void fill(Store<dim, Real>& store, const SeedStream<dim>& seeds, const Columns<dim>& columns, const Subdomain& subdomain,
          MPI_Comm comm, double anchor_step) {
  // A provisional order, one owner per cluster, which the sort then replaces.
  const auto extra_planes = store.extra_planes;
  const int stress_planes = store.stress_planes;
  store = {};
  store.extra_planes = extra_planes, store.stress_planes = stress_planes;
  const auto mine = [&](const Seed<dim>& seed) {  // the sort lists those outside as lost
    return subdomain.owns(columns.domain().contains(seed.position) ? columns.group(seed.position) : 0);
  };
  std::size_t water = 0;
  seeds.for_each([&](std::size_t, const Seed<dim>& seed) {
    store.owners = std::max<int>(store.owners, seed.owner + 1);
    water += seed.owner == 0 && mine(seed);
  });
  const auto add = [&](std::size_t id, const Seed<dim>& seed) {
    for (int k = 0; k < dim; ++k) store.x[k].push_back(seed.position[k]), store.v[k].push_back(seed.velocity[k]);
    store.deviation.push_back(seed.deviation);
    store.id.push_back(std::uint32_t(id));
  };
  const auto finish_owner = [&](int owner) {
    const std::size_t clusters = (store.id.size() + cluster_size - 1) / cluster_size;
    store.id.resize(clusters * cluster_size, no_particle);
    store.deviation.resize(clusters * cluster_size, 0.0);
    for (int k = 0; k < dim; ++k)
      store.x[k].resize(clusters * cluster_size, 0.0), store.v[k].resize(clusters * cluster_size, 0.0);
    store.owner.resize(clusters, std::uint16_t(owner));
  };
  // Most seeds are water: it goes where it belongs at once. Solids wait for it to end.
  store.id.reserve(water), store.deviation.reserve(water);
  for (int k = 0; k < dim; ++k) store.x[k].reserve(water), store.v[k].reserve(water);
  std::vector<std::vector<std::pair<std::size_t, Seed<dim>>>> of_solid(std::size_t(store.owners));
  seeds.for_each([&](std::size_t id, const Seed<dim>& seed) {
    if (!mine(seed)) return;
    if (seed.owner == 0)
      add(id, seed);
    else
      of_solid[seed.owner].emplace_back(id, seed);
  });
  finish_owner(0);
  for (int owner = 1; owner < store.owners; ++owner) {
    for (const auto& [id, seed] : of_solid[std::size_t(owner)]) add(id, seed);
    finish_owner(owner);
    of_solid[std::size_t(owner)] = {};
  }
  Sorting<dim, Real>(store, columns, subdomain, anchor_step).all(comm);
}

#define SPINDRIFT_SPH_INSTANTIATE(dim, Real)                                                                                \
  template class Sorting<dim, Real>;                                                                                        \
  template void exchange_halo_structure<dim, Real>(Store<dim, Real>&, const Columns<dim>&, const Subdomain&, MPI_Comm);     \
  template void fill<dim, Real>(Store<dim, Real>&, const SeedStream<dim>&, const Columns<dim>&, const Subdomain&, MPI_Comm, \
                                double);
SPINDRIFT_SPH_INSTANTIATE(2, float)
SPINDRIFT_SPH_INSTANTIATE(2, double)
SPINDRIFT_SPH_INSTANTIATE(3, float)
SPINDRIFT_SPH_INSTANTIATE(3, double)
#undef SPINDRIFT_SPH_INSTANTIATE

}  // namespace spindrift::sph
