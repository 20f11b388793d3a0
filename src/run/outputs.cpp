// SPDX-License-Identifier: Apache-2.0
#include "src/run/outputs.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <utility>

#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"
#include "src/run/saved_history.hpp"

namespace spindrift::run {

std::vector<io::TimeRange> mean_ranges(const coupling::OutputOptions& output, double end_s) {
  const double length = output.mean_length(end_s);
  return {{"whole_run", 0.0, end_s}, {fmt::format("last_{:g}_s", length), end_s - length, end_s}};
}

HistoryOutput::HistoryOutput(Simulation& simulation, io::History& history)
    : simulation_(simulation), history_(history), every_{.windows = simulation.scenario().output.history_every} {}

void HistoryOutput::begin(std::int64_t window) {
  if (simulation_.has_first_row()) write(window);
}

bool HistoryOutput::due(const Windows& done) const {
  return every_.due(done) || (done.now == done.last && done.now > done.before);
}

void HistoryOutput::take(const Windows& done) {
  for (std::int64_t n = done.before + 1; n <= done.now; ++n)
    if (every_.due(n) || n == done.last) write(n, every_.due(n) ? io::History::Row::on_schedule : io::History::Row::off_schedule);
}

void HistoryOutput::finish(std::int64_t) { history_.flush(); }

void HistoryOutput::write(std::int64_t window, io::History::Row row) {
  if (!simulation_.has_rows()) return;
  simulation_.fill_row(window, history_.row(simulation_.timeline().window_end_s(window)));
  history_.write(row);
}

ProgressOutput::ProgressOutput(const coupling::Timeline& timeline, std::int64_t first, std::int64_t last, io::ProgressStyle style,
                               bool pseudo_steps)
    : timeline_(timeline),
      progress_(timeline.window_end_s(first), timeline.window_end_s(last), style, {},
                pseudo_steps ? io::pseudo_steps_text : io::progress_text) {}

void ProgressOutput::take(const Windows& done) { progress_.update(timeline_.window_end_s(done.now)); }

Checkpoints::Checkpoints(Simulation& simulation, const io::RunDirectory& directory, io::History& history, MPI_Comm comm)
    : simulation_(simulation),
      history_(history),
      comm_(comm),
      series_(comm, directory.checkpoints(), simulation.scenario().checkpoint.keep, directory.identity()),
      plan_(simulation.scenario().checkpoint.interval_s, simulation.timeline().window_s(),
            simulation.scenario().checkpoint.wall_interval_s) {}

void Checkpoints::begin(std::int64_t window) {
  if (plan_.at_start()) copy(window);
}

void Checkpoints::take(const Windows& done) { copy(done.now); }

void Checkpoints::finish(std::int64_t window) {
  if (saved_ != window) copy(window);
}

/// History is on disk first: what is there after a restart must go as far as the checkpoint.
void Checkpoints::copy(std::int64_t window) {
  using Clock = io::CheckpointPlan::Clock;
  const auto begin = Clock::now();
  io::on_root(comm_, [&] { history_.drain(); });
  const coupling::Timeline& timeline = simulation_.timeline();
  const double tick_s = timeline.tick_s();
  io::CheckpointCopy copy;
  copy.set("window", window);
  copy.set("time_s", timeline.window_end_s(window));
  copy.set("window_s", timeline.window_s());
  copy.set("restarts", std::int64_t(restarts_));
  copy.write<double>("time/tick_s", std::span<const double>(&tick_s, 1));
  write(copy, history_.extent());
  simulation_.save(copy);
  saved_ = window;
  simulation_.output().hand_on(
      [this, copy = std::move(copy), number = simulation_.file_number(window), copying = Clock::now() - begin] {
        const auto writing = Clock::now();
        io::on_root(comm_, [this] { history_.sync(); });
        series_.save(number, [&](io::CheckpointWriter& file) { copy.write_to(file); });
        plan_.saved(writing - copying);
      });
}

/// The unit of time, which follows from more than one key; the scene itself was compared before (src/scene/identity.hpp).
void Checkpoints::require_same_run(const io::CheckpointReader& file) const {
  if (!file.has("time/tick_s")) return;
  const coupling::Timeline& timeline = simulation_.timeline();
  const double theirs = file.read<double>("time/tick_s").at(0), ours = timeline.tick_s();
  if (const double window_s = file.number("window_s"); window_s != timeline.window_s())
    throw io::InputError(fmt::format("{}: its windows are {:.6g} s long, this scene's {:.6g} s: a restart keeps time.window_s",
                                     file.path().string(), window_s, timeline.window_s()));
  if (theirs != ours)
    throw io::InputError(
        fmt::format("{}: its time is counted in units of {:.6g} s, this scene's in {:.6g} s: a restart keeps time.window_s and "
                    "time.step_s (given or not)",
                    file.path().string(), theirs, ours));
}

std::int64_t Checkpoints::resume() {
  const std::optional<io::CheckpointReader> file = series_.newest();
  if (!file) throw io::only_damaged(series_.folder());
  require_same_run(*file);
  simulation_.restore(*file);
  restarts_ = int(file->integer("restarts")) + 1;
  rows_ = extent_in(*file);
  return saved_ = file->integer("window");
}

}  // namespace spindrift::run
