// The driver of every run: windows from the start (or a checkpoint) to the end, after each of them the outputs that are due,
// requests to stop, and numerical failure. Called by src/app; tested in tests/src/coupling and tests/coupled.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mpi/parts.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/ledger.hpp"
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
  bool trace = false;
  bool quiet = false;           ///< no progress
  bool accept_history = false;  ///< a restart goes on with rows of history.csv missing or changed
  /// Of the trace, per thread.
  std::size_t records() const { return trace ? std::size_t(1) << 20 : 0; }
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

 private:
  std::int64_t last_window(const coupling::Timeline& timeline) const;
  void open_history(io::History& history, double time_s, const std::optional<io::History::Extent>& written) const;
  static void take_if_due(Output& output, const Windows& done);
  void fail(const std::string& failure);
  void end_early(const std::string& why);
  void describe_times();

  const io::RunDirectory& directory_;
  const runtime::Parts& parts_;
  const RunSettings settings_;
  runtime::StopRequest& stop_;
  runtime::Ledger ledger_;  ///< of all that the run does from here on
  io::Summary summary_;
};

/// Runs a floating system, or the air alone, as Driver::run does.
io::Summary run(coupling::FloatingSystem& floating, const coupling::Start& start, const io::RunDirectory& directory,
                const runtime::Parts& parts, const RunSettings& settings, runtime::StopRequest& stop);
io::Summary run_flow(const coupling::Scenario& scenario, const io::RunDirectory& directory, const runtime::Parts& parts,
                     const RunSettings& settings, runtime::StopRequest& stop);

}  // namespace spindrift::run
