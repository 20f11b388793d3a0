// Checks a block graph and brings it into the partitioners' form.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/work_graph.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace spindrift::runtime {

namespace {

void check(const BlockGraph& graph, int ranks) {
  if (ranks < 1) throw std::invalid_argument("partition: " + std::to_string(ranks) + " ranks; at least 1 is needed");
  if (graph.constraints < 1 || graph.cost.size() % std::size_t(graph.constraints) != 0)
    throw std::invalid_argument("partition: " + std::to_string(graph.cost.size()) + " costs do not make whole blocks of " +
                                std::to_string(graph.constraints) + " constraints");
  for (std::size_t n = 0; n < graph.cost.size(); ++n)
    if (!(graph.cost[n] >= 0.0) || !std::isfinite(graph.cost[n]))
      throw std::invalid_argument("partition: block " + std::to_string(n / graph.constraints) + " has cost " +
                                  std::to_string(graph.cost[n]) + "; costs are finite and not negative");
  for (const auto& edge : graph.edges)
    if (std::min(edge.a, edge.b) < 0 || std::max(edge.a, edge.b) >= graph.blocks() || !(edge.weight >= 0.0) ||
        !std::isfinite(edge.weight))
      throw std::invalid_argument("partition: edge " + std::to_string(edge.a) + "-" + std::to_string(edge.b) + " of weight " +
                                  std::to_string(edge.weight) + " in a graph of " + std::to_string(graph.blocks()) + " blocks");
}

void set_shares(WorkGraph& work, const BlockGraph& graph) {
  std::vector<double> total(graph.constraints, 0.0);
  for (std::size_t n = 0; n < graph.cost.size(); ++n) total[n % graph.constraints] += graph.cost[n];
  for (int block = 0; block < work.blocks; ++block)
    for (int c = 0; c < graph.constraints; ++c)
      if (total[c] > 0.0) work.shares.push_back(graph.cost[std::size_t(block) * graph.constraints + c] / total[c] * work.ranks);
  work.constraints = int(std::count_if(total.begin(), total.end(), [](double t) { return t > 0.0; }));
}

void set_neighbours(WorkGraph& work, const BlockGraph& graph) {
  auto edges = graph.edges;  // each both ways, sorted, equal pairs merged in the order given
  for (const auto& edge : graph.edges) edges.push_back({edge.b, edge.a, edge.weight});
  std::erase_if(edges, [](const auto& edge) { return edge.a == edge.b; });
  std::stable_sort(edges.begin(), edges.end(), [](const auto& l, const auto& r) { return l.a != r.a ? l.a < r.a : l.b < r.b; });
  work.first_neighbour.assign(std::size_t(work.blocks) + 1, 0);
  int block = -1;
  for (const auto& edge : edges) {
    if (edge.a == block && work.neighbours.back().block == edge.b) {
      work.neighbours.back().weight += edge.weight;
    } else {
      work.neighbours.push_back({edge.b, edge.weight});
      ++work.first_neighbour[std::size_t(edge.a) + 1];
    }
    block = edge.a;
  }
  for (int n = 0; n < work.blocks; ++n) work.first_neighbour[std::size_t(n) + 1] += work.first_neighbour[n];
}

}  // namespace

WorkGraph work_graph(const BlockGraph& graph, int ranks) {
  check(graph, ranks);
  WorkGraph work;
  work.blocks = graph.blocks();
  work.ranks = ranks;
  set_shares(work, graph);
  set_neighbours(work, graph);
  return work;
}

}  // namespace spindrift::runtime
