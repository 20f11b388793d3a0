// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/rebuild.hpp"

#include <numeric>

#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {

Graph rebuilt(const GraphRecord& record, int ranks) {
  Graph graph;
  Graph::Recorded& g = graph.recorded();
  for (const DatumRecord& datum : record.data) g.place_of.push_back(datum.place), g.seen_at.push_back(~0u);
  for (const NodeRecord& from : record.nodes) {
    const auto first = std::uint32_t(g.touched.size());
    for (const UseRecord& use : from.uses) g.touched.push_back({use.datum, use.how});
    const auto n = std::uint32_t(g.nodes.size());
    g.nodes.push_back({from.label, from.kind, from.loop, first, std::uint32_t(g.touched.size()), from.place});
    g.message_bytes.push_back(0), g.messages_made.push_back(0);
    switch (from.kind) {
      case NodeKind::collective:
        g.takes_turns = ranks > 1;
        g.payload.push_back(std::uint32_t(g.collectives.size()));
        g.collectives.push_back({[](MPI_Comm) {}, {}, MPI_COMM_NULL, n});
        break;
      case NodeKind::task:
        g.payload.push_back(std::uint32_t(g.works.size()));
        g.works.push_back([](const Context&) {});
        break;
      case NodeKind::send:
      case NodeKind::receive:
        g.payload.push_back(std::uint32_t(g.messages.size()));
        g.messages.push_back({from.peer, from.tag, {}});
        break;
      case NodeKind::reduce: {
        static double nothing = 0.0;
        g.payload.push_back(std::uint32_t(g.reductions.size()));
        g.reductions.push_back(std::make_shared<Allreduce>(from.label, Reduction{.result = {&nothing, 1}}, MPI_COMM_NULL, ranks));
        break;
      }
      case NodeKind::until:
        g.payload.push_back(std::uint32_t(g.predicates.size()));
        g.predicates.push_back([] { return true; });
        g.until_of[g.payload[from.loop]] = n;
        break;
      case NodeKind::loop:
        g.payload.push_back(std::uint32_t(g.limits.size()));
        g.limits.push_back(from.limits);
        g.until_of.push_back(no_node);
        break;
    }
  }
  g.edges = record.edges;
  g.edges_known = true;
  return graph;
}

void measure(Program& program, const RunRecord& run) {
  for (std::size_t n = 0; n < run.ns.size(); ++n) {
    Slot& slot = program.slots[n];
    slot.cost_ns = std::accumulate(run.ns[n].begin(), run.ns[n].end(), std::int64_t(0));
    slot.step = std::uint32_t(run.ns[n].size());
    if (slot.action != Action::loop) continue;
    Loop& loop = program.loops[slot.payload];
    loop.entries = run.iterations[n].size();
    loop.iterations = std::accumulate(run.iterations[n].begin(), run.iterations[n].end(), std::uint64_t(0));
  }
}

}  // namespace spindrift::runtime
