// Groups by counting, clusters by halving (see ordering.hpp). Cost at the reference scene: docs/developer/sea.md.
// Called through ordering.hpp; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/ordering.hpp"

#include <algorithm>
#include <cmath>

namespace spindrift::sph {
namespace {

template <int dim>
struct Item {
  std::array<double, dim> x;
  std::uint32_t id, slot;
};

/// Halves until clusters are left; sizes are multiples of cluster_size but for the last.
template <int dim>
void halve(std::span<Item<dim>> items) {
  if (items.size() <= cluster_size) {
    std::sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return;
  }
  std::array<double, dim> low = items[0].x, high = items[0].x;
  for (const Item<dim>& item : items)
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

/// Where each particle goes: particles of (group, owner) stand together in `items`, `first` bounds them.
template <int dim>
struct Plan {
  std::vector<Item<dim>> items;
  std::vector<std::size_t> first;  ///< of each (group, owner), and the end
  int owners = 1;
};

template <int dim, class Real>
Plan<dim> plan(Store<dim, Real>& store, const Columns<dim>& columns) {
  Plan<dim> result;
  for (std::uint16_t owner : store.owner) result.owners = std::max(result.owners, int(owner) + 1);
  const Domain<dim>& domain = columns.domain();
  std::vector<std::uint32_t> key(store.slots(), no_particle);
  result.first.assign(std::size_t(columns.groups()) * result.owners + 1, 0);
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    std::array<double, dim> x;
    for (int k = 0; k < dim; ++k) {
      if (domain.periodic[k]) {
        const double length = domain.high[k] - domain.low[k];
        store.x[k][slot] -= length * std::floor((store.x[k][slot] - domain.low[k]) / length);
      }
      x[k] = store.x[k][slot];
    }
    if (!domain.contains(x)) {
      std::array<double, dim> v;
      for (int k = 0; k < dim; ++k) v[k] = store.v[k][slot];
      store.lost.push_back({store.id[slot], x, v});
      continue;
    }
    key[slot] = std::uint32_t(columns.group(x) * result.owners + store.owner[slot / cluster_size]);
    ++result.first[key[slot] + 1];
  }
  for (std::size_t n = 1; n < result.first.size(); ++n) result.first[n] += result.first[n - 1];
  result.items.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (key[slot] == no_particle) continue;
    Item<dim>& item = result.items[next[key[slot]]++];
    for (int k = 0; k < dim; ++k) item.x[k] = store.x[k][slot];
    item.id = store.id[slot], item.slot = std::uint32_t(slot);
  }
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t n = 0; n < result.first.size() - 1; ++n)
    if (result.first[n + 1] > result.first[n])
      halve(std::span(result.items).subspan(result.first[n], result.first[n + 1] - result.first[n]));
  return result;
}

template <class T>
void reorder(Array<T>& values, const Array<std::uint32_t>& source, T empty) {
  if (values.empty()) return;
  Array<T> sorted(source.size());
#pragma omp parallel for schedule(static)
  for (std::size_t slot = 0; slot < source.size(); ++slot)
    sorted[slot] = source[slot] == no_particle ? empty : values[source[slot]];
  values.swap(sorted);
}

template <int dim, class Real>
void place_anchors(Store<dim, Real>& store, double step) {
  for (int k = 0; k < dim; ++k) {
    store.anchor[k].resize(store.clusters());
    for (std::size_t cluster = 0; cluster < store.clusters(); ++cluster) {
      double low = 1e300, high = -1e300;
      for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size; ++slot)
        if (store.id[slot] != no_particle) low = std::min(low, store.x[k][slot]), high = std::max(high, store.x[k][slot]);
      store.anchor[k][cluster] = step * std::round(0.5 * (low + high) / step);
    }
  }
}

}  // namespace

template <int dim, class Real>
void sort(Store<dim, Real>& store, const Columns<dim>& columns, double anchor_step) {
  // The planes hold nothing between sweeps: giving them back first makes room for the plan, so that a sort never sets the memory
  // needed.
  store.pack = {}, store.sums = {};
  Array<std::uint32_t> source;
  {
    const Plan<dim> order = plan(store, columns);
    const auto clusters_of = [&](std::size_t n) {
      return (order.first[n + 1] - order.first[n] + cluster_size - 1) / cluster_size;
    };
    store.groups.resize(columns.groups());
    store.owner.clear();
    for (int group = 0; group < columns.groups(); ++group) {
      store.groups[group].fluid = std::uint32_t(store.owner.size());
      for (int owner = 0; owner < order.owners; ++owner) {
        if (owner == 1) store.groups[group].solid = std::uint32_t(store.owner.size());
        store.owner.insert(store.owner.end(), clusters_of(std::size_t(group) * order.owners + owner), std::uint16_t(owner));
      }
      store.groups[group].end = std::uint32_t(store.owner.size());
      if (order.owners == 1) store.groups[group].solid = store.groups[group].end;
    }
    source.assign(store.owner.size() * cluster_size, no_particle);
    std::size_t slot = 0;
    for (std::size_t n = 0; n + 1 < order.first.size(); ++n) {
      for (std::size_t item = order.first[n]; item < order.first[n + 1]; ++item)
        source[slot + item - order.first[n]] = order.items[item].slot;
      slot += clusters_of(n) * cluster_size;
    }
  }
  for (int k = 0; k < dim; ++k)
    reorder(store.x[k], source, 0.0), reorder(store.v[k], source, 0.0), reorder(store.v_before[k], source, 0.0);
  reorder(store.deviation, source, 0.0), reorder(store.deviation_before, source, 0.0);
  reorder(store.id, source, no_particle);
  store.corner = columns.domain().low;
  place_anchors(store, anchor_step);
  store.pack.resize(store.clusters() * pack_planes<dim> * cluster_size);
  store.sums.resize(store.clusters() * sum_planes<dim> * cluster_size);
  for (int k = 0; k < dim; ++k) {
    // The search reads boxes sixteen at a time: one register more than there are clusters.
    store.low[k].resize(store.clusters() + cluster_size);
    store.high[k].resize(store.clusters() + cluster_size);
  }
}

template <int dim, class Real>
void fill(Store<dim, Real>& store, std::span<const Seed<dim>> seeds, const Columns<dim>& columns, double anchor_step) {
  // A provisional order, one owner per cluster, which sort() then replaces.
  store = {};
  std::uint16_t owners = 0;
  for (const Seed<dim>& seed : seeds) owners = std::max<std::uint16_t>(owners, seed.owner + 1);
  for (std::uint16_t owner = 0; owner < owners; ++owner) {
    for (std::size_t n = 0; n < seeds.size(); ++n) {
      if (seeds[n].owner != owner) continue;
      for (int k = 0; k < dim; ++k) store.x[k].push_back(seeds[n].position[k]), store.v[k].push_back(seeds[n].velocity[k]);
      store.deviation.push_back(seeds[n].deviation);
      store.id.push_back(std::uint32_t(n));
    }
    const std::size_t clusters = (store.id.size() + cluster_size - 1) / cluster_size;
    store.id.resize(clusters * cluster_size, no_particle);
    store.deviation.resize(clusters * cluster_size, 0.0);
    for (int k = 0; k < dim; ++k)
      store.x[k].resize(clusters * cluster_size, 0.0), store.v[k].resize(clusters * cluster_size, 0.0);
    store.owner.resize(clusters, owner);
  }
  sort(store, columns, anchor_step);
}

#define SPINDRIFT_SPH_INSTANTIATE(dim, Real)                                     \
  template void sort<dim, Real>(Store<dim, Real>&, const Columns<dim>&, double); \
  template void fill<dim, Real>(Store<dim, Real>&, std::span<const Seed<dim>>, const Columns<dim>&, double);
SPINDRIFT_SPH_INSTANTIATE(2, float)
SPINDRIFT_SPH_INSTANTIATE(2, double)
SPINDRIFT_SPH_INSTANTIATE(3, float)
SPINDRIFT_SPH_INSTANTIATE(3, double)
#undef SPINDRIFT_SPH_INSTANTIATE

}  // namespace spindrift::sph
