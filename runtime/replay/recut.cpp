// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recut.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <tuple>

#include "runtime/graph/edges.hpp"
#include "runtime/replay/blocks.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

/// Writes the graphs of all ranks in the order of recording, following which rank has the newest of every datum.
class Cutter {
 public:
  Cutter(const GraphRecord& graph, const RunRecord& run, const std::vector<int>& owner, int ranks, int first_rank)
      : graph_(graph),
        run_(run),
        owner_(owner),
        count_(ranks),
        first_rank_(first_rank),
        bodies_(nodes_of(graph)),
        fresh_(graph.data.size() * std::size_t(ranks), 0),
        tag_(std::size_t(ranks) * std::size_t(ranks), 0),
        out_(std::size_t(ranks)) {
    for (int r = 0; r < ranks; ++r) {
      RankRun& to = out_[std::size_t(r)];
      to.graph.data = graph.data;
      to.run = without_nodes(run);
    }
    place_data();
    body(no_node);
    for (RankRun& rank : out_) finish(rank);
  }
  std::vector<RankRun> take() { return std::move(out_); }
  double repeated_ns() const { return repeated_ns_; }

 private:
  static std::vector<Node> nodes_of(const GraphRecord& graph) {
    std::vector<Node> nodes;
    for (const NodeRecord& node : graph.nodes) nodes.push_back({.label = "", .kind = node.kind, .loop = node.loop});
    return nodes;
  }

  /// Places of a rank's own data spread over its threads in the order in which they stood; those of others have none.
  void place_data() {
    for (int r = 0; r < count_; ++r) {
      std::set<float> own;
      for (std::size_t d = 0; d < owner_.size(); ++d)
        if (owner_[d] == r) own.insert(graph_.data[d].place);
      std::map<float, float> as;
      for (const float place : own) as.emplace(place, float(as.size()) / float(own.size()));
      for (std::size_t d = 0; d < owner_.size(); ++d)
        if (graph_.data[d].place >= 0)
          out_[std::size_t(r)].graph.data[d].place = owner_[d] == r ? as.at(graph_.data[d].place) : -1.0F;
    }
  }

  bool writes_tiles(const NodeRecord& node) const {
    return node.kind == NodeKind::task &&
           std::ranges::any_of(node.uses, [&](const UseRecord& use) { return writes_to(use) && owner_[use.datum] >= 0; });
  }

  /// Ranks that run a node: the owners of what it writes, or all.
  std::vector<int> ranks_of(const NodeRecord& node) const {
    if (writes_tiles(node)) {
      std::set<int> owners;
      for (const UseRecord& use : node.uses)
        if (writes_to(use) && owner_[use.datum] >= 0) owners.insert(owner_[use.datum]);
      return {owners.begin(), owners.end()};
    }
    std::vector<int> all(static_cast<std::size_t>(count_));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  void body(std::uint32_t loop) {
    const auto members = bodies_.of(loop);
    for (std::size_t at = 0; at < members.size();) {
      const NodeRecord& first = graph_.nodes[members[at]];
      if (first.kind == NodeKind::loop) {
        enter(members[at++]);
        continue;
      }
      std::size_t end = at + 1;  // of the tasks of one family
      const std::string family = family_of(first.label);
      while (first.kind == NodeKind::task && end < members.size() && graph_.nodes[members[end]].kind == NodeKind::task &&
             family_of(graph_.nodes[members[end]].label) == family)
        ++end;
      const auto phase = members.subspan(at, end - at);
      send_what_they_read(phase);
      for (const std::uint32_t n : phase) record(n);
      for (const std::uint32_t n : phase) outdate(n);
      at = end;
    }
  }

  void enter(std::uint32_t n) {
    outdate(n);  // what an iteration writes must pass in each
    const std::vector<std::uint32_t> outer = loop_now_;
    loop_now_.assign(std::size_t(count_), no_node);
    for (int r = 0; r < count_; ++r) {
      const std::uint32_t around = outer.empty() ? no_node : outer[std::size_t(r)];
      loop_now_[std::size_t(r)] = add(r, n, graph_.nodes[n].label, NodeKind::loop, around);
      RankRun& rank = out_[std::size_t(r)];
      rank.graph.nodes.back().limits = graph_.nodes[n].limits;
      rank.run.iterations.back() = run_.iterations[n];
    }
    body(n);
    for (int r = 0; r < count_; ++r) {
      std::vector<NodeRecord>& nodes = out_[std::size_t(r)].graph.nodes;
      const std::uint32_t loop = loop_now_[std::size_t(r)];
      std::map<std::uint32_t, Access> touched;
      if (loop + 1 == nodes.size()) add(r, n, graph_.nodes[n].label + "/nothing", NodeKind::task, loop);
      for (std::size_t m = loop + 1; m < nodes.size(); ++m)
        for (const UseRecord& use : nodes[m].uses) {
          const auto [known, is_new] = touched.emplace(use.datum, use.how);
          if (!is_new && known->second != use.how) known->second = Access::update;
        }
      for (const auto& [datum, how] : touched) nodes[loop].uses.push_back({datum, how});
    }
    loop_now_ = outer;
  }

  /// The other ranks' copies of what the node writes are old.
  void outdate(std::uint32_t n) {
    for (const UseRecord& use : graph_.nodes[n].uses)
      if (writes_to(use) && owner_[use.datum] >= 0)
        std::fill_n(fresh_.begin() + std::ptrdiff_t(use.datum) * count_, count_, std::uint8_t(0));
  }

  void send_what_they_read(std::span<const std::uint32_t> phase) {
    struct Parcel {
      std::uint64_t bytes = 0;
      std::set<std::uint32_t> data;
    };
    std::map<std::pair<int, int>, Parcel> parcels;
    for (const std::uint32_t n : phase) {
      const NodeRecord& node = graph_.nodes[n];
      if (!writes_tiles(node)) continue;
      for (const int r : ranks_of(node))
        for (const UseRecord& use : node.uses) {
          const int owner = owner_[use.datum];
          if (use.how != Access::read || owner < 0 || owner == r ||
              fresh_[std::size_t(use.datum) * std::size_t(count_) + std::size_t(r)])
            continue;
          Parcel& parcel = parcels[{owner, r}];
          const bool is_new = parcel.data.insert(use.datum).second;
          if (use.bytes > 0)
            parcel.bytes += use.bytes;
          else if (is_new)
            parcel.bytes += std::max(graph_.data[use.datum].bytes, unknown_bytes);
        }
    }
    const std::string label = std::string(module_of(graph_.nodes[phase[0]].label)) + "/messages/";
    for (const bool sends : {true, false})
      for (const auto& [pair, parcel] : parcels) {
        const auto [from, to] = pair;
        const int rank = sends ? from : to, peer = sends ? to : from;
        add(rank, phase[0], label + std::to_string(peer), sends ? NodeKind::send : NodeKind::receive, around(rank));
        NodeRecord& node = out_[std::size_t(rank)].graph.nodes.back();
        node.peer = first_rank_ + peer, node.bytes = parcel.bytes;
        int& tag = tag_[std::size_t(from * count_ + to)];
        node.tag = sends ? tag : tag++;
        for (const std::uint32_t datum : parcel.data) {
          node.uses.push_back({datum, sends ? Access::read : Access::write});
          fresh_[std::size_t(datum) * std::size_t(count_) + std::size_t(to)] = 1;
        }
      }
  }

  std::uint32_t around(int rank) const { return loop_now_.empty() ? no_node : loop_now_[std::size_t(rank)]; }

  std::uint32_t add(int rank, std::uint32_t origin, std::string label, NodeKind kind, std::uint32_t loop) {
    RankRun& to = out_[std::size_t(rank)];
    to.graph.nodes.push_back({.label = std::move(label), .kind = kind, .loop = loop});
    to.origin.push_back(origin);
    to.run.ns.emplace_back(), to.run.iterations.emplace_back();
    return std::uint32_t(to.graph.nodes.size() - 1);
  }

  /// What a rank does of the work of a node that it runs.
  double share(const NodeRecord& node, int rank) const {
    if (!writes_tiles(node)) return node.on_all ? 1.0 / count_ : 1.0;
    if (!node.in_parts) return 1.0;
    int first = -1, parts = 0, own = 0;
    for (const UseRecord& use : node.uses)
      if (const int owner = owner_[use.datum]; writes_to(use) && owner >= 0)
        first = first < 0 ? owner : first, ++parts, own += owner == rank;
    return rank == first ? 1.0 : double(own) / parts;
  }

  void record(std::uint32_t n) {
    const NodeRecord& node = graph_.nodes[n];
    const bool of_tiles = writes_tiles(node);
    double done = 0.0;
    for (const int r : ranks_of(node)) {
      add(r, n, node.label, node.kind, around(r));
      RankRun& rank = out_[std::size_t(r)];
      NodeRecord& to = rank.graph.nodes.back();
      to.bytes = node.bytes, to.on_all = node.on_all, to.in_parts = node.in_parts;
      for (const UseRecord& use : node.uses) {
        if (!of_tiles && owner_[use.datum] >= 0 && owner_[use.datum] != r) continue;  // every rank looks at its own
        to.uses.push_back(use);
        if (writes_to(use) && to.place < 0) to.place = rank.graph.data[use.datum].place;
      }
      const double part = share(node, r);
      done += part;
      rank.run.ns.back() = run_.ns[n];
      if (part < 1.0)
        for (std::int64_t& ns : rank.run.ns.back()) ns = std::llround(part * double(ns));
      rank.run.skip_as(std::uint32_t(rank.graph.nodes.size() - 1), run_, n);
    }
    if (node.kind == NodeKind::task) repeated_ns_ += (done - 1.0) * std::accumulate(run_.ns[n].begin(), run_.ns[n].end(), 0.0);
  }

  /// Orders that only several ranks need (graph/graph.cpp), then the edges.
  void finish(RankRun& rank) const {
    GraphRecord& graph = rank.graph;
    if (count_ > 1) {
      std::map<std::pair<NodeKind, std::string>, std::uint32_t> order;  // of the reductions and of the calls of a module
      for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
        const NodeKind kind = graph.nodes[n].kind;
        if (kind != NodeKind::reduce && kind != NodeKind::collective) continue;
        const auto [datum, is_new] =
            order.emplace(std::pair(kind, std::string(module_of(graph.nodes[n].label))), std::uint32_t(graph.data.size()));
        if (is_new) graph.data.push_back({});
        const std::uint32_t ordered = datum->second;
        for (std::uint32_t at = n; at != no_node; at = graph.nodes[at].loop)
          if (std::ranges::none_of(graph.nodes[at].uses, [&](const UseRecord& use) { return use.datum == ordered; }))
            graph.nodes[at].uses.push_back({ordered, Access::update});
      }
    }
    std::vector<Node> nodes;
    std::vector<Touch> touched;
    for (const NodeRecord& node : graph.nodes) {
      const auto first = std::uint32_t(touched.size());
      for (const UseRecord& use : node.uses) touched.push_back({use.datum, use.how});
      nodes.push_back({node.label, node.kind, node.loop, first, std::uint32_t(touched.size()), node.place});
    }
    graph.edges = derive_edges(nodes, touched, graph.data.size(), {});
  }

  const GraphRecord& graph_;
  const RunRecord& run_;
  const std::vector<int>& owner_;
  const int count_, first_rank_;
  Bodies bodies_;
  std::vector<std::uint8_t> fresh_;  ///< [datum][rank]: it has the newest
  std::vector<int> tag_;             ///< next of each pair of ranks
  std::vector<std::uint32_t> loop_now_;
  std::vector<RankRun> out_;
  double repeated_ns_ = 0.0;
};

/// Of blocks that are so many equal parts one after the other, the first: what is partitioned, for all of them alike.
struct FirstPart {
  FirstPart(const Blocks& blocks, int parts) : of_block(std::size_t(blocks.count())) {
    const std::vector<int>& module = blocks.module_of_block();
    const auto constraints = std::size_t(blocks.weighted().constraints);
    weighted.constraints = int(constraints);
    int kept = 0;
    for (std::size_t b = 0; b < module.size();) {
      const auto end = std::size_t(std::upper_bound(module.begin(), module.end(), module[b]) - module.begin());
      const std::size_t size = (end - b) / std::size_t(parts);
      if (size * std::size_t(parts) != end - b) throw std::logic_error("copies that are not alike");
      for (std::size_t n = b; n < end; ++n) of_block[n] = {int((n - b) / size), kept + int((n - b) % size)};
      const auto cost = blocks.weighted().cost.begin();
      weighted.cost.insert(weighted.cost.end(), cost + std::ptrdiff_t(b * constraints),
                           cost + std::ptrdiff_t((b + size) * constraints));
      kept += int(size), b = end;
    }
    for (const BlockGraph::Edge& edge : blocks.weighted().edges)
      if (of_block[std::size_t(edge.a)].first == 0 && of_block[std::size_t(edge.b)].first == 0)
        weighted.edges.push_back({of_block[std::size_t(edge.a)].second, of_block[std::size_t(edge.b)].second, edge.weight});
  }
  BlockGraph weighted;
  std::vector<std::pair<int, int>> of_block;  ///< part it is in; which block of the first it is like
};

}  // namespace

Recut recut(const GraphRecord& graph, const RunRecord& run, int ranks, int first_rank, int alike) {
  require_no_messages(graph, "cut for others");
  const Blocks blocks(graph, run);
  const FirstPart part(blocks, alike);
  Recut out;
  out.modules = blocks.modules(), out.blocks = blocks.count();
  out.blocks_of.assign(out.modules.size(), 0);
  for (const int module : blocks.module_of_block()) ++out.blocks_of[std::size_t(module)];
  std::vector<int> rank_of_block(std::size_t(part.weighted.blocks()), 0);
  if (ranks > alike && !rank_of_block.empty()) {
    Partition partition = partition_blocks(part.weighted, {.ranks = ranks / alike});
    rank_of_block = std::move(partition.rank_of_block), out.quality = std::move(partition.quality);
  }
  std::vector<int> owner(graph.data.size(), -1);
  for (std::size_t d = 0; d < owner.size(); ++d)
    if (const int block = blocks.of_datum()[d]; block != no_block) {
      const auto [nth, in_first] = part.of_block[std::size_t(block)];
      owner[d] = nth * (ranks / alike) + rank_of_block[std::size_t(in_first)];
    }
  Cutter cutter(graph, run, owner, ranks, first_rank);
  out.repeated = cutter.repeated_ns();
  double all = 0.0;
  for (std::size_t n = 0; n < graph.nodes.size(); ++n)
    if (graph.nodes[n].kind == NodeKind::task) all += std::accumulate(run.ns[n].begin(), run.ns[n].end(), 0.0);
  out.repeated = all > 0.0 ? out.repeated / all : 0.0;
  out.ranks = cutter.take();
  return out;
}

RankRun joined(const RankRun& a, const RankRun& b) {
  RankRun both = a;
  const auto nodes = std::uint32_t(a.graph.nodes.size()), data = std::uint32_t(a.graph.data.size());
  both.graph.data.insert(both.graph.data.end(), b.graph.data.begin(), b.graph.data.end());
  for (NodeRecord node : b.graph.nodes) {
    if (node.loop != no_node) node.loop += nodes;
    for (UseRecord& use : node.uses) use.datum += data;
    both.graph.nodes.push_back(std::move(node));
  }
  for (const Edge& edge : b.graph.edges) both.graph.edges.push_back({edge.from + nodes, edge.to + nodes, edge.distance});
  both.run.ns.insert(both.run.ns.end(), b.run.ns.begin(), b.run.ns.end());
  both.run.iterations.insert(both.run.iterations.end(), b.run.iterations.begin(), b.run.iterations.end());
  for (const auto& [node, executions] : b.run.skipped) both.run.skipped[node + nodes] = executions;
  both.run.wall_ns += b.run.wall_ns, both.run.task_ns += b.run.task_ns, both.run.overhead_ns += b.run.overhead_ns;
  return both;
}

}  // namespace spindrift::runtime
