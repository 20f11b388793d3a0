// The driver of every run: windows from the start (or a checkpoint) to the end, after each of them the outputs that are due,
// requests to stop, and numerical failure. Called by src/app; tested in tests/src/coupling and tests/coupled.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/mpi/parts.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/ledger.hpp"
#include "runtime/trace/processor_share.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/io/history.hpp"
#include "src/io/run_directory.hpp"
#include "src/io/summary.hpp"
#include "src/run/simulation.hpp"

namespace spindrift::run {

struct RunSettings {
  std::optional<double> until_s;  ///< stop there, with a checkpoint, to be continued by restart
  bool restart = false;           ///< from the newest checkpoint of the directory
  bool changed = false;           ///< the scene since, so that what had settled goes on
  bool trace = false;
  bool quiet = false;           ///< no progress
  int threads = 0;              ///< of this rank; 0: those of OpenMP
  bool accept_history = false;  ///< a restart goes on with rows of history.csv missing or changed
  std::string scene;            ///< its file, for recordings
  std::string record_graph;     ///< file of the recording; empty: none
  bool keep_runs = false;       ///< in the ledger, without a file
  std::function<void()> began;  ///< called once the first state is there and rows follow
  /// Called with all but what the records say, before they are read. Only of runs that keep some. Collective.
  std::function<void(const io::Summary&)> ended;
  /// Windows that trace and recording take down; without: all into the trace, usual_windows into the recording.
  std::optional<std::pair<std::int64_t, std::int64_t>> windows;
  static constexpr std::pair<std::int64_t, std::int64_t> usual_windows{3, 12};  // costs and priorities have settled
  /// The table of efficiency is made of so many records at most, on all ranks: it takes memory for each.
  std::int64_t most_in_table = 4'000'000;
  /// Of the trace, per thread.
  std::size_t records() const { return trace || keep_runs || !record_graph.empty() ? std::size_t(1) << 20 : 0; }
  /// What the window of this number (the first after t = 0 is 1) leaves.
  runtime::Ledger::Keep keep(std::int64_t window) const;
};

class Driver {
 public:
  /// `parts`: a world, on which all ranks have both sides, or what place() made of it; the directory is one of parts.world(). All
  /// outlive it.
  Driver(const io::RunDirectory& directory, const runtime::Parts& parts, const RunSettings& settings, runtime::StopRequest& stop);

  /// Writes everything but report and summary.json; returns the summary with the exit code (0 done, 3 numerical failure with the
  /// state saved, 5 stopped on request with a checkpoint). Throws runtime::StopAsked, on all ranks alike, where there was no time
  /// to make the first state. Collective.
  io::Summary run(Simulation& simulation);

  const runtime::Ledger& ledger() const { return ledger_; }
  /// Of all ranks on rank 0, once the run is over.
  const std::vector<runtime::RankTrace>& traces() const { return traces_; }
  /// On rank 0, once the run is over: processor time over the core-seconds of tasks.
  double processor_share() const { return processor_share_; }

 private:
  std::int64_t last_window(const coupling::Timeline& timeline) const;
  void open_history(io::History& history, double time_s, const std::optional<io::History::Extent>& written, bool goes_on) const;
  void begin_outputs(const std::vector<Output*>& outputs, Simulation& simulation, std::int64_t window) const;
  static void take_if_due(Output& output, const Windows& done);
  static void finish_outputs(const std::vector<Output*>& outputs, Simulation& simulation, std::int64_t window);
  /// What outputs have handed on is on disk; throws where some of it could not be written.
  static void write_rest(Simulation& simulation);
  void fail(const std::string& failure);
  void end_early(const std::string& why);
  void summarise(Simulation& simulation, std::int64_t first, std::int64_t window);
  void describe_times();
  void add_parts(const runtime::Efficiency& e);
  void add_factors(const std::vector<io::Efficiency>& factors);
  /// The records of all ranks on rank 0, and what they say.
  void read_records(std::int64_t records);
  void write_recording() const;

  const io::RunDirectory& directory_;
  const runtime::Parts& parts_;
  const RunSettings settings_;
  runtime::StopRequest& stop_;
  runtime::Ledger ledger_;                                   ///< of all that the run does from here on
  const double processor_s_ = runtime::processor_seconds();  ///< so far, where the ledger begins
  double processor_share_ = 1.0;
  std::vector<runtime::RankTrace> traces_;
  io::Summary summary_;
};

/// Runs a floating system, or the air alone, as Driver::run does.
io::Summary run(coupling::FloatingSystem& floating, const coupling::Start& start, const io::RunDirectory& directory,
                const runtime::Parts& parts, const RunSettings& settings, runtime::StopRequest& stop);
io::Summary run_flow(const coupling::Scenario& scenario, const io::RunDirectory& directory, const runtime::Parts& parts,
                     const RunSettings& settings, runtime::StopRequest& stop);

}  // namespace spindrift::run
