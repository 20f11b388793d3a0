// SPDX-License-Identifier: Apache-2.0
#include "runtime/graph/graph.hpp"

#include <algorithm>

#include "runtime/graph/edges.hpp"
#include "runtime/graph/errors.hpp"
#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {
namespace {

/// Tag of the executor's own messages; MPI promises tags up to 32767.
constexpr int max_tag = 32766;

Access merged(Access a, Access b) { return a == b ? a : Access::update; }

/// Adds one access to those of the node whose accesses start at `first`, once per datum.
void touch(Graph::Recorded& g, std::uint32_t first, std::uint32_t datum, Access how) {
  const std::uint32_t at = g.seen_at[datum];
  if (at >= first && at < g.touched.size() && g.touched[at].datum == datum) {
    g.touched[at].how = merged(g.touched[at].how, how);
    return;
  }
  g.seen_at[datum] = std::uint32_t(g.touched.size());
  g.touched.push_back({datum, how});
}

/// A new node inside the loop being recorded, not yet with accesses.
std::uint32_t new_node(Graph::Recorded& g, NodeKind kind, std::string label, std::size_t payload) {
  g.edges_known = false;
  const auto first = std::uint32_t(g.touched.size());
  g.nodes.push_back({std::move(label), kind, g.open, first, first, -1});
  g.payload.push_back(std::uint32_t(payload));
  g.message_bytes.push_back(0), g.messages_made.push_back(0);
  return std::uint32_t(g.nodes.size() - 1);
}

std::uint32_t add_node(Graph::Recorded& g, NodeKind kind, std::string label, const Uses& uses, std::size_t payload) {
  const std::uint32_t n = new_node(g, kind, std::move(label), payload);
  Node& node = g.nodes[n];
  for (const Use& use : uses)
    for (const Datum d : use.data()) {
      if (d.index >= g.place_of.size()) throw GraphError(node.label + ": uses a datum that is not of this graph");
      touch(g, node.first_use, d.index, use.how());
      if (use.how() != Access::read && node.place < 0) node.place = g.place_of[d.index];
    }
  node.last_use = std::uint32_t(g.touched.size());
  return n;
}

std::uint32_t add_message(Graph::Recorded& g, NodeKind kind, std::string label, const Uses& uses, Message message) {
  if (message.peer < 0 || message.peer >= g.comm.size())
    throw GraphError(label + ": peer " + std::to_string(message.peer) + " of " + std::to_string(g.comm.size()) + " ranks");
  if (message.tag < 0 || message.tag > max_tag)
    throw GraphError(label + ": tag " + std::to_string(message.tag) + ", at most 32766");
  if (!g.tags.insert({kind, message.peer, message.tag}).second)
    throw GraphError(label + ": another message with tag " + std::to_string(message.tag) + " to or from rank " +
                     std::to_string(message.peer));
  g.messages.push_back(std::move(message));
  return add_node(g, kind, std::move(label), uses, g.messages.size() - 1);
}

/// Of the label's module, made at its first use.
const Graph::Recorded::InOrder& in_order(Graph& graph, Graph::Recorded::OfModules& of, const std::string& label) {
  const std::string module = label.substr(0, label.find('/'));
  const auto found = of.find(module);
  if (found != of.end()) return found->second;
  return of.emplace(module, Graph::Recorded::InOrder{Communicator(graph.recorded().comm.get()), graph.datum()}).first->second;
}

}  // namespace

Graph::Graph(MPI_Comm comm) : recorded_(std::make_unique<Recorded>()) { recorded_->comm = Communicator(comm); }
Graph::Graph(Graph&&) noexcept = default;
Graph& Graph::operator=(Graph&&) noexcept = default;
Graph::~Graph() = default;

Datum Graph::datum(float place) {
  recorded_->place_of.push_back(place);
  recorded_->seen_at.push_back(~0u);
  return {std::uint32_t(recorded_->place_of.size() - 1)};
}

std::vector<Datum> Graph::data(std::size_t n) {
  std::vector<Datum> all;
  all.reserve(n);
  for (std::size_t i = 0; i < n; ++i) all.push_back(datum(float(i) / float(n)));
  return all;
}

std::uint32_t Graph::add_work(NodeKind kind, std::string label, const Uses& uses, Work work) {
  recorded_->works.push_back(std::move(work));
  return add_node(*recorded_, kind, std::move(label), uses, recorded_->works.size() - 1);
}

std::uint32_t Graph::collective(std::string label, const Uses& uses, std::function<void(MPI_Comm)> work,
                                std::function<bool()> active) {
  Recorded& g = *recorded_;
  g.takes_turns = g.comm.size() > 1;
  if (g.takes_turns && g.turns.get() == MPI_COMM_NULL) g.turns = Communicator(g.comm.get());
  const Recorded::InOrder& in = in_order(*this, g.collectives_of, label);
  g.collectives.push_back({std::move(work), std::move(active), in.comm.get(), std::uint32_t(g.nodes.size())});
  Uses ordered = uses;
  if (g.takes_turns) ordered.push_back(updates(in.order));
  return add_node(g, NodeKind::collective, std::move(label), ordered, g.collectives.size() - 1);
}

std::uint32_t Graph::send(std::string label, const Uses& uses, Message message) {
  return add_message(*recorded_, NodeKind::send, std::move(label), uses, std::move(message));
}

std::uint32_t Graph::receive(std::string label, const Uses& uses, Message message) {
  return add_message(*recorded_, NodeKind::receive, std::move(label), uses, std::move(message));
}

std::uint32_t Graph::reduce(std::string label, const Uses& uses, Reduction reduction) {
  Recorded& g = *recorded_;
  const Recorded::InOrder& in = in_order(*this, g.reductions_of, label);
  g.reductions.push_back(std::make_shared<Allreduce>(label, std::move(reduction), in.comm.get(), g.comm.size()));
  Uses ordered = uses;
  if (g.comm.size() > 1) ordered.push_back(updates(in.order));
  return add_node(g, NodeKind::reduce, std::move(label), ordered, g.reductions.size() - 1);
}

std::uint32_t Graph::until(std::string label, const Uses& uses, std::function<bool()> stop) {
  Recorded& g = *recorded_;
  if (g.open == no_node) throw GraphError(label + ": until belongs inside a loop");
  std::uint32_t& until = g.until_of[g.payload[g.open]];
  if (until != no_node) throw GraphError(label + ": loop " + g.nodes[g.open].label + " already ends by " + g.nodes[until].label);
  g.predicates.push_back(std::move(stop));
  return until = add_node(g, NodeKind::until, std::move(label), uses, g.predicates.size() - 1);
}

std::uint32_t Graph::open_loop(std::string label, Limits limits) {
  Recorded& g = *recorded_;
  if (limits.min < 1 || limits.max < limits.min)
    throw GraphError(label + ": iterations " + std::to_string(limits.min) + " to " + std::to_string(limits.max) +
                     "; need 1 <= min <= max");
  g.limits.push_back(limits);
  g.until_of.push_back(no_node);
  return g.open = new_node(g, NodeKind::loop, std::move(label), g.limits.size() - 1);
}

void Graph::close_loop(std::uint32_t n) {
  Recorded& g = *recorded_;
  const std::uint32_t body_uses = g.nodes[n].first_use, body_end = std::uint32_t(g.touched.size());
  const Limits& limits = g.limits[g.payload[n]];
  const bool asks = g.until_of[g.payload[n]] != no_node;
  if (n + 1 == g.nodes.size()) throw GraphError(g.nodes[n].label + ": the loop has no tasks");
  if (limits.min < limits.max && !asks) throw GraphError(g.nodes[n].label + ": between min and max an until must decide");
  if (limits.min == limits.max && asks)
    throw GraphError(g.nodes[n].label + ": min equals max, so its until would never be asked");
  g.nodes[n].first_use = body_end;  // a loop touches what its tasks touch (inner loops did this before, harmlessly twice)
  for (std::uint32_t u = body_uses; u < body_end; ++u) touch(g, body_end, g.touched[u].datum, g.touched[u].how);
  g.nodes[n].last_use = std::uint32_t(g.touched.size());
  g.open = g.nodes[n].loop;
}

void Graph::order(std::uint32_t before, std::uint32_t after) {
  Recorded& g = *recorded_;
  if (before >= g.nodes.size() || after >= g.nodes.size()) throw GraphError("order: no such node");
  if (g.nodes[before].loop != g.nodes[after].loop)
    throw GraphError("order: " + g.nodes[before].label + " and " + g.nodes[after].label + " are not in the same loop");
  g.orders.emplace_back(before, after);
  g.edges_known = false;
}

std::span<const Node> Graph::nodes() const { return recorded_->nodes; }
std::span<const Touch> Graph::touched() const { return recorded_->touched; }

std::span<const Edge> Graph::edges() const {
  Recorded& g = *recorded_;
  if (!g.edges_known) {
    g.edges = derive_edges(g.nodes, g.touched, g.place_of.size(), g.orders);
    g.edges_known = true;
  }
  return g.edges;
}

}  // namespace spindrift::runtime
