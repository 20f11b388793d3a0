// Which execution of a predecessor an execution waited for: the last one that ended before it began. That is exact where nodes
// are ordered by data (two executions of the predecessor cannot both fit in between, because the second waits for this one).
// Loops: what follows a loop waits for all of its nodes, what is in its first iteration for all that the loop waits for. A
// beginning or end that stands for them keeps the number of joins at nodes + nodes instead of nodes x nodes.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/occurrences.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

namespace spindrift::runtime {

namespace {

/// Joins the occurrences of one rank by walking through its records in time.
class RankWalk {
 public:
  RankWalk(const RankTrace& trace, std::uint32_t index, Occurrences& out)
      : trace_(trace),
        index_(index),
        out_(out),
        before_of_node_(trace.nodes.size()),
        members_(trace.nodes.size()),
        state_(trace.nodes.size()) {
    for (const Edge& edge : trace.edges) before_of_node_[edge.to].push_back(edge.from);
    for (std::uint32_t n = 0; n < trace.nodes.size(); ++n)
      if (trace.nodes[n].loop != no_node) members_[trace.nodes[n].loop].push_back(n);
  }

  void run(std::int64_t until) {
    std::vector<const Record*> records;
    std::size_t joins = 0;
    for (const Record& record : trace_.records)
      if (record.task < trace_.nodes.size() && record.end_ns <= until)
        records.push_back(&record), joins += before_of_node_[record.task].size() + 1;
    // A vector that grows by itself takes three times its size while it does.
    out_.all.reserve(out_.all.size() + records.size() + records.size() / 16);
    out_.before.reserve(out_.before.size() + joins + joins / 16);
    std::stable_sort(records.begin(), records.end(), [](const Record* a, const Record* b) {
      return std::pair(a->begin_ns, a->end_ns) < std::pair(b->begin_ns, b->end_ns);
    });
    using Ending = std::pair<std::int64_t, std::uint32_t>;
    std::priority_queue<Ending, std::vector<Ending>, std::greater<>> running;
    for (const Record* record : records) {
      for (; !running.empty() && running.top().first <= record->begin_ns; running.pop()) finish(running.top().second);
      running.emplace(record->end_ns, begin(*record));
    }
  }

 private:
  struct NodeState {
    std::uint32_t last = no_occurrence;        ///< last execution that ended; of a loop: its end, if that is up to date
    std::uint32_t loop_begin = no_occurrence;  ///< of a loop: its beginning
    std::uint32_t entries = 0;                 ///< of the loop round it that it has run in; of a loop: that have a beginning
    bool changed = false;                      ///< of a loop: something in it ended since `last`
  };

  void finish(std::uint32_t occurrence) {
    const std::uint32_t node = out_.all[occurrence].node;
    state_[node].last = occurrence;
    for (std::uint32_t loop = trace_.nodes[node].loop; loop != no_node; loop = trace_.nodes[loop].loop)
      state_[loop].changed = true;
  }

  std::uint32_t begin(const Record& record) {
    std::vector<std::uint32_t> before;
    for (const std::uint32_t node : before_of_node_[record.task]) add(before, latest(node));
    const std::uint32_t loop = trace_.nodes[record.task].loop;
    if (loop != no_node && record.iteration == 0) add(before, beginning_of_entry(loop, ++state_[record.task].entries));
    if (record.iteration > 0) add(before, state_[record.task].last);
    return append({index_, record.task, &record, record.begin_ns, record.end_ns, record.begin_ns}, before);
  }

  static void add(std::vector<std::uint32_t>& before, std::uint32_t occurrence) {
    if (occurrence != no_occurrence) before.push_back(occurrence);
  }

  std::uint32_t append(Occurrence occurrence, const std::vector<std::uint32_t>& before) {
    occurrence.first_before = std::uint32_t(out_.before.size());
    out_.before.insert(out_.before.end(), before.begin(), before.end());
    occurrence.last_before = std::uint32_t(out_.before.size());
    out_.all.push_back(occurrence);
    return std::uint32_t(out_.all.size() - 1);
  }

  /// Stands for all of `before`, at the time the last of them ended.
  std::uint32_t append_joint(std::uint32_t node, const std::vector<std::uint32_t>& before) {
    if (before.empty()) return no_occurrence;
    std::int64_t time = 0;
    for (const std::uint32_t o : before) time = std::max(time, out_.all[o].end);
    return append({index_, node, nullptr, time, time, time}, before);
  }

  /// Last execution of a node that ended; of a loop, its end.
  std::uint32_t latest(std::uint32_t node) {
    NodeState& state = state_[node];
    if (!state.changed) return state.last;
    std::vector<std::uint32_t> before;
    for (const std::uint32_t member : members_[node]) add(before, latest(member));
    state.changed = false;
    return state.last = append_joint(node, before);
  }

  /// One for all nodes of the loop: what it waits for had ended before the first of them began. Sought again for each, in a loop
  /// that waits for its own run before, it would be all nodes that have ended since, for all nodes.
  std::uint32_t beginning_of_entry(std::uint32_t loop, std::uint32_t entry) {
    if (entry <= state_[loop].entries) return state_[loop].loop_begin;
    const std::uint32_t begin = beginning(loop);
    state_[loop].entries = entry;
    return begin;
  }

  /// All that a loop waits for, with what the loops round it wait for.
  std::uint32_t beginning(std::uint32_t loop) {
    std::vector<std::uint32_t> before;
    for (const std::uint32_t node : before_of_node_[loop]) add(before, latest(node));
    if (trace_.nodes[loop].loop != no_node) add(before, beginning(trace_.nodes[loop].loop));
    std::uint32_t& known = state_[loop].loop_begin;
    if (known != no_occurrence && std::ranges::equal(out_.before_of(out_.all[known]), before)) return known;
    return known = append_joint(loop, before);
  }

  const RankTrace& trace_;
  std::uint32_t index_;
  Occurrences& out_;
  std::vector<std::vector<std::uint32_t>> before_of_node_, members_;
  std::vector<NodeState> state_;
};

/// Which message of which execution: sender, receiver and tag (or the reduction's label), replay, iteration.
using Key = std::tuple<int, int, int, std::string_view, std::uint32_t, std::uint32_t>;

void join_messages(std::span<const RankTrace> traces, Occurrences& out) {
  // An inner loop numbers its iterations anew at each entry, so a key may recur: the n-th of one side meets the n-th of the
  // other.
  std::map<std::pair<Key, std::uint32_t>, std::vector<std::uint32_t>> meeting;
  std::map<std::tuple<Key, std::uint32_t, Activity>, std::uint32_t> count;
  for (std::uint32_t o = 0; o < out.all.size(); ++o) {
    const Occurrence& message = out.all[o];
    if (!message.is_message()) continue;
    const RankTrace& trace = traces[message.trace];
    const TraceNode& node = trace.nodes[message.node];
    const bool sends = message.record->activity == Activity::send, reduces = message.record->activity == Activity::reduce;
    Key key{sends ? trace.rank : node.peer, sends ? node.peer : trace.rank, node.tag, {},
            message.record->replay,         message.record->iteration};
    if (reduces) key = {-1, -1, -1, node.label, message.record->replay, message.record->iteration};
    meeting[{key, count[{key, message.trace, message.record->activity}]++}].push_back(o);
  }
  for (const auto& [key, ends] : meeting) {
    std::int64_t ready = 0;
    for (const std::uint32_t o : ends) ready = std::max(ready, out.all[o].begin);
    for (const std::uint32_t o : ends) {
      Occurrence& message = out.all[o];
      message.first_partner = std::uint32_t(out.partners.size());
      // An eager send ends whenever it likes: it waits for nobody, and nobody's clock may move its beginning.
      if (message.record->activity != Activity::send) {
        message.ready = std::max(message.begin, ready);
        for (const std::uint32_t other : ends)
          if (other != o) out.partners.push_back(other);
      }
      message.last_partner = std::uint32_t(out.partners.size());
    }
  }
}

}  // namespace

std::string family_of(std::string_view label) {
  std::string family;
  while (!label.empty()) {
    const std::string_view part = label.substr(0, label.find('/'));
    if (part.find_first_not_of("0123456789-") != std::string_view::npos) {
      if (!family.empty()) family += '/';
      family += part;
    }
    label.remove_prefix(std::min(part.size() + 1, label.size()));
  }
  return family;
}

std::int64_t complete_until(std::span<const RankTrace> traces) {
  std::int64_t until = RankTrace::always;
  for (const RankTrace& trace : traces) until = std::min(until, trace.complete_until);
  return until;
}

Occurrences occurrences_of(std::span<const RankTrace> traces) {
  Occurrences out;
  const std::int64_t until = complete_until(traces);
  for (std::uint32_t t = 0; t < traces.size(); ++t) RankWalk(traces[t], t, out).run(until);
  join_messages(traces, out);
  return out;
}

}  // namespace spindrift::runtime
