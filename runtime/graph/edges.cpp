// SPDX-License-Identifier: Apache-2.0
#include "runtime/graph/edges.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "runtime/graph/errors.hpp"

namespace spindrift::runtime {
namespace {

/// Who touched one datum last: the writer, and the readers since, with the walk (0 first, 1 second) they were met in.
struct History {
  struct Reader {
    std::uint32_t node, next;
    int walk;
  };
  std::uint32_t body = no_node - 1, writer = no_node, readers = ~0u;  ///< body: of which this is the history
  int writer_walk = 0;
};

class EdgeFinder {
 public:
  EdgeFinder(std::span<const Node> nodes, std::span<const Touch> touched, std::size_t data)
      : nodes_(nodes), touched_(touched), history_(data), last_target_(nodes.size(), no_node) {}

  void walk_body(std::uint32_t loop, std::span<const std::uint32_t> body, std::vector<Edge>& edges) {
    readers_.clear();
    for (const int walk : {0, 1})
      for (const std::uint32_t node : body) {
        // Marks of the two walks differ, so that each finds its own predecessors once.
        const std::uint32_t mark = 2 * node + std::uint32_t(walk);
        for (std::uint32_t u = nodes_[node].first_use; u < nodes_[node].last_use; ++u)
          visit(loop, node, walk, mark, touched_[u], edges);
      }
  }

 private:
  void visit(std::uint32_t loop, std::uint32_t node, int walk, std::uint32_t mark, Touch touch, std::vector<Edge>& edges) {
    History& h = history_[touch.datum];
    if (h.body != loop) h = History{loop, no_node, ~0u, 0};
    const auto wait_for = [&](std::uint32_t from, int from_walk) {
      const bool seen_before = walk == 1 && from_walk == 1;  // both in the second walk: as in the first
      if (seen_before || last_target_[from] == mark) return;
      last_target_[from] = mark;
      edges.push_back({from, node, std::uint8_t(walk - from_walk)});
    };
    if (touch.how == Access::read) {
      if (h.writer != no_node) wait_for(h.writer, h.writer_walk);
      readers_.push_back({node, h.readers, walk});
      h.readers = std::uint32_t(readers_.size() - 1);
      return;
    }
    if (h.readers == ~0u && h.writer != no_node) wait_for(h.writer, h.writer_walk);
    for (std::uint32_t r = h.readers; r != ~0u; r = readers_[r].next) wait_for(readers_[r].node, readers_[r].walk);
    h.writer = node, h.writer_walk = walk, h.readers = ~0u;
  }

  std::span<const Node> nodes_;
  std::span<const Touch> touched_;
  std::vector<History> history_;
  std::vector<History::Reader> readers_;
  std::vector<std::uint32_t> last_target_;  ///< by predecessor: mark of the node that last found it
};

/// Names a cycle among the edges of distance 0, if there is one.
void check_cycles(std::span<const Node> nodes, std::span<const Edge> edges) {
  std::vector<std::uint32_t> waiting(nodes.size(), 0), first(nodes.size() + 1, 0), to;
  for (const Edge& e : edges)
    if (e.distance == 0) ++waiting[e.to], ++first[e.from + 1];
  for (std::size_t n = 0; n < nodes.size(); ++n) first[n + 1] += first[n];
  to.resize(first.back());
  auto fill = first;
  for (const Edge& e : edges)
    if (e.distance == 0) to[fill[e.from]++] = e.to;
  std::vector<std::uint32_t> ready;
  for (std::uint32_t n = 0; n < nodes.size(); ++n)
    if (waiting[n] == 0) ready.push_back(n);
  for (std::size_t at = 0; at < ready.size(); ++at)
    for (std::uint32_t s = first[ready[at]]; s < first[ready[at] + 1]; ++s)
      if (--waiting[to[s]] == 0) ready.push_back(to[s]);
  if (ready.size() == nodes.size()) return;

  // Every node left waits for one that is left: going back from any of them runs into the cycle.
  const auto predecessor = [&](std::uint32_t node) {
    for (const Edge& e : edges)
      if (e.distance == 0 && e.to == node && waiting[e.from] > 0) return e.from;
    return no_node;
  };
  auto node = std::uint32_t(std::find_if(waiting.begin(), waiting.end(), [](auto w) { return w > 0; }) - waiting.begin());
  std::vector<std::uint32_t> path;
  while (std::find(path.begin(), path.end(), node) == path.end()) {
    path.push_back(node);
    node = predecessor(node);
  }
  std::string names = nodes[node].label;
  const auto start = std::find(path.begin(), path.end(), node);
  for (auto n = path.end(); n != start;) names += " -> " + nodes[*--n].label;
  throw CycleError("tasks wait for each other: " + names);
}

/// Adds the edges that no datum gave.
void add_orders(std::span<const std::pair<std::uint32_t, std::uint32_t>> orders, std::vector<Edge>& edges) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint8_t>;
  std::set<Key> wanted;
  for (const auto& [before, after] : orders)
    wanted.insert({before, after, 0}), wanted.insert({after, before, 1});  // neither may get two iterations ahead
  for (const Edge& e : edges) wanted.erase({e.from, e.to, e.distance});
  for (const auto& [from, to, distance] : wanted) edges.push_back({from, to, distance});
}

}  // namespace

Bodies::Bodies(std::span<const Node> nodes) : first_(nodes.size() + 2, 0), members_(nodes.size()) {
  const auto slot = [](const Node& node) { return node.loop == no_node ? 0u : node.loop + 1; };
  for (const Node& node : nodes) ++first_[slot(node) + 1];
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  auto fill = first_;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) members_[fill[slot(nodes[n])]++] = n;
}

std::span<const std::uint32_t> Bodies::of(std::uint32_t loop) const {
  const std::size_t slot = loop == no_node ? 0 : loop + 1;
  return std::span(members_).subspan(first_[slot], first_[slot + 1] - first_[slot]);
}

std::vector<Edge> derive_edges(std::span<const Node> nodes, std::span<const Touch> touched, std::size_t data,
                               std::span<const std::pair<std::uint32_t, std::uint32_t>> orders) {
  std::vector<Edge> edges;
  edges.reserve(4 * nodes.size());
  const Bodies bodies(nodes);
  EdgeFinder finder(nodes, touched, data);
  finder.walk_body(no_node, bodies.of(no_node), edges);
  for (std::uint32_t n = 0; n < nodes.size(); ++n)
    if (nodes[n].kind == NodeKind::loop) finder.walk_body(n, bodies.of(n), edges);
  if (orders.empty()) return edges;  // which follow the order of recording: no cycle
  add_orders(orders, edges);
  check_cycles(nodes, edges);
  return edges;
}

}  // namespace spindrift::runtime
