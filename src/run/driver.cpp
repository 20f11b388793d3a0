// SPDX-License-Identifier: Apache-2.0
#include "src/run/driver.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "runtime/executor/executor.hpp"
#include "runtime/replay/recording_file.hpp"
#include "runtime/trace/chrome.hpp"
#include "runtime/trace/trace_of.hpp"
#include "src/io/build_info.hpp"
#include "src/io/collective.hpp"
#include "src/io/fields.hpp"
#include "src/io/progress.hpp"
#include "src/run/flow_simulation.hpp"
#include "src/run/outputs.hpp"
#include "src/run/system_simulation.hpp"

namespace spindrift::run {

Driver::Driver(const io::RunDirectory& directory, const runtime::Parts& parts, const RunSettings& settings,
               runtime::StopRequest& stop)
    : directory_(directory), parts_(parts), settings_(settings), stop_(stop), ledger_(settings.records(), settings.threads) {
  if (!settings.trace || settings.windows) ledger_.pause();
}

runtime::Ledger::Keep RunSettings::keep(std::int64_t window) const {
  using Keep = runtime::Ledger::Keep;
  const auto in = [window](const auto& range) { return window >= range.first && window <= range.second; };
  if ((keep_runs || !record_graph.empty()) && in(windows.value_or(usual_windows))) return Keep::runs;
  return trace && (!windows || in(*windows)) ? Keep::records : Keep::nothing;
}

io::Summary Driver::run(Simulation& simulation) {
  const runtime::Phase output("output");  // all that has no phase of its own
  const MPI_Comm comm = parts_.world().comm;
  const coupling::Timeline& timeline = simulation.timeline();
  io::History history;
  simulation.declare(history);
  Checkpoints checkpoints(simulation, directory_, history, comm);
  const std::int64_t first = [&] {
    const runtime::Phase start("start-up");
    return settings_.restart ? checkpoints.resume() : simulation.begin(directory_);
  }();
  // A start that was cut short is not the one that the scene asks for.
  if (!settings_.restart && !stop_.agreed(comm).empty()) throw runtime::StopAsked();
  if (settings_.restart) spdlog::info("restart from t = {:.12g} s", timeline.window_end_s(first));
  std::int64_t window = first, last = last_window(timeline);
  if (const std::string settled = simulation.settled(); !settled.empty() && !settings_.changed && first <= last) {
    last = first;
    summary_.exit_reason = "done: nothing was left to do: " + settled;
  }
  if (settings_.restart && last <= first) simulation.nothing_left();
  history.keep_statistics(mean_ranges(simulation.scenario().output, timeline.window_end_s(last)));
  open_history(history, timeline.window_end_s(first), checkpoints.rows(), first < last);
  if (settings_.began) settings_.began();
  HistoryOutput rows(simulation, history);
  ProgressOutput progress(timeline, first, last, io::progress_style(parts_.world().rank, settings_.quiet),
                          simulation.counts_pseudo_steps());
  const std::vector<std::unique_ptr<Output>> fields =
      simulation.outputs(directory_, settings_.restart ? timeline.window_end_s(first) : io::from_the_start);
  std::vector<Output*> outputs{&rows, &checkpoints, &progress};  // files for people last: they may fail
  for (const auto& output : fields) outputs.push_back(output.get());
  if (settings_.restart)
    for (Output* output : outputs) output->resume(first);
  else
    begin_outputs(outputs, simulation, first);

  while (window < last && summary_.exit_code == 0) {
    ledger_.begin_window(window + 1, settings_.keep(window + 1));
    const Advance advance = [&] {
      const runtime::Phase windows("windows");
      return simulation.advance(window, last);
    }();
    ledger_.end_window();
    write_rest(simulation);  // for what could not be written beside the window, which is told here

    const std::int64_t now = window + advance.windows;
    const Windows done{window, now, advance.settled.empty() ? std::max(last, now) : now};
    window = done.now, last = done.last;
    if (!advance.settled.empty()) summary_.exit_reason = "done: " + advance.settled;
    for (Output* output : outputs) take_if_due(*output, done);
    stop_.keep_margin(2.0 * checkpoints.cost_s());
    if (!advance.failure.empty())
      fail(advance.failure);
    else if (const std::string why = stop_.agreed(comm); !why.empty() && window < last)
      end_early(why);
  }
  if (summary_.exit_code == 0 && summary_.exit_reason.empty() && window == timeline.windows())
    if (const std::string failure = simulation.failure_at_end(); !failure.empty()) fail(failure);
  finish_outputs(outputs, simulation, window);

  if (summary_.exit_reason.empty())
    summary_.exit_reason =
        last < first ? fmt::format("nothing was left to do: the run had come to t = {:.12g} s, and was asked to go to {:.12g} s",
                                   timeline.window_end_s(first), timeline.window_end_s(last))
        : last < timeline.windows() ? fmt::format("done until t = {:.12g} s as asked", timeline.window_end_s(last))
                                    : simulation.done();
  summary_.restarts = checkpoints.restarts();
  summary_.columns = history.columns();
  if (summary_.exit_code == 0 && window == last_window(timeline)) summary_.statistics = history.statistics();
  summarise(simulation, first, window);
  return summary_;
}

void Driver::begin_outputs(const std::vector<Output*>& outputs, Simulation& simulation, std::int64_t window) const {
  for (Output* output : outputs) {
    const runtime::Span span(output->label());
    output->begin(window);
  }
  write_rest(simulation);  // before what settled is forgotten
  directory_.forget_settling(parts_.world().comm);
}

void Driver::finish_outputs(const std::vector<Output*>& outputs, Simulation& simulation, std::int64_t window) {
  for (Output* output : outputs) {
    const runtime::Span span(output->label());
    output->finish(window);
  }
  write_rest(simulation);
}

void Driver::summarise(Simulation& simulation, std::int64_t first, std::int64_t window) {
  const coupling::Timeline& timeline = simulation.timeline();
  summary_.start_time_s = timeline.window_end_s(first), summary_.end_time_s = timeline.window_end_s(window);
  summary_.window_s = timeline.window_s();
  summary_.pseudo_steps = simulation.counts_pseudo_steps();
  summary_.counts = {{"windows", window - first}};
  summary_.ranks = parts_.world().size;
  simulation.summarise(summary_, ledger_);
  if (settings_.trace && settings_.windows && (settings_.windows->first > window || settings_.windows->second <= first))
    spdlog::warn("none of the windows {}:{} ran, of which a trace was asked for: windows {}:{} did", settings_.windows->first,
                 settings_.windows->second, first + 1, window);
  describe_times();
}

void Driver::write_rest(Simulation& simulation) {
  const runtime::Span span("output/rest");
  simulation.output().write_now();
}

void Driver::take_if_due(Output& output, const Windows& done) {
  if (!output.due(done)) return;
  const runtime::Span span(output.label());
  output.take(done);
}

std::int64_t Driver::last_window(const coupling::Timeline& timeline) const {
  if (!settings_.until_s) return timeline.windows();
  const auto windows = std::int64_t(std::ceil(*settings_.until_s / timeline.window_s() * (1.0 - 1e-12)));
  return std::min<std::int64_t>(windows, timeline.windows());
}

/// A new file on rank 0, or that of the run that goes on at `time_s`, or has come to its end there. Collective; throws on all
/// ranks alike.
void Driver::open_history(io::History& history, double time_s, const std::optional<io::History::Extent>& written,
                          bool goes_on) const {
  io::on_root(parts_.world().comm, [&] {
    if (settings_.restart)
      history.resume(directory_.history(), time_s, settings_.accept_history ? std::nullopt : written, goes_on);
    else
      history.open(directory_.history());
  });
}

/// Numerical failure: data, not an exception.
void Driver::fail(const std::string& failure) {
  summary_.exit_code = 3;
  summary_.exit_reason = failure;
  summary_.numerical_trouble.push_back(failure);
}

void Driver::end_early(const std::string& why) {
  summary_.exit_code = 5;
  summary_.exit_reason = why;
}

/// Where the core-seconds of all ranks went, from the ledger: into the summary by part, into the log as a table, and to
/// trace.json.gz where asked for. What needs the records comes last: it takes the most memory. Collective.
void Driver::describe_times() {
  const runtime::Phase phase("sums and records");
  const runtime::World& world = parts_.world();
  ledger_.close();
  const runtime::RankTrace sums = ledger_.sums(world.rank);
  summary_.wall_seconds = 1e-9 * double(sums.threads[0].wall_ns);
  summary_.threads = int(sums.threads.size());
  const double processor_s = runtime::summed(world.comm, {runtime::processor_seconds() - processor_s_})[0];
  traces_ = gather_traces(sums, world.comm);
  runtime::Efficiency of_sums;
  if (world.rank == 0) {
    of_sums = efficiency_of(traces_);
    double at_work_s = of_sums.busy_s;  // without what may wait for a disk
    for (const runtime::ModuleTimes& module : of_sums.modules)
      if (module.module == "output" || module.module == "start-up") at_work_s -= module.busy_s;
    processor_share_ = runtime::processor_share(processor_s, at_work_s);
    add_factors(
        {{"parallel efficiency", of_sums.parallel, "useful core-seconds over all core-seconds; load balance x communication"},
         {"load balance", of_sums.load_balance, "mean over largest useful time of a thread"},
         {"communication efficiency", of_sums.communication, "largest useful time of a thread over elapsed time"}});
    add_parts(of_sums);
  }
  if (!settings_.record_graph.empty()) write_recording();
  const auto records = std::int64_t(runtime::summed(world.comm, {double(ledger_.records())})[0]);
  if (world.rank == 0 && (records == 0 || records > settings_.most_in_table)) spdlog::info("{}", efficiency_table(of_sums));
  if (const std::string told = runtime::told_share(processor_share_); world.rank == 0 && !told.empty()) spdlog::info("{}", told);
  if (records == 0) return;
  if (settings_.ended) settings_.ended(summary_);
  read_records(records);
}

void Driver::read_records(std::int64_t records) {
  const runtime::World& world = parts_.world();
  const bool makes_table = records <= settings_.most_in_table;
  if (makes_table || settings_.trace || settings_.keep_runs) {
    runtime::RankTrace own = ledger_.trace(world.rank);
    for (runtime::TraceNode& node : own.nodes)  // a side's tasks count its own ranks
      if (node.peer >= 0) node.peer += world.rank - parts_.mine().rank;
    traces_ = gather_traces(std::move(own), world.comm);
  }
  if (world.rank != 0) return;
  if (makes_table) {
    const runtime::Efficiency e = efficiency_of(traces_);
    add_factors({{"serialisation efficiency", e.serialisation, "what dependencies leave on an ideal network"},
                 {"transfer efficiency", e.transfer, "what moving data leaves"}});
    spdlog::info("{}", efficiency_table(e));
  } else {
    spdlog::warn(
        "the table of efficiency is without dependencies: it reads at most {} records, of which there are {}; --windows keeps "
        "fewer{}",
        settings_.most_in_table, records,
        settings_.record_graph.empty() ? "" : fmt::format(", and spindrift replay {} has them", settings_.record_graph));
  }
  if (settings_.trace) write_chrome_trace(traces_, directory_.trace().string());
}

/// Those that are known.
void Driver::add_factors(const std::vector<io::Efficiency>& factors) {
  for (const io::Efficiency& factor : factors)
    if (std::isfinite(factor.value)) summary_.efficiency.push_back(factor);
}

void Driver::add_parts(const runtime::Efficiency& e) {
  double known_s = 0.0;
  const auto add = [&](const std::string& name, double core_s, std::int64_t calls) {
    summary_.parts.push_back({name, core_s / e.threads, core_s, calls});
    known_s += core_s;
  };
  for (const runtime::ModuleTimes& module : e.modules) add(module.module, module.busy_s, module.calls);
  add("waiting", e.idle_s, 0), add("messages", e.poll_s, 0);
  add("runtime", std::max(0.0, e.wall_s - known_s), 0);  // what the threads had besides: task graph, priorities, teams
}

void Driver::write_recording() const {
  const runtime::World& world = parts_.world();
  runtime::Recording own{.scene = settings_.scene, .program = io::build_info().version, .threads = summary_.threads};
  own.windows = ledger_.windows();
  own.ranks.push_back(ledger_.recording(world.rank));
  if (own.windows.empty()) spdlog::warn("no window of those to be recorded ran: {} holds none", settings_.record_graph);
  runtime::write_recording(own, settings_.record_graph, world.comm);
}

io::Summary run(coupling::FloatingSystem& floating, const coupling::Start& start, const io::RunDirectory& directory,
                const runtime::Parts& parts, const RunSettings& settings, runtime::StopRequest& stop) {
  Driver driver(directory, parts, settings, stop);
  SystemSimulation simulation(floating, start.state, parts, settings.records());
  return driver.run(simulation);
}

io::Summary run_flow(const coupling::Scenario& scenario, const io::RunDirectory& directory, const runtime::Parts& parts,
                     const RunSettings& settings, runtime::StopRequest& stop) {
  Driver driver(directory, parts, settings, stop);
  FlowSimulation simulation(scenario, directory, parts.world(), settings.records());
  return driver.run(simulation);
}

}  // namespace spindrift::run
