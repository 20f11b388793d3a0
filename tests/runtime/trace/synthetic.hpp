// Traces written by hand, in microseconds, for tests with answers that can be worked out on paper.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime::testing {

class SyntheticRank {
 public:
  explicit SyntheticRank(int rank, int threads = 1) {
    trace_.rank = rank;
    trace_.threads.resize(threads);
  }

  std::uint32_t node(std::string label, NodeKind kind = NodeKind::task, std::uint32_t loop = no_node) {
    trace_.nodes.push_back({std::move(label), kind, loop});
    return std::uint32_t(trace_.nodes.size() - 1);
  }
  std::uint32_t message(std::string label, NodeKind kind, int peer, int tag, std::uint32_t loop = no_node) {
    const std::uint32_t n = node(std::move(label), kind, loop);
    trace_.nodes[n].peer = peer, trace_.nodes[n].tag = tag;
    return n;
  }
  void edge(std::uint32_t from, std::uint32_t to, std::uint8_t distance = 0) { trace_.edges.push_back({from, to, distance}); }

  void ran(std::uint32_t node, double begin_us, double end_us, int thread = 0, std::uint32_t replay = 0,
           std::uint32_t iteration = 0) {
    static constexpr Activity of_kind[] = {Activity::task, Activity::send, Activity::receive, Activity::reduce,
                                           Activity::task, Activity::task, Activity::task};
    const Activity activity = of_kind[int(trace_.nodes[node].kind)];
    record(node, begin_us, end_us, thread, activity, replay, iteration);
    trace_.nodes[node].cost.total_ns += ns(end_us) - ns(begin_us);
    ++trace_.nodes[node].cost.count;
    if (activity == Activity::task) trace_.threads[thread].task_ns += ns(end_us) - ns(begin_us);
  }
  void idle(double begin_us, double end_us, int thread = 0) {
    record(no_task, begin_us, end_us, thread, Activity::idle, 0, 0);
    trace_.threads[thread].idle_ns += ns(end_us) - ns(begin_us);
  }

  /// The trace of a run in which every thread was inside the graph for `wall_us`.
  RankTrace trace(double wall_us) const {
    RankTrace out = trace_;
    for (ThreadTimes& times : out.threads) times.wall_ns = ns(wall_us);
    return out;
  }

 private:
  static std::int64_t ns(double us) { return std::int64_t(us * 1000.0 + 0.5); }
  void record(std::uint32_t node, double begin_us, double end_us, int thread, Activity activity, std::uint32_t replay,
              std::uint32_t iteration) {
    trace_.records.push_back({ns(begin_us), ns(end_us), node, replay, iteration, 64, std::uint16_t(thread), activity});
  }
  RankTrace trace_;
};

/// Two ranks: `a` on rank 0 feeds `b` on rank 1 through a message that both ends wait for. In microseconds:
/// rank 0: a 0-4, send 4-5, idle 4-12; rank 1: receive posted 0, complete 7, idle 0-7, b 7-12.
inline std::vector<RankTrace> one_message() {
  SyntheticRank left(0), right(1);
  const auto a = left.node("aero/a"), send = left.message("aero/send", NodeKind::send, 1, 5);
  left.edge(a, send);
  left.ran(a, 0, 4), left.ran(send, 4, 5), left.idle(4, 12);
  const auto receive = right.message("aero/receive", NodeKind::receive, 0, 5), b = right.node("sea/b");
  right.edge(receive, b);
  right.ran(receive, 0, 7), right.idle(0, 7), right.ran(b, 7, 12);
  return {left.trace(12), right.trace(12)};
}

}  // namespace spindrift::runtime::testing
