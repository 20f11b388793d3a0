// A graph recorded on one rank, cut for many: its blocks (what stands at one place of the thread team: a tile, a column of
// particles) go to ranks by the partitioner of runs, by measured cost and the bytes that pass between blocks. A task runs on
// every rank that owns a block which it writes, one that writes none on all ranks, as in the code; there it takes its share of
// the time where it works on all that a rank holds. Of a task in parts one rank does all, others their own parts. Before tasks
// that read another rank's block, one message per pair of ranks and family of tasks. Used by predict.cpp; tested in
// tests/runtime/replay/recut_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "runtime/partition/partition.hpp"
#include "runtime/replay/simulate.hpp"

namespace spindrift::runtime {

struct Recut {
  std::vector<RankRun> ranks;
  PartitionQuality quality;  ///< by module in the order of their names
  std::vector<std::string> modules;
  std::vector<int> blocks_of;  ///< by module
  int blocks = 0;
  double repeated = 0.0;  ///< work done on more than one rank, of all that was recorded
};

/// `first_rank`: number of the first rank, by which messages name them. `alike`: so many equal parts (copies.hpp), each cut in
/// the same way for its share of the ranks. Throws std::invalid_argument for a graph with messages, which was recorded on several
/// ranks.
Recut recut(const GraphRecord& graph, const RunRecord& run, int ranks, int first_rank = 0, int alike = 1);

/// What of a graph belongs to modules for which `wanted` answers true, without what lies between them and others.
template <class Wanted>
RankRun part_of(const GraphRecord& graph, const RunRecord& run, Wanted&& wanted);

/// Two graphs as one, without order between them.
RankRun joined(const RankRun& a, const RankRun& b);

// ---- implementation

template <class Wanted>
RankRun part_of(const GraphRecord& graph, const RunRecord& run, Wanted&& wanted) {
  RankRun part;
  part.graph.data = graph.data;
  part.run = run;
  part.run.ns.clear(), part.run.iterations.clear(), part.run.skipped.clear();
  std::vector<std::uint32_t> as(graph.nodes.size(), no_node);
  for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const std::string_view label = graph.nodes[n].label;
    if (!wanted(label.substr(0, label.find('/')))) continue;
    as[n] = std::uint32_t(part.graph.nodes.size());
    part.graph.nodes.push_back(graph.nodes[n]);
    NodeRecord& node = part.graph.nodes.back();
    if (node.loop != no_node) node.loop = as[node.loop];
    part.run.ns.push_back(run.ns[n]), part.run.iterations.push_back(run.iterations[n]);
    part.run.skip_as(as[n], run, n);
  }
  for (const Edge& edge : graph.edges)
    if (as[edge.from] != no_node && as[edge.to] != no_node)
      part.graph.edges.push_back({as[edge.from], as[edge.to], edge.distance});
  return part;
}

}  // namespace spindrift::runtime
