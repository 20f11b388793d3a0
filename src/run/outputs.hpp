// Outputs that every run has: history.csv, checkpoints, progress. Used by driver.cpp; tested through tests/coupled.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "src/io/checkpoint.hpp"
#include "src/io/checkpoint_plan.hpp"
#include "src/io/history.hpp"
#include "src/io/progress.hpp"
#include "src/run/output.hpp"
#include "src/run/simulation.hpp"

namespace spindrift::run {

/// Over which a summary gives means: the whole run, and (the one that the report shows) the end of it.
std::vector<io::TimeRange> mean_ranges(const coupling::OutputOptions& output, double end_s);

/// A row of history.csv at the end of every output.history_every windows and of the last, which stays until the run goes on.
class HistoryOutput final : public Output {
 public:
  HistoryOutput(Simulation& simulation, io::History& history);
  std::string_view label() const override { return "output/history"; }
  void begin(std::int64_t window) override;
  bool due(const Windows& done) const override;
  void take(const Windows& done) override;
  void finish(std::int64_t window) override;

 private:
  void write(std::int64_t window, io::History::Row row = io::History::Row::on_schedule);

  Simulation& simulation_;
  io::History& history_;
  Every every_;
};

/// How far the run is, for whoever waits for it.
class ProgressOutput final : public Output {
 public:
  ProgressOutput(const coupling::Timeline& timeline, std::int64_t first, std::int64_t last, io::ProgressStyle style,
                 bool pseudo_steps);
  std::string_view label() const override { return "output/progress"; }
  bool due(const Windows& done) const override { return done.now > done.before; }
  void take(const Windows& done) override;

 private:
  const coupling::Timeline& timeline_;
  io::Progress progress_;
};

/// A checkpoint when [checkpoint] asks for one (io::CheckpointPlan) and at the end of the run, and restoring the newest.
/// Written beside the next window: what counts is what has been renamed to its place.
class Checkpoints final : public Output {
 public:
  Checkpoints(Simulation& simulation, const io::RunDirectory& directory, io::History& history, MPI_Comm comm);
  std::string_view label() const override { return "output/checkpoint"; }
  void begin(std::int64_t window) override;
  bool due(const Windows& done) const override { return done.now > done.before && plan_.due(comm_, done.before, done.now); }
  void take(const Windows& done) override;
  void finish(std::int64_t window) override;

  /// Puts the simulation where the newest checkpoint that verifies left it; the window it is the end of. Throws io::InputError.
  std::int64_t resume();
  int restarts() const { return restarts_; }
  double cost_s() const { return plan_.cost_s(); }  ///< of the last one
  /// Of history.csv, when the checkpoint that was resumed was written.
  const std::optional<io::History::Extent>& rows() const { return rows_; }

 private:
  void copy(std::int64_t window);
  void require_same_run(const io::CheckpointReader& file) const;

  Simulation& simulation_;
  io::History& history_;
  MPI_Comm comm_;
  io::CheckpointSeries series_;
  io::CheckpointPlan plan_;
  std::optional<io::History::Extent> rows_;
  int restarts_ = 0;
  std::int64_t saved_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace spindrift::run
