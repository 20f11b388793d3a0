// Groups by counting, clusters by halving (see ordering.hpp). Cost at the reference scene: docs/developer/notes/sea.md.
// Called through ordering.hpp; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/ordering.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "kernels/base/release.hpp"
#include "runtime/mpi/exchange.hpp"
#include "runtime/mpi/stop_request.hpp"

namespace spindrift::sph {
namespace {

constexpr std::uint32_t no_bin = ~std::uint32_t(0), no_group = no_bin;

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
  store_.id.resize(store_.slots());  // the halo's go
  place_.assign(std::size_t(columns_.groups()), 0);
  for (std::size_t n = 0; n < subdomain_.own.size(); ++n) place_[std::size_t(subdomain_.own[n])] = std::uint32_t(n);
  first_.assign(bin(subdomain_.own.size(), 0) + 1, 0);
  bin_of_.resize(store_.slots());
}

template <int dim, class Real>
template <class Visit>
void Sorting<dim, Real>::for_runs(int part, Visit&& visit) const {
  const auto [first, last] = range(bin_of_.size(), part);
  for (std::size_t begin = first; begin < last;) {
    std::size_t end = begin + 1;
    while (end < last && bin_of_[end] == bin_of_[begin]) ++end;
    if (bin_of_[begin] != no_bin) visit(std::size_t(bin_of_[begin]), begin, end);
    begin = end;
  }
}

template <int dim, class Real>
void Sorting<dim, Real>::classify(int part) {
  const Domain<dim>& domain = columns_.domain();
  leaving_[std::size_t(part)].clear();
  const auto [first, last] = range(store_.slots(), part);
  for (std::size_t slot = first; slot < last; ++slot) {
    bin_of_[slot] = no_bin;
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
    const int owner = store_.owner[slot / cluster_size];
    const bool inside = domain.contains(x) && !(owner == 0 && domain.in_wall(x));
    const int group = inside ? columns_.group(x) : -1;
    if (inside && subdomain_.owns(group))
      bin_of_[slot] = std::uint32_t(bin(place_[std::size_t(group)], owner));
    else
      leaving_[std::size_t(part)].push_back({std::uint32_t(slot), inside ? std::uint32_t(group) : no_group, owner});
  }
  for_runs(part, [&](std::size_t in, std::size_t begin, std::size_t end) {
    std::atomic_ref(first_[in + 1]).fetch_add(end - begin, std::memory_order_relaxed);
  });
}

template <int dim, class Real>
void Sorting<dim, Real>::migrate(MPI_Comm comm) {
  const auto arrays = state();
  std::vector<runtime::Packer> away(std::size_t(runtime::ranks_in(comm)));
  runtime::Packer lost;
  for (const std::vector<Leaver>& of_part : leaving_)
    for (const Leaver& leaver : of_part) {
      const std::size_t slot = leaver.slot;
      if (leaver.group == no_group) {
        LostParticle<dim> particle{store_.id[slot], {}, {}};
        for (int k = 0; k < dim; ++k) particle.position[k] = store_.x[k][slot], particle.velocity[k] = store_.v[k][slot];
        lost.put_one(particle);
        continue;
      }
      runtime::Packer& to = away[std::size_t(subdomain_.rank_of_group[leaver.group])];
      to.put_one(leaver.group), to.put_one(leaver.owner), to.put_one(store_.id[slot]);
      for (const Array<double>* array : arrays) to.put_one((*array)[slot]);
    }
  std::vector<runtime::Bytes> parcels;
  for (auto& packer : away) parcels.push_back(packer.take());
  for (const runtime::Bytes& bytes : runtime::exchange(comm, parcels)) {
    for (runtime::Unpacker from(bytes); !from.done();) {
      const auto group = from.one<std::uint32_t>();
      const std::size_t in = bin(place_[group], from.one<int>());
      bin_of_.push_back(std::uint32_t(in)), ++first_[in + 1];
      store_.id.push_back(from.one<std::uint32_t>());
      for (Array<double>* array : arrays) array->push_back(from.one<double>());
    }
  }
  const std::size_t known = store_.lost.size();
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, lost.take()))
    for (runtime::Unpacker from(bytes); !from.done();) store_.lost.push_back(from.one<LostParticle<dim>>());
  std::sort(store_.lost.begin() + std::ptrdiff_t(known), store_.lost.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  next_.assign(first_.begin(), first_.end() - 1);
  static_assert(alignof(Item) <= 64, "as arrays are aligned");
  store_.pack.clear();
  store_.pack.resize((first_.back() * sizeof(Item) + sizeof(Real) - 1) / sizeof(Real));
  Item* const items = reinterpret_cast<Item*>(store_.pack.data());
  std::uninitialized_default_construct_n(items, first_.back());
  items_ = {items, first_.back()};
}

template <int dim, class Real>
void Sorting<dim, Real>::put(int part) {
  for_runs(part, [&](std::size_t in, std::size_t begin, std::size_t end) {
    std::size_t to = std::atomic_ref(next_[in]).fetch_add(end - begin, std::memory_order_relaxed);
    for (std::size_t slot = begin; slot < end; ++slot, ++to) {
      Item& item = items_[to];
      for (int k = 0; k < dim; ++k) item.x[k] = store_.x[k][slot];
      item.id = store_.id[slot], item.slot = std::uint32_t(slot);
    }
  });
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
  slot_.resize(first_.size() - 1);
  std::size_t slot = 0;
  for (std::size_t n = 0; n < slot_.size(); ++n) slot_[n] = slot, slot += clusters_of(n) * cluster_size;
  source_.resize(slot);
}

template <int dim, class Real>
void Sorting<dim, Real>::halve(int part) {
  // Bins differ much in size: each part takes those whose first particle lies in its share.
  const auto [low, high] = range(first_.back(), part);
  for (std::size_t n = 0; n < slot_.size(); ++n) {
    if (first_[n] < low || first_[n] >= high || size_of(n) == 0) continue;
    const std::span<Item> items = items_.subspan(first_[n], size_of(n));
    halve(items);
    const auto to = source_.begin() + std::ptrdiff_t(slot_[n]);
    std::fill(std::ranges::transform(items, to, &Item::slot).out, to + std::ptrdiff_t(clusters_of(n) * cluster_size),
              no_particle);
  }
}

template <int dim, class Real>
void Sorting<dim, Real>::give_back() {
  items_ = {};
  store_.pack.clear();
  release(bin_of_);
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
  release(source_);
}

template <int dim, class Real>
void Sorting<dim, Real>::all(MPI_Comm comm) {
  begin();
  for (int part = 0; part < parts; ++part) classify(part);
  migrate(comm);
  for (int part = 0; part < parts; ++part) put(part);
  lay_out();
  for (int part = 0; part < parts; ++part) halve(part);
  give_back();
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
  store.sums.resize(store.slots() * sum_planes<dim>);
  if (const std::size_t before = store.carried.size(), now = store.slots() * std::size_t(store.carried_planes()); before != now) {
    store.carried.resize(now);
    if (before < now) std::fill(store.carried.begin() + std::ptrdiff_t(before), store.carried.end(), Real(0));
  }
  store.stress.resize(store.all_clusters() * std::size_t(store.stress_planes) * cluster_size);
  for (std::size_t n = 0; n < store.extra_sums.size(); ++n)
    store.extra_sums[n].resize(store.slots() * std::size_t(store.extra_planes[n]));
  for (int k = 0; k < dim; ++k) {
    // The search reads boxes a register at a time: one register more than there are clusters.
    store.low[k].resize(store.all_clusters() + cluster_size);
    store.high[k].resize(store.all_clusters() + cluster_size);
  }
}

namespace {

/// Whether seeds of the part may be in own columns; those outside the domain go to whoever has the first one.
template <int dim>
bool may_be_own(const SeedPart<dim>& part, const Columns<dim>& columns, const Subdomain& subdomain) {
  const Domain<dim>& domain = columns.domain();
  bool bounded = true, inside = true;
  for (int k = 0; k < dim - 1; ++k) {
    bounded = bounded && std::isfinite(part.low[k]) && std::isfinite(part.high[k]);
    inside = inside && (domain.periodic[k] || (part.low[k] >= domain.low[k] && part.high[k] < domain.high[k]));
  }
  bool own = !bounded || (!inside && subdomain.owns(0));
  if (!own)
    columns.for_overlapping(part.low, part.high, [&](const Neighbour<dim>& near) { own = own || subdomain.owns(near.group); });
  return own;
}

}  // namespace

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
  const auto visit_mine = [&](const typename SeedStream<dim>::Visit& visit) {
    runtime::give_up_together(comm, [&] {
      seeds.for_each(
          [&](std::size_t id, const Seed<dim>& seed) {
            if (mine(seed)) visit(id, seed);
          },
          [&](const SeedPart<dim>& part) { return may_be_own(part, columns, subdomain); });
    });
  };
  store.owners = seeds.owners();
  std::vector<std::size_t> next(std::size_t(store.owners), 0);  // slot, by owner; counts to begin with
  visit_mine([&](std::size_t, const Seed<dim>& seed) { ++next[seed.owner]; });
  for (std::size_t owner = 0; owner < next.size(); ++owner) {
    const std::size_t clusters = (next[owner] + cluster_size - 1) / cluster_size;
    next[owner] = store.owner.size() * cluster_size;
    store.owner.insert(store.owner.end(), clusters, std::uint16_t(owner));
  }
  const std::size_t slots = store.owner.size() * cluster_size;
  store.id.resize(slots, no_particle), store.deviation.resize(slots, 0.0);
  for (int k = 0; k < dim; ++k) store.x[k].resize(slots, 0.0), store.v[k].resize(slots, 0.0);
  visit_mine([&](std::size_t id, const Seed<dim>& seed) {
    const std::size_t slot = next[seed.owner]++;
    store.id[slot] = std::uint32_t(id), store.deviation[slot] = seed.deviation;
    for (int k = 0; k < dim; ++k) store.x[k][slot] = seed.position[k], store.v[k][slot] = seed.velocity[k];
  });
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
