// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/priority.hpp"

#include <algorithm>
#include <map>

#include "runtime/executor/ready_queue.hpp"
#include "runtime/graph/edges.hpp"
#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {
namespace {

constexpr double guess_ns = 1000;    // of a task that has not run yet
constexpr double message_ns = 5000;  // of any message: the measured time contains the wait for the peer

double iterations(const Loop& loop) {
  return loop.entries > 0 ? double(loop.iterations) / double(loop.entries) : double(loop.min);
}

/// Urgency of the most urgent loop round a node.
int urgency(const Graph::Recorded& g, std::uint32_t node) {
  int most = 0;
  for (std::uint32_t at = node; at != no_node; at = g.nodes[at].loop)
    if (g.nodes[at].kind == NodeKind::loop) most = std::max(most, g.limits[g.payload[at]].urgency);
  return most;
}

}  // namespace

std::vector<double> cost_to_go(const Program& program, const Graph& graph) {
  const auto nodes = graph.nodes();
  const Bodies bodies(nodes);
  std::vector<double> to_go(nodes.size(), 0.0), longest(program.loops.size(), 0.0), cost(nodes.size(), 0.0);

  const auto body_backwards = [&](std::uint32_t loop_node, double& body_longest) {
    const auto members = bodies.of(loop_node);
    for (auto at = members.rbegin(); at != members.rend(); ++at) {
      const Slot& slot = program.slots[*at];
      if (slot.action == Action::loop)
        cost[*at] = iterations(program.loops[slot.payload]) * longest[slot.payload];
      else if (slot.action == Action::message)
        cost[*at] = message_ns;
      else
        cost[*at] = slot.step > 0 ? double(slot.cost_ns) / double(slot.step) : guess_ns;
      double after = 0;
      for (std::uint32_t s = slot.first; s < slot.last; ++s)
        if (program.successors[s] % 2 == 0) after = std::max(after, to_go[program.successors[s] / 2]);
      to_go[*at] = cost[*at] + after;
      body_longest = std::max(body_longest, to_go[*at]);
    }
  };
  for (std::size_t l = program.loops.size(); l-- > 1;)  // inner loops were recorded after the loops round them
    body_backwards(program.loops[l].slot, longest[l]);
  body_backwards(no_node, longest[0]);

  for (std::size_t l = 1; l < program.loops.size(); ++l) {  // outer loops first: their nodes are final when inner ones ask
    const std::uint32_t node = program.loops[l].slot;
    const double after = to_go[node] - cost[node] + 0.5 * (iterations(program.loops[l]) - 1) * longest[l];
    for (const std::uint32_t member : bodies.of(node)) to_go[member] += after;
  }
  return to_go;
}

std::vector<std::uint32_t> assign_levels(Program& program, const Graph& graph) {
  const std::size_t n_nodes = graph.nodes().size();
  const auto to_go = cost_to_go(program, graph);
  std::map<int, double> longest;  // by urgency
  std::vector<int> urgency_of(n_nodes);
  for (std::uint32_t n = 0; n < n_nodes; ++n) {
    urgency_of[n] = urgency(graph.recorded(), n);
    double& most = longest[urgency_of[n]];
    most = std::max(most, to_go[n]);
  }
  const int band = std::max(1, max_levels / int(longest.size()));
  std::map<int, int> first_level;
  int next = 0;
  for (const auto& [u, most] : longest) first_level[u] = std::min(band * next++, max_levels - band);
  std::vector<std::uint32_t> capacity(max_levels, 0);
  for (std::uint32_t n = 0; n < n_nodes; ++n) {
    const double share = longest[urgency_of[n]] > 0 ? to_go[n] / longest[urgency_of[n]] : 0.0;
    program.slots[n].level = std::uint8_t(first_level[urgency_of[n]] + std::min(band - 1, int(share * band)));
    if (program.slots[n].action == Action::collective) program.slots[n].level = max_levels - 1;  // other ranks wait inside theirs
    ++capacity[program.slots[n].level];
  }
  return capacity;
}

}  // namespace spindrift::runtime
