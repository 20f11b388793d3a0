// SPDX-License-Identifier: Apache-2.0
#include "src/app/leave_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>

#include "runtime/mpi/parts.hpp"
#include "runtime/trace/clock.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind.hpp"
#include "src/app/aside.hpp"
#include "src/app/forecast.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/timeline.hpp"
#include "src/io/console.hpp"
#include "src/io/history.hpp"
#include "src/io/run_directory.hpp"
#include "src/run/outputs.hpp"
#include "src/run/system_simulation.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/scene/text_check.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::app {

namespace {

using coupling::Scenario;
using Overrides = std::vector<std::string>;

/// A smaller choice: the overrides that make it, none where the scene leaves nothing to choose. `own` is what the document says.
struct Choice {
  const char* name;
  std::function<Overrides(const Scenario& own, const scene::Document& document)> overrides;
};

/// Those of these keys that the scene gives, as one override that takes them away; nothing where it gives none.
Overrides without(const scene::Document& document, const std::vector<std::string>& keys) {
  std::string list;
  for (const std::string& key : keys)
    if (document.given(key)) list += fmt::format("{}\"{}\"", list.empty() ? "" : ",", key);
  if (list.empty()) return {};
  return {"without=[" + list + "]"};
}

/// Keys of a wake of filaments.
const std::vector<std::string> of_wake{"aero.wake_turns", "aero.wake_step_deg", "aero.wake_core_chords"};

Overrides operator+(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all{
      {"longer step",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         const std::int64_t steps = coupling::whole_ratio(s.time.window_s, s.time.step()).value_or(1);
         const std::int64_t windows = coupling::whole_ratio(s.time.end_s, s.time.window_s).value_or(1);
         if (steps > 1) return {fmt::format("time.step_s={}", s.time.window_s / double((steps + 1) / 2))};
         const double window = 2.0 * s.time.window_s;
         return {fmt::format("time.window_s={}", window), fmt::format("time.step_s={}", window),
                 fmt::format("time.end_s={}", window * double((windows + 1) / 2))};
       }},
      {"rows half as often",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         return {fmt::format("output.history_every={}", 2 * s.output.history_every)};
       }},
      {"still water",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         return s.has_waves() ? without(document, {"waves"}) : Overrides{};
       }},
      {"strips twice as long",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.sea.model != "morison") return {};
         return {fmt::format("sea.strip_length_m={}", 2.0 * s.sea.strip_length_m)};
       }},
      {"buoyancy without strips",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.sea.model != "morison") return {};
         return without(document, {"waves", "sea.drag_coefficient", "sea.added_mass_coefficient", "sea.axial_drag_coefficient",
                                   "sea.axial_added_mass_coefficient", "sea.strip_length_m", "sea.current_m_s",
                                   "sea.current_profile", "sea.coefficients"}) +
                Overrides{"sea.model=hydrostatic"};
       }},
      {"no memory of waves made",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (!s.sea.potential || s.sea.potential->radiation == "none") return {};
         return without(document, {"sea.potential.memory_s", "sea.potential.fit_tolerance"}) +
                Overrides{"sea.potential.radiation=none"};
       }},
      {"no slow drift",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (!s.sea.potential || s.sea.potential->drift == "none") return {};
         return without(document, {"sea.potential.drift_file"}) + Overrides{"sea.potential.drift=none"};
       }},
      {"first-order waves",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.has_waves() && s.waves.second_order) return {"waves.second_order=false"};
         if (!s.has_waves() || !sea::wave_models().named(s.waves.model).nonlinear) return {};
         return {"waves.model=airy"};
       }},
      {"half the wave components",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (!s.has_waves() || sea::wave_models().named(s.waves.model).regular || s.waves.components < 20 ||
             !s.waves.file.empty())
           return {};
         return {fmt::format("waves.components={}", s.waves.components / 2)};
       }},
      {"filters for a wake of filaments",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.aero.dynamic_inflow != "free_vortex") return {};
         return without(document, of_wake) + Overrides{"aero.dynamic_inflow=oye"};
       }},
      {"thrust curve for blades",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.aero.model != "bem" || s.rotor.operation.empty()) return {};
         std::vector<std::string> of_blades{"aero.induction",     "aero.dynamic_inflow",     "aero.inflow_time_s",
                                            "aero.dynamic_stall", "aero.speed_of_sound_m_s", "aero.kinematic_viscosity_m2_s"};
         of_blades.insert(of_blades.end(), of_wake.begin(), of_wake.end());
         Overrides curve{"aero.model=thrust_curve", fmt::format("aero.curve=\"{}\"", s.rotor.operation)};
         for (const Scenario& one : coupling::by_rotor(s)) {
           if (one.rotor.operation != s.rotor.operation) return {};  // one curve is for all rotors
           of_blades.push_back(one.rotor_section + ".blade_structure");
           curve.push_back(fmt::format("{}.diameter_m={}", one.rotor_section,
                                       2.0 * aero::read_turbine(one.rotor.turbine).planform.span.back()));
         }
         return without(document, of_blades) + curve;
       }},
      {"no gyroscopic moments",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         Overrides all_bodies;
         for (const auto& body : s.bodies)
           if (body.options.gyroscopic) all_bodies.push_back(fmt::format("bodies.{}.gyroscopic=false", body.name));
         return all_bodies;
       }},
  };
  return all;
}

/// The run of a scene, in pieces.
class Tried {
 public:
  Tried(const std::string& path, const Overrides& overrides, const std::filesystem::path& folder)
      : ready_(read_scene(path, overrides)),
        parts_(runtime::World{MPI_COMM_SELF, 0, 1}),
        directory_(MPI_COMM_SELF, folder, io::Existing::overwrite),
        simulation_(*ready_.floating, ready_.start.state, parts_, 0),
        rows_(simulation_, history_) {
    simulation_.declare(history_);
    window_ = simulation_.begin(directory_);
    history_.open(directory_.history());
    rows_.begin(window_);
  }
  /// As far as this time; the processor time of its windows and rows [s]. Throws where the numerics fail.
  double advance_to(double time_s);
  const io::History& history() const { return history_; }
  /// Rows so far.
  scene::Columns columns() {
    history_.flush();
    return scene::read_columns(directory_.history().string());
  }

 private:
  ReadyScene ready_;
  runtime::Parts parts_;
  io::RunDirectory directory_;
  run::SystemSimulation simulation_;
  io::History history_;
  run::HistoryOutput rows_;
  std::int64_t window_ = 0;
};

double Tried::advance_to(double time_s) {
  const coupling::Timeline& timeline = simulation_.timeline();
  const std::int64_t last = timeline.windows(),
                     to = std::min(last, std::int64_t(std::ceil(time_s / timeline.window_s() * (1.0 - 1e-12))));
  const double before = processor_seconds();
  while (window_ < to) {
    const run::Advance advance = simulation_.advance(window_, last);
    if (!advance.failure.empty()) throw std::runtime_error(advance.failure);
    const run::Windows done{window_, window_ + advance.windows, last};
    window_ = done.now;
    if (rows_.due(done)) rows_.take(done);
  }
  return processor_seconds() - before;
}

void require_columns(const io::History& history, const std::vector<std::string>& columns) {
  std::vector<std::string> known;
  for (const io::Column& column : history.columns()) known.push_back(column.name);
  for (const std::string& column : columns)
    if (std::find(known.begin(), known.end(), column) == known.end()) {
      const std::string near = scene::nearest(column, known);
      throw scene::SceneError({{"--columns", 0, "", column,
                                "is no column of this scene" + (near.empty() ? "" : "; did you mean \"" + near + "\"?")}});
    }
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
  return moments(t, x, t.front() + start_share * (t.back() - t.front()), t.back());
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

/// Of the pieces of two runs made in turns. What others on the computer do makes some of them longer; of runs made again the
/// shortest counts. The error is that of a ratio of sums over pieces.
Saving saving_of(const std::vector<double>& own, const std::vector<double>& less) {
  double a = 0.0, b = 0.0, squares = 0.0;
  for (std::size_t n = 0; n < own.size(); ++n) a += own[n], b += less[n];
  if (!(a > 0.0) || own.size() < 2) return {0.0, std::numeric_limits<double>::infinity()};
  for (std::size_t n = 0; n < own.size(); ++n) squares += (less[n] - b / a * own[n]) * (less[n] - b / a * own[n]);
  const double pieces = double(own.size());
  return {1.0 - b / a, 2.0 * std::sqrt(squares * pieces / (pieces - 1.0)) / a};
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
    require_columns(own_->history(), columns);  // before the others take their time
    for (std::size_t n = 0; n < omissions.size(); ++n) {
      say(0.0);
      try {
        less_[n] = std::make_unique<Tried>(path, overrides + omissions[n].overrides, folder / std::to_string(n));
      } catch (const std::exception& e) { refused[n] = e.what(); }
    }
  }
  /// Processor time by piece, of the scene and of each omission; empty of those that were refused.
  struct Times {
    std::vector<double> own;
    std::vector<std::vector<double>> less;
  };
  Times run(double length_s, int pieces, const std::function<void(double)>& say) {
    Times times{.own = {}, .less = std::vector<std::vector<double>>(less_.size())};
    for (int piece = 1; piece <= pieces; ++piece) {
      const double to = piece == pieces ? length_s : length_s * piece / pieces;
      times.own.push_back(own_->advance_to(to));
      for (std::size_t n = 0; n < less_.size(); ++n) {
        if (!less_[n]) continue;
        try {
          times.less[n].push_back(less_[n]->advance_to(to));
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

void take_least(std::vector<double>& least, const std::vector<double>& again) {
  for (std::size_t n = 0; n < std::min(least.size(), again.size()); ++n) least[n] = std::min(least[n], again[n]);
}

}  // namespace

Trial try_omissions(const std::string& path, const Overrides& overrides, const std::vector<std::string>& columns) {
  const Aside aside;
  scene::Document document = load_scene(path, overrides);
  const Scenario scenario = coupling::read_scenario(document);
  Trial trial;
  for (const Choice& choice : choices())
    if (Overrides more = choice.overrides(scenario, document); !more.empty())
      trial.omissions.push_back({.name = choice.name, .overrides = std::move(more), .effects = {}, .saving = {}, .refused = {}});

  // A trial of seconds is made again: its pieces are too short to be timed once.
  constexpr double repeat_below_s = 4.0;
  constexpr int most_rounds = 5;
  Waiting waiting;
  Trials::Times least;
  double used_s = 0.0;
  for (int round = 1; round == 1 || (round <= most_rounds && used_s < repeat_below_s); ++round) {
    const auto say = [&](double share) { waiting.say(round, share); };
    Trials trials(path, overrides, columns, trial.omissions, aside.folder, say);
    if (round == 1) {
      ReadyScene scene = read_scene(path, overrides);
      const double run_s = measured_steps(*scene.floating, scene.start).core_seconds();
      const double all_s = run_s * double(1 + trial.omissions.size());
      const double windows = std::ceil(scenario.time.end_s / scenario.time.window_s * std::min(1.0, trial_budget_s / all_s));
      trial.end_s = scenario.time.end_s;
      trial.length_s = std::min(trial.end_s, std::max(3.0, windows) * scenario.time.window_s);
      if (!trial.whole()) trial.unlike = unlike_the_run(scene, trial.length_s);
    }
    constexpr int pieces = 50;
    const double before = processor_seconds();
    const Trials::Times times = trials.run(trial.length_s, pieces, say);
    used_s += processor_seconds() - before;
    if (round > 1) {
      take_least(least.own, times.own);
      for (std::size_t n = 0; n < times.less.size(); ++n) take_least(least.less[n], times.less[n]);
      continue;
    }
    least = times;
    const scene::Columns own = trials.own().columns();
    for (const std::string& column : columns) {
      const Moments m = settled(own["time_s"], own[column]);
      trial.own.push_back({m.mean, m.deviation});
    }
    for (std::size_t n = 0; n < trial.omissions.size(); ++n) {
      Omission& omission = trial.omissions[n];
      omission.refused = trials.refused[n];
      if (!omission.refused.empty()) continue;
      const scene::Columns less = trials.less(n).columns();
      for (const std::string& column : columns)
        omission.effects.push_back(trial.unlike.empty() ? effect_of(own, less, column, trial.whole()) : Effect{});
    }
  }
  for (std::size_t n = 0; n < trial.omissions.size(); ++n)
    if (trial.omissions[n].refused.empty()) trial.omissions[n].saving = saving_of(least.own, least.less[n]);
  std::stable_sort(trial.omissions.begin(), trial.omissions.end(),
                   [](const Omission& a, const Omission& b) { return a.saving.share > b.saving.share; });
  return trial;
}

}  // namespace spindrift::app
