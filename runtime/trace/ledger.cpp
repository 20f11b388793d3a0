// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/ledger.hpp"

#include <omp.h>

#include <algorithm>
#include <span>
#include <utility>

#include "runtime/executor/worker.hpp"
#include "runtime/replay/recorder.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/trace_of.hpp"

namespace spindrift::runtime {

namespace {

Ledger* active = nullptr;

void widen(std::vector<ThreadTimes>& threads, std::size_t count) {
  if (threads.size() < count) threads.resize(count);
}

template <class T>
void append(std::vector<T>& to, std::vector<T> more) {
  if (to.empty())
    to = std::move(more);
  else
    to.insert(to.end(), more.begin(), more.end());
}

/// Of all threads.
ThreadTimes sum_of(const Team& team) {
  ThreadTimes sum;
  for (const auto& worker : team.workers) {
    const ThreadTimes& times = worker->times;
    sum.wall_ns += times.wall_ns, sum.task_ns += times.task_ns, sum.idle_ns += times.idle_ns, sum.poll_ns += times.poll_ns;
  }
  return sum;
}

}  // namespace

Ledger::Ledger(std::size_t records, int threads) : begin_ns_(Clock::now_ns()), capacity_(records) {
  widen(gone_.trace.threads, std::size_t(threads > 0 ? threads : omp_get_max_threads()));
  active = this;
}
Ledger::~Ledger() { active = nullptr; }
Ledger* Ledger::current() { return active; }

void Ledger::opened(const Team& team) { live_.push_back({&team}); }

Ledger::Live* Ledger::live(const Team& team) {
  const auto found = std::ranges::find(live_, &team, &Live::team);
  return found == live_.end() ? nullptr : &*found;
}

void Ledger::closed(const Team& team) {
  const Live* found = live(team);
  if (!found) return;
  add(gone_, trace_of(team), found->wall_ns), add(recorded_, *found);
  live_.erase(live_.begin() + (found - live_.data()));
}

void Ledger::starts(const Team& team) {
  if (Live* of = live(team)) of->before = sum_of(team), of->replays = team.program.loops[0].base;
}

void Ledger::ran(const Team& team, std::int64_t begin_ns, std::int64_t ns) {
  if (!open_.empty()) open_.back().inner_ns += ns;
  Live* const of = live(team);
  if (!of) return;
  of->wall_ns += ns;
  if (keep_ != Keep::runs || !in_window_ || team.failure) return;
  const ThreadTimes now = sum_of(team);
  const std::int64_t task = now.task_ns - of->before.task_ns, idle = now.idle_ns - of->before.idle_ns,
                     poll = now.poll_ns - of->before.poll_ns;
  RunRecord& run = of->runs.emplace_back();
  run.window = windows_.back().number, run.replays = team.program.loops[0].base - of->replays;
  run.begin_ns = begin_ns, run.wall_ns = ns;
  run.task_ns = task, run.idle_ns = idle, run.poll_ns = poll;
  run.overhead_ns = ns * std::int64_t(team.workers.size()) - task - idle - poll;
  of->replay.push_back(of->replays);
}

void Ledger::begin_window(std::int64_t number, Keep keep) {
  keep_ = keep, in_window_ = true;
  if (keep == Keep::runs) windows_.push_back({number, 0});
  window_begin_ns_ = Clock::now_ns();
}

void Ledger::end_window() {
  in_window_ = false;
  if (keep_ == Keep::runs) windows_.back().wall_ns = Clock::now_ns() - window_begin_ns_;
}

void Ledger::on_all(std::int64_t ns) {
  if (keep_ == Keep::runs && in_window_) windows_.back().on_all_ns += ns;
}

void Ledger::add(RankRecording& to, const Live& live) {
  std::vector<RunRecord> runs = live.runs;
  std::vector<std::uint32_t> replay = live.replay;
  fill_runs(*live.team, replay, runs);
  if (runs.empty()) return;
  for (RunRecord& run : runs) run.graph = std::uint32_t(to.graphs.size()), to.runs.push_back(std::move(run));
  to.graphs.push_back(graph_record(*live.team));
}

RankRecording Ledger::recording(int rank) const {
  RankRecording all = recorded_;
  for (const Live& live : live_) add(all, live);
  std::ranges::stable_sort(all.runs, {}, &RunRecord::begin_ns);
  all.rank = rank;
  return all;
}

void Ledger::move(std::string_view from, std::string_view label, std::int64_t ns, std::int64_t count) {
  Move& move = moves_[std::string(label)];
  move.from = from, move.cost.ns += ns, move.cost.count += std::uint64_t(count);
}

/// Nodes of its graph join those alike; its threads' times are brought to the wall time of its runs as seen from outside.
void Ledger::add(Merged& to, RankTrace own, std::int64_t wall_ns) {
  std::vector<std::uint32_t> as(own.nodes.size());
  std::map<Key, std::uint32_t> seen;
  for (std::uint32_t n = 0; n < own.nodes.size(); ++n) {
    TraceNode& node = own.nodes[n];
    if (node.loop != no_node) node.loop = as[node.loop];
    Key key{node.kind, node.loop, node.label, node.peer, node.tag, 0};
    std::get<5>(key) = seen[key]++;
    const auto [at, is_new] = to.nodes.emplace(std::move(key), std::uint32_t(to.trace.nodes.size()));
    as[n] = at->second;
    if (is_new)
      to.trace.nodes.push_back(std::move(node));
    else
      to.trace.nodes[as[n]].cost.total_ns += node.cost.total_ns, to.trace.nodes[as[n]].cost.count += node.cost.count;
  }
  if (!own.records.empty()) {
    const auto key = [](const Edge& e) { return std::tuple(e.from, e.to, e.distance); };
    for (Edge& e : own.edges) e.from = as[e.from], e.to = as[e.to];
    std::vector<Edge> known = to.trace.edges;
    std::ranges::sort(known, {}, key);
    std::erase_if(own.edges, [&](const Edge& e) { return std::ranges::binary_search(known, key(e), {}, key); });
    append(to.trace.edges, std::move(own.edges));
    std::uint32_t replays = 0;
    for (Record& record : own.records) {
      if (record.task < as.size()) record.task = as[record.task];
      replays = std::max(replays, record.replay + 1);
      record.replay += to.replays;
    }
    append(to.trace.records, std::move(own.records));
    to.replays += replays;
  }
  to.trace.complete_until = std::min(to.trace.complete_until, own.complete_until);
  widen(to.trace.threads, own.threads.size());
  for (std::size_t t = 0; t < to.trace.threads.size(); ++t) {
    ThreadTimes& times = to.trace.threads[t];
    times.wall_ns += wall_ns;
    if (t >= own.threads.size()) {
      times.idle_ns += wall_ns;
      continue;
    }
    times.task_ns += own.threads[t].task_ns, times.idle_ns += own.threads[t].idle_ns, times.poll_ns += own.threads[t].poll_ns;
    times.tasks += own.threads[t].tasks, times.steals += own.threads[t].steals;
  }
}

RankTrace Ledger::trace(int rank) const {
  Merged all = gone_;
  for (const Live& live : live_) add(all, trace_of(*live.team), live.wall_ns);
  return whole(std::move(all.trace), rank, true);
}

RankTrace Ledger::sums(int rank) const {
  Merged all{.trace = by_module(gone_.trace), .nodes = {}, .replays = 0};
  for (const Live& live : live_) add(all, by_module(*live.team), live.wall_ns);
  return by_module(whole(std::move(all.trace), rank, false));
}

std::size_t Ledger::records() const {
  std::size_t sum = gone_.trace.records.size() + records_.size();
  for (const Live& live : live_)
    for (const auto& worker : live.team->workers) sum += worker->records.records().size();
  return sum;
}

void Ledger::close() { end_ns_ = Clock::now_ns(); }

RankTrace Ledger::whole(RankTrace trace, int rank, bool with_records) const {
  trace.rank = rank;
  std::int64_t known_ns = trace.threads[0].wall_ns;
  const auto serial = [&](std::int64_t ns, bool waits) {
    for (std::size_t t = 0; t < trace.threads.size(); ++t) {
      trace.threads[t].wall_ns += ns;
      (t == 0 && !waits ? trace.threads[t].task_ns : trace.threads[t].idle_ns) += ns;
    }
    known_ns += ns;
  };
  std::map<std::string, std::uint32_t, std::less<>> node_of;
  const auto add_span = [&](const std::string& label, const Cost& cost) {
    node_of[label] = std::uint32_t(trace.nodes.size());
    trace.nodes.push_back({.label = label, .cost = {cost.ns, cost.count}});
  };
  for (const auto& [label, cost] : spans_) add_span(label, cost), serial(cost.ns, false);
  for (const auto& [label, cost] : waits_) serial(cost.ns, true);
  // What nobody named: between spans and runs of executors.
  const std::int64_t rest = std::max<std::int64_t>(0, end_ns_.value_or(Clock::now_ns()) - begin_ns_ - known_ns);
  add_span("run/other", {rest, 1}), serial(rest, false);
  std::uint32_t replay = 1u << 31;  // a window of its own for each
  for (const SpanRecord& span : with_records ? std::span<const SpanRecord>(records_) : std::span<const SpanRecord>()) {
    const auto node = node_of.find(span.label);
    trace.records.push_back({span.begin_ns, span.end_ns, node == node_of.end() ? no_task : node->second, replay++, 0, 0, 0,
                             node == node_of.end() ? Activity::idle : Activity::task});
  }
  for (const auto& [label, move] : moves_) {
    std::int64_t left = move.cost.ns;
    for (TraceNode& node : trace.nodes) {
      if (node.kind != NodeKind::task || module_of(node.label) != move.from) continue;
      const std::int64_t taken = std::min(left, node.cost.total_ns);
      node.cost.total_ns -= taken, left -= taken;
    }
    trace.nodes.push_back({.label = label, .cost = {move.cost.ns - left, move.cost.count}});
  }
  return trace;
}

void Ledger::enter(std::string_view label) { open_.push_back({std::string(label), Clock::now_ns()}); }

void Ledger::leave(bool waits) {
  OpenSpan span = std::move(open_.back());
  open_.pop_back();
  const std::int64_t end_ns = Clock::now_ns(), ns = end_ns - span.begin_ns;
  Cost& cost = (waits ? waits_ : spans_)[span.label];
  cost.ns += ns - span.inner_ns, ++cost.count;
  if (keeps_records() && records_.size() < capacity_) records_.push_back({std::move(span.label), span.begin_ns, end_ns});
  if (!open_.empty()) open_.back().inner_ns += ns;
}

Span::Span(std::string_view label, Kind kind) : ledger_(Worker::current() ? nullptr : active), kind_(kind) {
  if (ledger_) ledger_->enter(label);
}

Span::~Span() {
  if (ledger_) ledger_->leave(kind_ == Kind::wait);
}

void Ledger::enter_phase(std::string_view name) { open_phases_.push_back({std::string(name), Clock::now_ns()}); }

void Ledger::leave_phase() {
  const OpenSpan phase = std::move(open_phases_.back());
  open_phases_.pop_back();
  const std::int64_t ns = Clock::now_ns() - phase.begin_ns;
  phases_[phase.label] += ns - phase.inner_ns;
  if (!open_phases_.empty()) open_phases_.back().inner_ns += ns;
}

Phase::Phase(std::string_view name) : ledger_(active) {
  if (ledger_) ledger_->enter_phase(name);
}

Phase::~Phase() {
  if (ledger_) ledger_->leave_phase();
}

}  // namespace spindrift::runtime
