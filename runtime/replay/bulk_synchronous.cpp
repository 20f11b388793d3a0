// The same recorded work in phases with a barrier after each: what the asynchronous executor is compared with.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>

#include "runtime/graph/edges.hpp"
#include "runtime/replay/simulate.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

/// A node of a rank.
struct Member {
  int rank;
  std::uint32_t node;
};
struct Phase {
  NodeKind kind;
  std::string family;
  std::vector<Member> members;  ///< of a loop: its node on every rank that has it
};

class BulkSynchronous {
 public:
  BulkSynchronous(std::span<const RankRun> ranks, const Cluster& cluster) : ranks_(ranks), cluster_(cluster) {
    for (const RankRun& rank : ranks) {
      const auto& nodes = rank.graph.nodes;
      before_.emplace_back(nodes.size());
      for (const Edge& edge : rank.graph.edges)
        if (edge.distance == 0) before_.back()[edge.to].push_back(edge.from);
      done_.emplace_back(nodes.size(), 0u);
      for (std::uint32_t n = 0; n < nodes.size(); ++n)
        bodies_[body_of(rank, nodes[n].loop)].push_back({int(&rank - ranks.data()), n});
    }
    for (auto& [loop, members] : bodies_) {
      std::ranges::stable_sort(members, {}, [&](const Member& m) { return origin(ranks_[std::size_t(m.rank)], m.node); });
      phases_[loop] = phases(members);
    }
  }

  Simulated run() {
    body(no_node, ranks_[0].run.replays, 1);
    out_.waiting_s = out_.wall_s * double(ranks_.size()) * cluster_.threads - out_.busy_s - out_.overhead_s;
    return std::move(out_);
  }

 private:
  static std::uint32_t origin(const RankRun& rank, std::uint32_t node) { return rank.origin.empty() ? node : rank.origin[node]; }
  static std::uint32_t body_of(const RankRun& rank, std::uint32_t loop) { return loop == no_node ? no_node : origin(rank, loop); }
  std::uint32_t body_of_loop(const Member& m) const { return origin(ranks_[std::size_t(m.rank)], m.node); }
  int number(int rank) const { return ranks_[std::size_t(rank)].number_at(rank); }
  const NodeRecord& node(const Member& m) const { return ranks_[std::size_t(m.rank)].graph.nodes[m.node]; }

  std::vector<Phase> phases(const std::vector<Member>& members) const {
    std::vector<Phase> all;
    std::map<std::pair<int, std::uint32_t>, std::size_t> phase_of;
    for (const Member& m : members) {
      const NodeRecord& at = node(m);
      const std::string family = at.kind == NodeKind::send || at.kind == NodeKind::receive ? "messages" : family_of(at.label);
      const auto waits = [&](std::uint32_t before) {
        const auto found = phase_of.find({m.rank, before});
        return found != phase_of.end() && found->second + 1 == all.size();
      };
      const NodeKind kind = at.kind == NodeKind::receive ? NodeKind::send : at.kind;
      const bool other_loop = kind == NodeKind::loop && !all.empty() && all.back().kind == kind &&
                              body_of_loop(all.back().members.front()) != body_of_loop(m);
      if (all.empty() || other_loop || all.back().family != family || all.back().kind != kind ||
          (kind != NodeKind::send && std::ranges::any_of(before_[std::size_t(m.rank)][m.node], waits)))
        all.push_back({kind, family, {}});
      all.back().members.push_back(m);
      phase_of[{m.rank, m.node}] = all.size() - 1;
    }
    return all;
  }

  void body(std::uint32_t loop, std::uint32_t iterations, std::uint32_t min) {
    const auto found = phases_.find(loop);
    if (found == phases_.end()) return;
    for (std::uint32_t i = 0; i < iterations; ++i)
      for (const Phase& phase : found->second)
        if (phase.kind != NodeKind::until || i + 1 >= min) take(phase);
  }

  void take(const Phase& phase) {
    if (phase.kind == NodeKind::loop) {
      const Member& first = phase.members.front();
      const RankRun& rank = ranks_[std::size_t(first.rank)];
      const auto& entries = rank.run.iterations[first.node];
      const std::uint32_t entry = done_[std::size_t(first.rank)][first.node]++, min = node(first).limits.min;
      return body(origin(rank, first.node), entry < entries.size() ? entries[entry] : min, min);
    }
    if (phase.kind == NodeKind::send) return messages(phase);
    const auto needed = std::ranges::find_if(phase.members, [&](const Member& m) { return !skips(m); });
    if (ranks_.size() > 1 && needed == phase.members.end()) {  // nobody waits for anybody
      for (const Member& m : phase.members) ++done_[std::size_t(m.rank)][m.node];
      return;
    }
    const double bytes = phase.kind == NodeKind::reduce && needed != phase.members.end() ? double(node(*needed).bytes) : 0.0;
    const int ranks = ranks_in_all(cluster_, int(ranks_.size()));
    double longest = 0.0;
    const double most = phase.kind == NodeKind::collective ? least_s(phase) : std::numeric_limits<double>::infinity();
    std::map<int, std::vector<double>> free;  // by rank: when each of its threads is
    for (const Member& m : phase.members) {
      std::vector<double>& threads = free.try_emplace(m.rank, std::size_t(cluster_.threads), 0.0).first->second;
      double& first = *std::ranges::min_element(threads);
      first += cost_s(m, phase.kind, most);
      longest = std::max(longest, first);
    }
    if (phase.kind == NodeKind::reduce) ++out_.reductions;
    out_.wall_s += longest + all_to_all_s(cluster_, ranks, bytes);
  }

  /// Of a collective call, the time on the rank that waited least for the others in it.
  double least_s(const Phase& phase) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Member& m : phase.members)
      if (!skips(m)) least = std::min(least, recorded_s(m, done_[std::size_t(m.rank)][m.node]));
    return least;
  }

  /// Whether its next execution was not needed.
  bool skips(const Member& m) const { return ranks_[std::size_t(m.rank)].run.skips(m.node, done_[std::size_t(m.rank)][m.node]); }

  double recorded_s(const Member& m, std::uint32_t execution) const {
    const auto& ns = ranks_[std::size_t(m.rank)].run.ns[m.node];
    return execution < ns.size() ? 1e-9 * double(ns[execution]) * speed_factor(cluster_, number(m.rank)) : 0.0;
  }

  double cost_s(const Member& m, NodeKind kind, double most) {
    const std::uint32_t execution = done_[std::size_t(m.rank)][m.node]++;
    if (kind == NodeKind::reduce && ranks_.size() > 1) return 0.0;  // what it takes is the network's
    const double s = std::min(most, recorded_s(m, execution));
    const std::string module(module_of(node(m).label));
    out_.busy_s += s, out_.busy_of[module] += s, out_.overhead_s += cluster_.task_overhead_s, ++out_.tasks;
    return s + cluster_.task_overhead_s;
  }

  /// All messages of a phase: latencies beside each other, bytes of a rank one after the other.
  void messages(const Phase& phase) {
    std::map<int, double> of_rank;
    double latency = 0.0;
    for (const Member& m : phase.members) {
      const NodeRecord& at = node(m);
      const bool skipped = skips(m);
      ++done_[std::size_t(m.rank)][m.node];
      if (at.kind != NodeKind::send || skipped) continue;
      const Wire& wire =
          cluster_.node_of(number(m.rank)) == cluster_.node_of(number(at.peer)) ? cluster_.within : cluster_.between;
      latency = std::max(latency, wire.latency_s);
      of_rank[m.rank] += double(at.bytes) / wire.bytes_per_s;
      out_.bytes += double(at.bytes), ++out_.messages;
    }
    double longest = 0.0;
    for (const auto& [rank, s] : of_rank) longest = std::max(longest, s);
    out_.wall_s += latency + longest;
  }

  std::span<const RankRun> ranks_;
  const Cluster& cluster_;
  std::vector<std::vector<std::vector<std::uint32_t>>> before_;  ///< by rank and node
  std::vector<std::vector<std::uint32_t>> done_;                 ///< executions, or entries of loops
  std::map<std::uint32_t, std::vector<Member>> bodies_;          ///< by the loop's origin
  std::map<std::uint32_t, std::vector<Phase>> phases_;
  Simulated out_;
};

}  // namespace

Simulated simulate_bulk_synchronous(std::span<const RankRun> ranks, const Cluster& cluster) {
  return BulkSynchronous(ranks, cluster).run();
}

}  // namespace spindrift::runtime
