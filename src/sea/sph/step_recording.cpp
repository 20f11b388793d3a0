// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/step_recording.hpp"

#include "runtime/graph/sizes.hpp"

namespace spindrift::sph {

namespace {

constexpr std::size_t clusters_per_pass = 256;  // of a bundle for sweeps that touch each particle once: 50 us
constexpr std::size_t clusters_per_pairs = 24;  // of a bundle for pair sweeps: 100 us; a column in 3-D has more by itself
constexpr std::size_t solids_per_walls = 32;    // of a bundle for walls that look round for water: 50 us
constexpr std::size_t groups_per_bundle = 64;   // of empty columns, which may fill: no bundle spans the scene

/// Consecutive groups with about `wanted` clusters, counted from `first` on: all of a group, or its solids.
template <int dim, class Real>
void bundle(const Store<dim, Real>& store, const std::vector<int>& groups, std::size_t wanted,
            std::vector<std::vector<int>>& into, std::uint32_t Group::*first = &Group::fluid) {
  std::size_t clusters = wanted;
  for (const int g : groups) {
    if (clusters >= wanted || into.back().size() >= groups_per_bundle) into.emplace_back(), clusters = 0;
    into.back().push_back(g);
    clusters += store.groups[std::size_t(g)].end - store.groups[std::size_t(g)].*first;
  }
}

}  // namespace

template <int dim, class Real>
StepRecording<dim, Real>::StepRecording(SeaState<dim, Real>& sea, runtime::Graph& graph) : sea(sea), graph(graph) {
  const Subdomain& subdomain = sea.subdomain;
  bundle(sea.store, subdomain.own, clusters_per_pass, bundles);
  bundle(sea.store, subdomain.own, solids_per_walls, wall_bundles, &Group::solid);
  std::vector<std::vector<int>> colours(std::size_t(sea.columns.colours()));
  for (int g = 0; g < sea.columns.groups(); ++g) {
    bool swept = subdomain.owns(g);  // a group of another rank is swept for its pairs with mine
    sea.columns.for_forward(g, [&](const Neighbour<dim>& near) { swept = swept || subdomain.owns(near.group); });
    if (swept) colours[std::size_t(sea.columns.colour(g))].push_back(g);
  }
  for (const std::vector<int>& colour : colours) bundle(sea.store, colour, clusters_per_pairs, pair_bundles);

  order = graph.datum(), plan = graph.datum(), loads = graph.datum();
  // Places follow the own groups, so that a thread keeps its region; groups of the halo have none.
  for (GroupData* data : {&state, &planes, &walls, &sums, &carried, &stress, &touches, &extra[0], &extra[1], &extra[2]}) {
    data->resize(std::size_t(sea.columns.groups_and_images()));
    for (std::size_t n = 0; n < subdomain.own.size(); ++n)
      (*data)[std::size_t(subdomain.own[n])] = graph.datum(float(n) / float(subdomain.own.size()));
    for (const Subdomain::Border& border : subdomain.borders)
      for (const int g : border.received) (*data)[std::size_t(g)] = graph.datum();
    for (const int g : subdomain.images) (*data)[std::size_t(g)] = graph.datum();
  }
  for (const int g : subdomain.own) {
    const Group& group = sea.store.groups[std::size_t(g)];
    const std::size_t of_plane = (group.end - group.fluid) * cluster_size * sizeof(Real);
    for (const GroupData* data : {&planes, &walls})
      runtime::set_bytes(graph, (*data)[std::size_t(g)], pack_planes<dim> * of_plane);
    runtime::set_bytes(graph, stress[std::size_t(g)], sea.store.stress_planes * of_plane);
  }
}

template struct StepRecording<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
