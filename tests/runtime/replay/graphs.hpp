// Graphs with costs that are given, not measured, for tests with answers that can be worked out on paper.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>
#include <string>

#include "runtime/executor/executor.hpp"
#include "runtime/replay/recorder.hpp"
#include "runtime/replay/simulate.hpp"

namespace spindrift::runtime::testing {

inline constexpr double us = 1e-6;

/// A graph whose loops all have a fixed number of iterations, each execution of a node taking ns_of(label).
template <class NsOf>
RankRun worked_out(Graph graph, NsOf&& ns_of) {
  const Executor executor(std::move(graph), {.threads = 1, .watchdog_s = 0});
  RankRun out{graph_record(executor.team()), {}};
  const auto& nodes = out.graph.nodes;
  const auto times = [&](std::uint32_t loop) {
    std::size_t product = 1;
    for (; loop != no_node; loop = nodes[loop].loop) product *= nodes[loop].limits.min;
    return product;
  };
  for (const NodeRecord& node : nodes) {
    const bool loop = node.kind == NodeKind::loop;
    out.run.ns.emplace_back(loop ? 0 : times(node.loop), loop ? 0 : ns_of(node.label));
    out.run.iterations.emplace_back(loop ? times(node.loop) : 0, node.limits.min);
  }
  for (const auto& ns : out.run.ns) out.run.task_ns = std::accumulate(ns.begin(), ns.end(), out.run.task_ns);
  out.run.wall_ns = out.run.task_ns;
  return out;
}
inline double sum_s(const RankRun& rank) {
  double ns = 0;
  for (const auto& of_node : rank.run.ns) ns += std::accumulate(of_node.begin(), of_node.end(), 0.0);
  return 1e-9 * ns;
}

/// A network that takes no time, threads as given.
inline Cluster ideal(int ranks, int threads) { return {.ranks = ranks, .threads = threads, .between = {}, .within = {}}; }

}  // namespace spindrift::runtime::testing
