// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/program.hpp"

#include <algorithm>
#include <span>

#include "runtime/graph/edges.hpp"
#include "runtime/graph/errors.hpp"
#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {
namespace {

/// Sinks told through one counter; more go through a tree of counters, so that threads do not queue for one cache line.
constexpr std::size_t join_width = 16;

Action action_of(const Graph::Recorded& g, std::uint32_t node) {
  switch (g.nodes[node].kind) {
    case NodeKind::task:
      return Action::work;
    case NodeKind::collective:
      return g.takes_turns ? Action::collective : Action::collective_here;
    case NodeKind::until:
      return Action::until;
    case NodeKind::loop:
      return Action::loop;
    case NodeKind::reduce:
      return g.reductions[g.payload[node]]->needs_messages() ? Action::message : Action::reduce_here;
    case NodeKind::send:
    case NodeKind::receive:
      return Action::message;
  }
  return Action::work;
}

/// The tree of joins that tells the end of an iteration, before slots exist. A join's own `join` is the next one up.
struct Join {
  std::uint32_t loop, need, join;
};

/// Joins the sinks of one body; sets `join_of` of the sinks. Slots of joins start at `first_slot`. Returns the slot of the last.
std::uint32_t join_sinks(std::uint32_t loop, std::vector<std::uint32_t> sinks, std::uint32_t first_slot, std::vector<Join>& joins,
                         std::vector<std::uint32_t>& join_of) {
  do {  // at least one join: the end of the iteration
    std::vector<std::uint32_t> above;
    for (std::size_t first = 0; first < sinks.size(); first += join_width) {
      const auto group = std::span(sinks).subspan(first, std::min(join_width, sinks.size() - first));
      const auto join = first_slot + std::uint32_t(joins.size());
      joins.push_back({loop, std::uint32_t(group.size()), no_node});
      for (const std::uint32_t sink : group) (sink < first_slot ? join_of[sink] : joins[sink - first_slot].join) = join;
      above.push_back(join);
    }
    sinks = std::move(above);
  } while (sinks.size() > 1);
  return sinks[0];
}

}  // namespace

Program::Program(const Graph& graph) {
  const Graph::Recorded& g = graph.recorded();
  const auto edges = graph.edges();
  const auto n_nodes = std::uint32_t(g.nodes.size());
  const Bodies bodies(g.nodes);
  const auto loop_of = [&](std::uint32_t node) { return node == no_node ? 0u : g.payload[node] + 1; };

  struct Degree {
    std::int32_t same_step = 0, step_before = 0;
    bool followed = false;
  };
  std::vector<Degree> degree(n_nodes);
  for (const Edge& e : edges) {
    ++(e.distance == 0 ? degree[e.to].same_step : degree[e.to].step_before);
    if (e.distance == 0) degree[e.from].followed = true;
  }

  loops.resize(g.limits.size() + 1);
  std::vector<Join> joins;
  std::vector<std::uint32_t> join_of(n_nodes, no_node), self_ordered;
  std::vector<bool> gated(n_nodes, false);
  const auto lay_out = [&](std::uint32_t node) {
    Loop& loop = loops[loop_of(node)];
    if (node != no_node) {
      const Loop& outer = loops[loop_of(g.nodes[node].loop)];
      loop.slot = node;
      loop.outermost = outer.slot == no_node ? node : outer.outermost;
      loop.min = g.limits[g.payload[node]].min, loop.max = g.limits[g.payload[node]].max;
      loop.until = g.until_of[g.payload[node]];
    }
    std::vector<std::uint32_t> sinks;
    loop.first_gate = std::uint32_t(gates.size());
    for (const std::uint32_t member : bodies.of(node)) {
      if (!degree[member].followed) sinks.push_back(member);
      gated[member] = member == loop.until || degree[member].same_step == 0;
      if (gated[member] && member != loop.until) gates.push_back(member);
      if (gated[member] && degree[member].step_before == 0) self_ordered.push_back(member);
    }
    if (loop.until != no_node) gates.push_back(loop.until);
    loop.last_gate = std::uint32_t(gates.size());
    loop.end = join_sinks(loop_of(node), std::move(sinks), n_nodes, joins, join_of);
  };
  if (n_nodes == 0) throw GraphError("the graph has no tasks");
  lay_out(no_node);
  for (std::uint32_t n = 0; n < n_nodes; ++n)
    if (g.nodes[n].kind == NodeKind::loop) lay_out(n);

  slots = std::vector<Slot>(n_nodes + joins.size());
  for (std::uint32_t n = 0; n < n_nodes; ++n) {
    Slot& slot = slots[n];
    slot.loop = loop_of(g.nodes[n].loop);
    slot.join = join_of[n];
    slot.action = action_of(g, n);
    slot.payload = slot.action == Action::loop ? g.payload[n] + 1 : g.payload[n];
    slot.gated = gated[n];
  }
  for (const std::uint32_t n : self_ordered) ++degree[n].step_before;
  for (std::uint32_t n = 0; n < n_nodes; ++n) {
    slots[n].need = degree[n].same_step + degree[n].step_before + (gated[n] ? 1 : 0);
    slots[n].waiting[0] = slots[n].need - degree[n].step_before;  // nothing precedes step 0
    slots[n].waiting[1] = slots[n].need;
  }
  for (std::size_t j = 0; j < joins.size(); ++j) {
    Slot& slot = slots[n_nodes + j];
    slot.action = Action::join, slot.loop = joins[j].loop, slot.join = joins[j].join;
    slot.need = std::int32_t(joins[j].need);
    slot.waiting[0] = slot.waiting[1] = slot.need;
  }

  for (const Edge& e : edges) ++slots[e.from].last;
  for (const std::uint32_t n : self_ordered) ++slots[n].last;
  std::uint32_t total = 0;
  for (Slot& slot : slots) {
    slot.first = total;
    total += slot.last;
    slot.last = slot.first;
  }
  successors.resize(total);
  for (const Edge& e : edges) successors[slots[e.from].last++] = 2 * e.to + e.distance;
  for (const std::uint32_t n : self_ordered) successors[slots[n].last++] = 2 * n + 1;
}

}  // namespace spindrift::runtime
