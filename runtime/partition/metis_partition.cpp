// METIS wants integer weights whose sums fit 32 bits: every constraint and the edges are scaled to a sum of 1e8.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/metis_partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>

namespace spindrift::runtime {

namespace {

/// Bisection puts a block of more than two ranks' shares with the ranks it counts for, divides it among them, and says so on
/// stdout. No partition of such a graph is balanced. The limit leaves a margin.
bool has_heavy_block(const WorkGraph& graph) {
  constexpr double heavy = 1.5;
  return std::ranges::any_of(graph.shares, [](double share) { return share > heavy; });
}

}  // namespace

std::optional<std::vector<int>> partition_by_metis(const WorkGraph& graph, MetisScheme scheme, double tolerance) {
  if (graph.ranks < 2 || graph.blocks < graph.ranks || graph.neighbours.empty() || graph.constraints == 0 ||
      has_heavy_block(graph))
    return std::nullopt;
  constexpr double whole = 1e8;
  std::vector<idx_t> first(graph.first_neighbour.begin(), graph.first_neighbour.end()), neighbour, edge_weight, cost;
  double total = 0.0;
  for (const auto& n : graph.neighbours) total += n.weight;
  for (const auto& n : graph.neighbours) {
    neighbour.push_back(n.block);
    edge_weight.push_back(std::max<idx_t>(1, idx_t(std::lround(n.weight / std::max(total, 1e-300) * whole))));
  }
  for (const double share : graph.shares) cost.push_back(idx_t(std::lround(share / graph.ranks * whole)));

  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  idx_t blocks = graph.blocks, constraints = graph.constraints, ranks = graph.ranks, cut = 0;
  std::vector<real_t> most(graph.constraints, real_t(1.0 + tolerance));
  std::vector<idx_t> rank(graph.blocks, 0);
  const auto call = scheme == MetisScheme::k_way ? METIS_PartGraphKway : METIS_PartGraphRecursive;
  if (call(&blocks, &constraints, first.data(), neighbour.data(), cost.data(), nullptr, edge_weight.data(), &ranks, nullptr,
           most.data(), options, &cut, rank.data()) != METIS_OK)
    return std::nullopt;
  return std::vector<int>(rank.begin(), rank.end());
}

}  // namespace spindrift::runtime
