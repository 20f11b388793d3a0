// Which rank owns which group, which groups of others it receives (its halo) and which of its own it sends where. Pairs across a
// border are computed on both sides, in the order of the whole scene, so that sums do not depend on ranks (tasks.cpp).
// Called by ordering.cpp, sea_sph.cpp and tasks.cpp; tested in tests/src/sea/sph/subdomain_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "runtime/partition/block_graph.hpp"
#include "src/sea/sph/columns.hpp"

namespace spindrift::sph {

struct Subdomain {
  /// A rank with groups beside mine. Both lists ascend, so that what one rank sends another receives.
  struct Border {
    int rank = 0;
    std::vector<int> sent, received;
  };
  int rank = 0;
  std::vector<int> rank_of_group;
  std::vector<int> own;             ///< ascending
  std::vector<int> images;          ///< beside own groups, ascending; made here, of own groups and of those of the halo
  std::vector<Border> borders;      ///< by rank, ascending
  std::vector<std::uint8_t> owned;  ///< by group, images too: 1 for own ones

  bool owns(int group) const { return owned[std::size_t(group)] != 0; }
};

/// rings: how many columns away a sweep reads (1 for pairs; 2 where ghost nodes of walls read further).
template <int dim>
Subdomain subdomain_of(const Columns<dim>& columns, std::vector<int> rank_of_group, int rank, int rings = 1) {
  Subdomain t{.rank = rank, .rank_of_group = std::move(rank_of_group)};
  const int groups = columns.groups();
  t.owned.resize(std::size_t(columns.groups_and_images()));
  std::vector<std::vector<int>> around(std::size_t(groups), std::vector<int>{});
  std::set<int> images;
  for (int g = 0; g < groups; ++g) {
    t.owned[std::size_t(g)] = t.rank_of_group[std::size_t(g)] == rank;
    if (t.owns(g)) t.own.push_back(g);
    columns.for_forward(g, [&](const Neighbour<dim>& near) {
      if (columns.is_image(near.group)) {
        if (t.owns(g)) images.insert(near.group);
        return;
      }
      around[std::size_t(g)].push_back(near.group), around[std::size_t(near.group)].push_back(g);
    });
  }
  t.images.assign(images.begin(), images.end());
  std::vector<std::set<int>> sent(std::size_t(1 + *std::max_element(t.rank_of_group.begin(), t.rank_of_group.end())));
  auto received = sent;
  for (const int g : t.own) {
    std::set<int> near{g};
    for (int ring = 0; ring < rings; ++ring) {
      const std::set<int> before = near;
      for (const int n : before) near.insert(around[std::size_t(n)].begin(), around[std::size_t(n)].end());
    }
    for (const int n : near) {
      if (t.owns(n)) continue;
      const auto r = std::size_t(t.rank_of_group[std::size_t(n)]);
      sent[r].insert(g), received[r].insert(n);
    }
  }
  for (std::size_t r = 0; r < sent.size(); ++r)
    if (!sent[r].empty())
      t.borders.push_back({int(r), {sent[r].begin(), sent[r].end()}, {received[r].begin(), received[r].end()}});
  return t;
}

/// All groups on one rank.
template <int dim>
Subdomain whole_subdomain(const Columns<dim>& columns) {
  return subdomain_of(columns, std::vector<int>(std::size_t(columns.groups()), 0), 0);
}

/// What a group costs, counted, in clusters of water and of walls: each cluster meets those of its own and of the neighbouring
/// groups. Counted and not measured, so that runs repeat. How well it follows measured times has not been compared.
struct GroupCount {
  int group, water, solid;  ///< clusters
};
template <int dim>
runtime::BlockGraph block_graph(const Columns<dim>& columns, const std::vector<GroupCount>& counts) {
  runtime::BlockGraph graph;
  graph.cost.assign(std::size_t(columns.groups()), 0.0);
  std::vector<double> water(graph.cost), solid(graph.cost);
  for (const GroupCount& c : counts) water[std::size_t(c.group)] = c.water, solid[std::size_t(c.group)] = c.solid;
  for (int g = 0; g < columns.groups(); ++g) {
    const auto a = std::size_t(g);
    graph.cost[a] += water[a] * (0.5 * water[a] + solid[a]) + 0.2 * (water[a] + solid[a]);
    columns.for_forward(g, [&](const Neighbour<dim>& near) {
      const auto b = std::size_t(columns.is_image(near.group) ? columns.source(near.group) : near.group);
      graph.cost[a] += 0.6 * (water[a] * (water[b] + solid[b]) + solid[a] * water[b]);  // not all of them come near
      if (!columns.is_image(near.group) && water[a] + solid[a] + water[b] + solid[b] > 0)
        graph.edges.push_back({g, near.group, water[a] + solid[a] + water[b] + solid[b]});
    });
  }
  return graph;
}

}  // namespace spindrift::sph
