// SPDX-License-Identifier: Apache-2.0
#include "src/app/leave_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/parts.hpp"
#include "runtime/trace/clock.hpp"
#include "src/aero/wind.hpp"
#include "src/app/aside.hpp"
#include "src/app/forecast.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/app/smaller_choices.hpp"
#include "src/app/trial_length.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/memory_limits.hpp"
#include "src/coupling/timeline.hpp"
#include "src/io/console.hpp"
#include "src/io/history.hpp"
#include "src/io/run_directory.hpp"
#include "src/run/flow_simulation.hpp"
#include "src/run/outputs.hpp"
#include "src/run/system_simulation.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/scene/text_check.hpp"

namespace spindrift::app {

namespace {

using coupling::Scenario;

void require_columns(const std::vector<std::string>& known, const std::vector<std::string>& columns) {
  for (const std::string& column : columns)
    if (std::ranges::find(known, column) == known.end())
      throw scene::SceneError({{"--columns", 0, "", column, no_column(column, known)}});
}

/// The run of a scene, in pieces.
class Tried {
 public:
  Tried(const std::string& path, const Overrides& overrides, const std::filesystem::path& folder);
  /// As far as this time; the processor time of its windows and rows [s]. Throws where the numerics fail.
  double advance_to(double time_s);
  /// Processor time from reading the scene to t = 0 [s].
  double start_s() const { return start_s_; }
  std::vector<std::string> names() const;
  /// Rows so far.
  scene::Columns columns() {
    history_.flush();
    return scene::read_columns(directory_.history().string());
  }

 private:
  std::optional<Scenario> air_;      ///< of a flow alone
  std::optional<ReadyScene> ready_;  ///< of all others
  runtime::Parts parts_;
  io::RunDirectory directory_;
  std::unique_ptr<run::Simulation> simulation_;
  io::History history_;
  std::optional<run::HistoryOutput> rows_;
  std::int64_t window_ = 0;
  bool settled_ = false;
  double start_s_ = 0.0;
};

Tried::Tried(const std::string& path, const Overrides& overrides, const std::filesystem::path& folder)
    : parts_(runtime::World{MPI_COMM_SELF, 0, 1}), directory_(MPI_COMM_SELF, folder, io::Existing::overwrite) {
  constexpr int at_once = 4;  // pseudo-steps: so that pieces of runs that take turns are alike
  const double before = processor_seconds();
  scene::Document document = load_scene(path, overrides);
  Scenario scenario = coupling::read_scenario(document);
  if (scenario.has_flow()) {
    air_ = std::move(scenario);
    simulation_ = std::make_unique<run::FlowSimulation>(*air_, directory_, parts_.world(), 0, at_once);
  } else {
    ready_ = read_scene(path, overrides);
    simulation_ = std::make_unique<run::SystemSimulation>(*ready_->floating, ready_->start.state, parts_, 0);
  }
  rows_.emplace(*simulation_, history_);
  simulation_->declare(history_);
  window_ = simulation_->begin(directory_);
  history_.open(directory_.history());
  rows_->begin(window_);
  advance_to(0.0);  // bodies held, while the sea settles
  start_s_ = processor_seconds() - before;
}

double Tried::advance_to(double time_s) {
  const coupling::Timeline& timeline = simulation_->timeline();
  const std::int64_t last = timeline.windows(),
                     to = std::min(last, std::int64_t(std::ceil(time_s / timeline.window_s() * (1.0 - 1e-12))));
  if (settled_ || window_ >= to) return 0.0;
  const double before = processor_seconds();
  while (!settled_ && window_ < to) {
    const run::Advance advance = simulation_->advance(window_, last);
    std::string failure = advance.failure;
    settled_ = !advance.settled.empty();
    if (failure.empty() && !settled_ && window_ + advance.windows >= last) failure = simulation_->failure_at_end();
    if (!failure.empty()) throw NumericalFailure(failure, "", 0, timeline.window_end_s(window_));
    const run::Windows done{window_, window_ + advance.windows, last};
    window_ = done.now;
    if (rows_->due(done)) rows_->take(done);
  }
  return processor_seconds() - before;
}

std::vector<std::string> Tried::names() const {
  std::vector<std::string> names;
  for (const io::Column& column : history_.columns()) names.push_back(column.name);
  return names;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

/// From one time to another, trapezoidal.
Moments moments(std::span<const double> t, std::span<const double> x, double from, double to) {
  double length = 0.0, first = 0.0, second = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i - 1] < from || t[i] > to) continue;
    const double h = t[i] - t[i - 1];
    length += h, first += 0.5 * h * (x[i] + x[i - 1]), second += 0.5 * h * (x[i] * x[i] + x[i - 1] * x[i - 1]);
  }
  if (!(length > 0.0)) return {};
  const double mean = first / length;
  return {mean, std::sqrt(std::max(0.0, second / length - mean * mean))};
}

/// Of the last two thirds of a run: the first is that of the start.
constexpr double start_share = 1.0 / 3.0;

Moments settled(std::span<const double> t, std::span<const double> x) {
  const double begin = std::max(0.0, t.front());  // bodies are held before
  return moments(t, x, begin + start_share * (t.back() - begin), t.back());
}

/// Of a march to a steady state: its pseudo-steps are no time to take means over.
Effect effect_on_end(const scene::Columns& own, const scene::Columns& less, const std::string& column) {
  return {.mean = less[column].back() - own[column].back(), .deviation = 0.0};
}

/// What the smaller choice changes. Of a trial that is cut short only what holds in each of its parts: a change that is not twice
/// its standard error over them may as well be none.
Effect effect_of(const scene::Columns& own, const scene::Columns& less, const std::string& column, bool whole) {
  const auto t = own["time_s"], u = less["time_s"], x = own[column], y = less[column];
  const Moments a = settled(t, x), b = settled(u, y);
  Effect effect{.mean = b.mean - a.mean, .deviation = b.deviation - a.deviation};
  if (whole) return effect;
  constexpr int parts = 4;
  const double from = start_share * t.back(), length = (t.back() - from) / parts;
  std::array<double, parts> means{}, deviations{};
  for (int n = 0; n < parts; ++n) {
    const double begin = from + n * length, end = begin + length;
    const Moments c = moments(t, x, begin, end), d = moments(u, y, begin, end);
    means[n] = d.mean - c.mean, deviations[n] = d.deviation - c.deviation;
  }
  const auto holds = [](const std::array<double, parts>& changes, double change) {
    double sum = 0.0, squares = 0.0;
    for (const double c : changes) sum += c;
    for (const double c : changes) squares += (c - sum / parts) * (c - sum / parts);
    return std::abs(change) >= 2.0 * std::sqrt(squares / (parts - 1) / parts);
  };
  if (!holds(means, a.mean == b.mean ? 0.0 : *effect.mean)) effect.mean.reset();
  if (!holds(deviations, *effect.deviation)) effect.deviation.reset();
  return effect;
}

/// Processor time of a run: before its first window, where that counts, and by piece.
struct Times {
  double start = 0.0;
  std::vector<double> pieces;
  double sum() const { return std::accumulate(pieces.begin(), pieces.end(), start); }
};

/// Of two runs made in turns. What others on the computer do makes some pieces longer; of runs made again the shortest counts.
/// The error is that of a ratio of sums over the pieces that both had: of two marches one may settle before the other.
Saving saving_of(const Times& own, const Times& less) {
  double a = 0.0, b = 0.0, squares = 0.0, pieces = 0.0;
  const auto both = [&](std::size_t n) { return own.pieces[n] > 0.0 && less.pieces[n] > 0.0; };
  for (std::size_t n = 0; n < own.pieces.size(); ++n)
    if (both(n)) a += own.pieces[n], b += less.pieces[n], ++pieces;
  if (pieces < 2.0) return {0.0, std::numeric_limits<double>::infinity()};
  for (std::size_t n = 0; n < own.pieces.size(); ++n)
    if (both(n)) squares += std::pow(less.pieces[n] - b / a * own.pieces[n], 2);
  return {1.0 - less.sum() / own.sum(), 2.0 * std::sqrt(squares * pieces / (pieces - 1.0)) / own.sum()};
}

/// Mean and deviation of a load in the trial must be those of the run, or its response is another.
bool alike(const Moments& trial, const Moments& run, double scale) {
  constexpr double close = 0.1, least = 0.01;  // a short gust adds little to the deviation of hours
  const double mean = std::abs(trial.mean - run.mean), deviation = std::abs(trial.deviation - run.deviation);
  return mean <= close * std::max(run.deviation, least * scale) && deviation <= close * std::max(run.deviation, least * scale);
}

/// Why a trial of this length tells nothing of the effects on the whole run: what happens later, slow motions.
std::vector<std::string> unlike_the_run(const ReadyScene& scene, double length_s) {
  const Scenario& s = scene.floating->scenario();
  const double end_s = s.time.end_s;
  std::vector<std::string> why;
  constexpr int most_samples = 20000;
  const int samples = int(std::min<double>(most_samples, std::ceil(end_s / s.time.window_s))) + 1;
  std::vector<double> t, trial_t;
  for (int n = 0; n < samples; ++n) t.push_back(end_s * n / (samples - 1));
  for (const double time : t)
    if (time <= length_s) trial_t.push_back(time);
  const auto compare = [&](const std::string& what, const char* unit, const std::function<double(double)>& value) {
    std::vector<double> x;
    for (const double time : t) x.push_back(value(time));
    const Moments run = settled(t, x), trial = settled(trial_t, std::span(x).first(trial_t.size()));
    if (alike(trial, run, std::abs(run.mean))) return;
    why.push_back(fmt::format("{}: mean {:.3g}, deviation {:.3g} {} in the run, {:.3g}, {:.3g} in the trial", what, run.mean,
                              run.deviation, unit, trial.mean, trial.deviation));
  };
  if (s.has_rotor() && !s.wind.steady()) {
    const aero::Wind& wind = scene.floating->rotor()->wind();
    const Eigen::Vector3d along(std::cos(s.wind.direction), std::sin(s.wind.direction), 0.0);
    const Eigen::Vector3d hub = coupling::placed_rotor(s).rotor.hub_m;
    compare("wind at the hub", "m/s", [&](double time) { return wind.at(time, hub).dot(along); });
    compare("wind across", "m/s", [&](double time) { return wind.at(time, hub).cross(along).norm(); });
  }
  if (s.has_given_waves() && scene.floating->sea())
    compare("surface of the sea", "m", [&](double time) { return scene.floating->sea()->elevation(0.0, 0.0, time); });
  for (const aero::EventOptions& event : s.control.events)
    if (event.time_s > start_share * length_s) why.push_back(fmt::format("an event of the control at t = {:g} s", event.time_s));
  const bodies::Mode* slowest = nullptr;
  for (const bodies::Mode& mode : scene.modes)
    if (std::abs(mode.eigenvalue.imag()) > 1e-6 && (slowest == nullptr || mode.period_s() > slowest->period_s())) slowest = &mode;
  constexpr double least_periods = 4.0;  // one to each part
  if (slowest != nullptr && (1.0 - start_share) * length_s < least_periods * slowest->period_s())
    why.push_back(fmt::format("slow motion: {} has a period of {:.3g} s", slowest->name, slowest->period_s()));
  return why;
}

/// How far a trial is: on a terminal a line that is rewritten, elsewhere a line now and then.
class Waiting {
 public:
  ~Waiting() {
    if (terminal_) io::console::set_status("");
  }
  void say(int round, double share) {
    const double now = 1e-9 * double(runtime::Clock::now_ns());
    if (now < next_) return;
    next_ = now + (terminal_ ? 0.2 : 10.0);
    const std::string text = fmt::format("trying what could be left out{}: {:.0f} %", round > 1 ? ", again for the time" : "",
                                         std::floor(100.0 * share));
    if (terminal_)
      io::console::set_status(text);
    else
      io::console::print(text, true);
  }

 private:
  const bool terminal_ = io::console::is_terminal();
  double next_ = 1e-9 * double(runtime::Clock::now_ns()) + 2.0;
};

/// All runs of a trial, advanced piece by piece in turns, so that all of them meet the computer in the same moods.
class Trials {
 public:
  Trials(const std::string& path, const Overrides& overrides, const std::vector<std::string>& columns,
         const std::vector<Omission>& omissions, const std::filesystem::path& folder, const std::function<void(double)>& say)
      : refused(omissions.size()), less_(omissions.size()) {
    own_ = std::make_unique<Tried>(path, overrides, folder / "own");
    require_columns(own_->names(), columns);  // before the others take their time
    for (std::size_t n = 0; n < omissions.size(); ++n) {
      say(0.0);
      try {
        less_[n] = std::make_unique<Tried>(path, overrides + omissions[n].choice.overrides, folder / std::to_string(n));
        require_columns(less_[n]->names(), columns);
      } catch (const std::exception& e) { refused[n] = e.what(), less_[n].reset(); }
    }
  }
  /// Of the scene and of each omission; no pieces of those that were refused.
  struct AllTimes {
    Times own;
    std::vector<Times> less;
  };
  AllTimes run(double length_s, int pieces, bool starts_count, const std::function<void(double)>& say) {
    AllTimes times{.own = {}, .less = std::vector<Times>(less_.size())};
    if (starts_count) {
      times.own.start = own_->start_s();
      for (std::size_t n = 0; n < less_.size(); ++n)
        if (less_[n]) times.less[n].start = less_[n]->start_s();
    }
    for (int piece = 1; piece <= pieces; ++piece) {
      const double to = piece == pieces ? length_s : length_s * piece / pieces;
      times.own.pieces.push_back(own_->advance_to(to));
      for (std::size_t n = 0; n < less_.size(); ++n) {
        if (!less_[n]) continue;
        try {
          times.less[n].pieces.push_back(less_[n]->advance_to(to));
        } catch (const std::exception& e) { refused[n] = e.what(), less_[n].reset(); }
        say((piece - 1 + double(n + 1) / double(less_.size())) / pieces);
      }
    }
    return times;
  }
  Tried& own() { return *own_; }
  Tried& less(std::size_t n) { return *less_[n]; }
  std::vector<std::string> refused;

 private:
  std::unique_ptr<Tried> own_;
  std::vector<std::unique_ptr<Tried>> less_;
};

void take_least(Times& least, const Times& again) {
  least.start = std::min(least.start, again.start);
  for (std::size_t n = 0; n < std::min(least.pieces.size(), again.pieces.size()); ++n)
    least.pieces[n] = std::min(least.pieces[n], again.pieces[n]);
}

/// How long a trial of bodies and engineering loads is: whole, or as much as the budget carries.
void set_length(Trial& trial, ReadyScene scene) {
  const coupling::TimeOptions time = scene.floating->scenario().time;
  trial.forecast_s = measured_steps(*scene.floating, scene.start).core_seconds() * double(1 + trial.omissions.size());
  trial.length_s = trial_length_s(time.end_s, time.window_s, trial.budget_s, trial.forecast_s);
  if (!trial.whole()) trial.unlike = unlike_the_run(scene, trial.length_s);
}

/// A trial of fluids is whole or none: what the beginning of a flow tells of the rest is not known.
void set_length_of_fluids(Trial& trial, const Forecast& forecast, const std::vector<std::string>& columns) {
  require_columns(forecast.columns, columns);
  const double runs = double(1 + trial.omissions.size());
  trial.forecast_s = forecast.core_seconds * runs;
  if (forecast.bytes * runs > coupling::machine_memory())
    trial.untried = fmt::format("{:.3g} GB for all of them at once", 1e-9 * forecast.bytes * runs);
  else if (trial.forecast_s > trial.budget_s)
    trial.untried = fmt::format("up to {:.3g} s of processor time, {:.3g} for the scene and each of {} smaller choices",
                                trial.forecast_s, forecast.core_seconds, trial.omissions.size());
  else
    trial.length_s = trial.end_s;
}

}  // namespace

Trial try_omissions(const std::string& path, const Overrides& overrides, const std::vector<std::string>& columns,
                    double budget_s) {
  const Aside aside;
  scene::Document document = load_scene(path, overrides);
  Scenario scenario = coupling::read_scenario(document);
  const bool fluids = scenario.has_particles() || scenario.resolves_air();
  std::optional<ReadyScene> ready;
  if (!scenario.has_flow()) ready = read_scene(path, overrides);
  if (scenario.has_particles()) scenario.sea.particles->sound_speed_m_s = ready->floating->particle_plan()->parameters.eos.c0;
  Trial trial{.end_s = scenario.time.end_s, .budget_s = budget_s};
  trial.steady = scenario.has_flow() && scenario.aero.flow->time == "steady";
  for (SmallerChoice& choice : smaller_choices(scenario, document)) trial.omissions.push_back({std::move(choice)});
  if (fluids) {
    set_length_of_fluids(trial, ready ? forecast(*ready->floating, ready->start) : forecast_of_air(scenario), columns);
    if (!trial.untried.empty()) return trial;
  }

  // A trial of seconds is made again: its pieces are too short to be timed once.
  constexpr double repeat_below_s = 4.0;
  constexpr int most_rounds = 5;
  Waiting waiting;
  Trials::AllTimes least;
  double used_s = 0.0;
  for (int round = 1; round == 1 || (round <= most_rounds && used_s < repeat_below_s); ++round) {
    const auto say = [&](double share) { waiting.say(round, share); };
    Trials trials(path, overrides, columns, trial.omissions, aside.folder, say);
    if (round == 1 && !fluids) set_length(trial, std::move(*ready));
    constexpr int pieces = 50;
    const double before = processor_seconds();
    const Trials::AllTimes times = trials.run(trial.length_s, pieces, fluids, say);
    used_s += processor_seconds() - before;
    if (round > 1) {
      take_least(least.own, times.own);
      for (std::size_t n = 0; n < times.less.size(); ++n) take_least(least.less[n], times.less[n]);
      continue;
    }
    least = times;
    const scene::Columns own = trials.own().columns();
    for (const std::string& column : columns) {
      const Moments m = trial.steady ? Moments{own[column].back(), 0.0} : settled(own["time_s"], own[column]);
      trial.own.push_back({m.mean, m.deviation});
    }
    for (std::size_t n = 0; n < trial.omissions.size(); ++n) {
      Omission& omission = trial.omissions[n];
      omission.refused = trials.refused[n];
      if (!omission.refused.empty()) continue;
      const scene::Columns less = trials.less(n).columns();
      for (const std::string& column : columns) {
        if (trial.steady)
          omission.effects.push_back(effect_on_end(own, less, column));
        else
          omission.effects.push_back(trial.unlike.empty() ? effect_of(own, less, column, trial.whole()) : Effect{});
      }
    }
  }
  for (std::size_t n = 0; n < trial.omissions.size(); ++n)
    if (trial.omissions[n].refused.empty()) trial.omissions[n].saving = saving_of(least.own, least.less[n]);
  std::stable_sort(trial.omissions.begin(), trial.omissions.end(),
                   [](const Omission& a, const Omission& b) { return a.saving.share > b.saving.share; });
  return trial;
}

}  // namespace spindrift::app
