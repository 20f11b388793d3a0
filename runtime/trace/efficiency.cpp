// The accounting behind the table. Totals come from the threads' own sums (exact, always there); how idle time divides comes from
// the records, as shares of the recorded idle time. SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/efficiency.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "runtime/trace/intervals.hpp"
#include "runtime/trace/occurrences.hpp"

namespace spindrift::runtime {

namespace {

double seconds(std::int64_t ns) { return 1e-9 * double(ns); }

/// Thread `thread` of trace `trace`.
using Lane = std::pair<std::uint32_t, std::uint16_t>;

/// What the records say about idle time. Shares are of all recorded idle time.
struct IdleShares {
  std::int64_t idle = 0, exposed = 0, partner_wait = 0;
  std::map<std::string, std::int64_t, std::less<>> before, exposed_of;  ///< by module
  std::map<Lane, std::int64_t> exposed_on, span_of;                     ///< by lane: exposed time; first to last record

  /// Part of a lane's recorded time, which is at most `wall`, that it spent idle with a message under way.
  double exposed_part(Lane lane, std::int64_t wall) const {
    const auto exposed_here = exposed_on.find(lane);
    return exposed_here == exposed_on.end() ? 0.0 : double(exposed_here->second) / double(std::min(span_of.at(lane), wall));
  }
};

/// Times of one rank's messages: under way (posted at both ends), and posted here at least.
struct MessageTimes {
  std::vector<Interval> under_way, posted;
  std::map<std::string, std::vector<Interval>, std::less<>> under_way_of;
};

std::vector<MessageTimes> message_times(std::span<const RankTrace> traces, const Occurrences& occurrences) {
  std::vector<MessageTimes> times(traces.size());
  for (const Occurrence& o : occurrences.all) {
    if (!o.is_message()) continue;
    MessageTimes& of_rank = times[o.trace];
    const Interval under_way{std::min(o.ready, o.end), o.end};
    of_rank.under_way.push_back(under_way);
    of_rank.under_way_of[std::string(module_of(traces[o.trace].nodes[o.node].label))].push_back(under_way);
    of_rank.posted.push_back({o.begin, o.end});
  }
  for (MessageTimes& of_rank : times) {
    of_rank.under_way = united(std::move(of_rank.under_way));
    of_rank.posted = united(std::move(of_rank.posted));
    for (auto& [module, intervals] : of_rank.under_way_of) intervals = united(std::move(intervals));
  }
  return times;
}

bool occupies_thread(const Record& record) {
  return record.activity == Activity::task || record.activity == Activity::idle || record.activity == Activity::poll;
}

IdleShares idle_shares(std::span<const RankTrace> traces, const Occurrences& occurrences) {
  IdleShares shares;
  const std::int64_t until = complete_until(traces);
  const auto messages = message_times(traces, occurrences);
  std::map<Lane, std::vector<const Record*>> lanes;
  for (std::uint32_t t = 0; t < traces.size(); ++t)
    for (const Record& record : traces[t].records)
      if (record.end_ns <= until && occupies_thread(record)) lanes[{t, record.thread}].push_back(&record);
  for (auto& [lane, records] : lanes) {
    const RankTrace& trace = traces[lane.first];
    std::stable_sort(records.begin(), records.end(), [](const Record* a, const Record* b) { return a->begin_ns < b->begin_ns; });
    shares.span_of[lane] = records.back()->end_ns - records.front()->begin_ns;
    std::string next = "";  // module of the task that follows; "" at the end of the run
    for (auto record = records.rbegin(); record != records.rend(); ++record) {
      if ((*record)->activity == Activity::task && (*record)->task < trace.nodes.size())
        next = module_of(trace.nodes[(*record)->task].label);
      if ((*record)->activity != Activity::idle) continue;
      const Interval idle{(*record)->begin_ns, (*record)->end_ns};
      const MessageTimes& of_rank = messages[lane.first];
      const std::int64_t exposed = overlap(idle, of_rank.under_way);
      shares.idle += idle.end - idle.begin;
      shares.before[next] += idle.end - idle.begin;
      shares.exposed += exposed;
      shares.exposed_on[lane] += exposed;
      for (const auto& [module, intervals] : of_rank.under_way_of) shares.exposed_of[module] += overlap(idle, intervals);
      shares.partner_wait += overlap(idle, of_rank.posted) - exposed;
    }
  }
  return shares;
}

/// Least wall time [ns] of each module by itself, window (replay) by window: its busiest rank's work on all of that rank's
/// threads, or its longest chain, whichever is longer.
std::map<std::string, std::int64_t, std::less<>> alone_times(std::span<const RankTrace> traces, const Occurrences& occurrences) {
  const auto paths = paths_within_modules(traces, occurrences);
  struct Window {
    std::map<std::uint32_t, std::int64_t> work;  ///< by trace
    std::int64_t path = 0;
  };
  std::map<std::pair<std::string, std::uint32_t>, Window> windows;
  for (std::size_t n = 0; n < occurrences.all.size(); ++n) {
    const Occurrence& o = occurrences.all[n];
    if (o.record == nullptr) continue;
    Window& window = windows[{std::string(module_of(traces[o.trace].nodes[o.node].label)), o.record->replay}];
    window.path = std::max(window.path, paths[n]);
    if (!o.is_message()) window.work[o.trace] += o.duration();
  }
  std::map<std::string, std::int64_t, std::less<>> alone;
  for (const auto& [of, window] : windows) {
    std::int64_t least = window.path;
    for (const auto& [trace, work] : window.work)
      least = std::max(least, work / std::max<std::int64_t>(1, std::int64_t(traces[trace].threads.size())));
    alone[of.first] += least;
  }
  return alone;
}

/// Everything that the threads' sums give.
Efficiency totals(std::span<const RankTrace> traces, Lane& busiest) {
  Efficiency e;
  std::int64_t most = -1, sum = 0, elapsed = 0;
  e.ranks = int(traces.size());
  for (std::uint32_t t = 0; t < traces.size(); ++t)
    for (std::uint16_t thread = 0; thread < traces[t].threads.size(); ++thread) {
      const ThreadTimes& times = traces[t].threads[thread];
      ++e.threads;
      sum += times.task_ns;
      elapsed = std::max(elapsed, times.wall_ns);
      e.wall_s += seconds(times.wall_ns);
      e.idle_s += seconds(times.idle_ns);
      e.poll_s += seconds(times.poll_ns);
      e.overhead_s += seconds(times.overhead_ns());
      if (times.task_ns > most) most = times.task_ns, busiest = {t, thread};
    }
  e.busy_s = seconds(sum);
  e.elapsed_s = seconds(elapsed);
  if (elapsed == 0 || most <= 0) return e;
  e.load_balance = double(sum) / double(e.threads) / double(most);
  e.communication = double(most) / double(elapsed);
  e.parallel = e.load_balance * e.communication;
  return e;
}

/// Busy time [s] and executions of each module over the whole run, from the nodes' costs.
std::map<std::string, std::pair<double, std::int64_t>, std::less<>> busy_times(std::span<const RankTrace> traces) {
  std::map<std::string, std::pair<double, std::int64_t>, std::less<>> busy;
  for (const RankTrace& trace : traces)
    for (const TraceNode& node : trace.nodes)
      if (node.kind == NodeKind::task || node.kind == NodeKind::until || node.kind == NodeKind::collective) {
        auto& [time, calls] = busy[std::string(module_of(node.label))];
        time += seconds(node.cost.total_ns), calls += std::int64_t(node.cost.count);
      }
  return busy;
}

/// First beginning to last end [ns] of the records that are complete; what lies between two runs of the graph is in it.
std::int64_t recorded_span(std::span<const RankTrace> traces) {
  std::int64_t first = RankTrace::always, last = 0;
  const std::int64_t until = complete_until(traces);
  for (const RankTrace& trace : traces)
    for (const Record& record : trace.records)
      if (record.end_ns <= until) first = std::min(first, record.begin_ns), last = std::max(last, record.end_ns);
  return std::max<std::int64_t>(0, last - first);
}

}  // namespace

Efficiency efficiency_of(std::span<const RankTrace> traces) {
  Lane busiest{};
  Efficiency e = totals(traces, busiest);
  for (const auto& [module, busy] : busy_times(traces)) e.modules.push_back({module, busy.first, busy.second});
  std::ranges::stable_sort(e.modules, [](const auto& a, const auto& b) { return a.busy_s > b.busy_s; });

  const Occurrences occurrences = occurrences_of(traces);
  const std::int64_t span = recorded_span(traces);
  if (span == 0 || e.elapsed_s == 0.0) return e;
  e.recorded = std::min(1.0, seconds(span) / e.elapsed_s);

  const IdleShares shares = idle_shares(traces, occurrences);
  const double whole = shares.idle > 0 ? e.idle_s / double(shares.idle) : 0.0;  // seconds of the run per recorded nanosecond
  const auto part = [whole](const auto& by_module, const std::string& module) {
    const auto found = by_module.find(module);
    return found == by_module.end() ? 0.0 : whole * double(found->second);
  };
  e.exposed_s = whole * double(shares.exposed);
  e.partner_wait_s = whole * double(shares.partner_wait);
  const std::int64_t wall = traces[busiest.first].threads[busiest.second].wall_ns;
  e.transfer = std::max(e.communication, 1.0 - shares.exposed_part(busiest, wall));
  e.serialisation = e.communication / e.transfer;

  const auto alone = alone_times(traces, occurrences);
  double sum_alone = 0.0;
  for (const auto& [module, time] : alone) sum_alone += double(time);
  e.overlap_gain = 1e-9 * sum_alone / std::min(seconds(span), e.elapsed_s);
  for (ModuleTimes& times : e.modules) {
    times.idle_s = part(shares.before, times.module);
    times.exposed_s = part(shares.exposed_of, times.module);
    const auto found = alone.find(times.module);
    times.alone_s = found == alone.end() ? 0.0 : seconds(found->second);
  }
  const CriticalPath path = critical_path(traces, occurrences);
  e.critical_path_s = path.seconds;
  e.critical_path = path.by_label;
  return e;
}

}  // namespace spindrift::runtime
