// SPDX-License-Identifier: Apache-2.0
#include "src/app/leave_out.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>

#include "src/aero/turbine.hpp"
#include "src/app/forecast.hpp"
#include "src/app/scene_file.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/timeline.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/scene/text_check.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::app {

namespace {

using coupling::Scenario;
using Overrides = std::vector<std::string>;

constexpr double most_core_seconds = 0.4;  // of one trial

/// A smaller choice: the overrides that make it, none where the scene leaves nothing to choose. `own` is what the document says.
struct Choice {
  const char* name;
  std::function<Overrides(const Scenario& own, const scene::Document& document)> overrides;
};

/// Those of these keys that the scene gives, as one override that takes them away; nothing where it gives none.
Overrides without(const scene::Document& document, std::initializer_list<const char*> keys) {
  std::string list;
  for (const char* key : keys)
    if (document.given(key)) list += fmt::format("{}\"{}\"", list.empty() ? "" : ",", key);
  if (list.empty()) return {};
  return {"without=[" + list + "]"};
}

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
      {"thrust curve for blades",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.aero.model != "bem" || s.rotor.operation.empty()) return {};
         return without(document, {"aero.induction", "aero.dynamic_inflow", "aero.inflow_time_s", "aero.dynamic_stall",
                                   "aero.speed_of_sound_m_s", "aero.kinematic_viscosity_m2_s", "rotor.blade_structure"}) +
                Overrides{"aero.model=thrust_curve", fmt::format("aero.curve=\"{}\"", s.rotor.operation),
                          fmt::format("rotor.diameter_m={}", 2.0 * aero::read_turbine(s.rotor.turbine).planform.span.back())};
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

/// A scene made ready to run, and what a trial of it showed.
class Tried {
 public:
  explicit Tried(Scenario scenario) : floating_(std::move(scenario)), start_(make_start(floating_)) {
    require_limits(floating_, start_.state, stability(floating_, start_.state));
  }
  /// Mean and deviation of these columns in a run of this length, rows and all; its end is where steps are timed.
  std::vector<Effect> run(double length_s, const std::vector<std::string>& columns);
  /// Of the whole run from here on, by the least times of a step and of a row; what others on the computer do only adds to those.
  double core_seconds() {
    least_ = std::min(least_, measured_steps(floating_, start_).core_seconds());
    return least_;
  }

 private:
  coupling::FloatingSystem floating_;
  coupling::Start start_;
  double least_ = std::numeric_limits<double>::infinity();
};

/// Mean and deviation over the last two thirds, trapezoidal.
Effect of_column(std::span<const double> t, std::span<const double> x) {
  const double from = t.front() + (t.back() - t.front()) / 3.0;
  double length = 0.0, first = 0.0, second = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i - 1] < from) continue;
    const double h = t[i] - t[i - 1];
    length += h, first += 0.5 * h * (x[i] + x[i - 1]), second += 0.5 * h * (x[i] * x[i] + x[i - 1] * x[i - 1]);
  }
  const double mean = first / length;
  return {mean, std::sqrt(std::max(0.0, second / length - mean * mean))};
}

std::vector<Effect> Tried::run(double length_s, const std::vector<std::string>& columns) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("spindrift_trial_{}.csv", ::getpid());
  {
    io::History history;
    coupling::Recorder recorder(floating_, history);
    std::vector<std::string> known;
    for (const io::Column& column : history.columns()) known.push_back(column.name);
    for (const std::string& column : columns)
      if (std::find(known.begin(), known.end(), column) == known.end()) {
        const std::string near = scene::nearest(column, known);
        throw scene::SceneError({{"--columns", 0, "", column,
                                  "is no column of this scene" + (near.empty() ? "" : "; did you mean \"" + near + "\"?")}});
      }
    history.open(file);
    bodies::BodiesState& state = start_.state;
    const coupling::Timeline& time = floating_.timeline();
    const auto write_row = [&](double t) { recorder.fill(history.row(t), state, t), history.write(); };
    write_row(0.0);
    for (std::int64_t window = 1; double(window) * time.window_s() <= length_s * (1.0 + 1e-12); ++window) {
      for (std::int64_t n = 0; n < time.steps_per_window(); ++n)
        if (const bodies::StepReport report = floating_.multibody().advance(state, time.tick_s(), 1); !report.ok())
          throw floating_.multibody().failure(report, state, time.tick_s());
      if (window % floating_.scenario().output.history_every == 0) write_row(time.window_end_s(window));
    }
    history.flush();
  }
  const scene::Columns table = scene::read_columns(file.string());
  std::vector<Effect> found;
  for (const std::string& column : columns) found.push_back(of_column(table["time_s"], table[column]));
  std::filesystem::remove(file);
  return found;
}

}  // namespace

Trial try_omissions(const std::string& path, const Overrides& overrides, const std::vector<std::string>& columns) {
  scene::Document document = load_scene(path, overrides);
  const Scenario scenario = coupling::read_scenario(document);
  Tried own{Scenario(scenario)};
  const double pace = own.core_seconds() / scenario.time.end_s;
  const double windows =
      std::max(3.0, std::floor(std::min(scenario.time.end_s, most_core_seconds / pace) / scenario.time.window_s));
  Trial trial{.length_s = std::min(scenario.time.end_s, windows * scenario.time.window_s)};
  trial.own = own.run(trial.length_s, columns);
  std::vector<std::unique_ptr<Tried>> all;
  for (const Choice& choice : choices()) {
    Overrides more = choice.overrides(scenario, document);
    if (more.empty()) continue;
    Omission omission{.name = choice.name, .overrides = more, .effects = {}, .saving = 0.0, .refused = {}};
    all.push_back(nullptr);
    try {
      scene::Document smaller = load_scene(path, overrides + more);
      all.back() = std::make_unique<Tried>(coupling::read_scenario(smaller));
      const std::vector<Effect> outcome = all.back()->run(trial.length_s, columns);
      for (std::size_t c = 0; c < columns.size(); ++c)
        omission.effects.push_back({outcome[c].mean - trial.own[c].mean, outcome[c].deviation - trial.own[c].deviation});
    } catch (const std::exception& e) { omission.refused = e.what(); }
    trial.omissions.push_back(std::move(omission));
  }
  // In turns, so that all of them meet the computer in the same moods.
  double core_seconds = 0.0;
  for (int turn = 0; turn < 3; ++turn) {
    core_seconds = own.core_seconds();
    for (std::size_t n = 0; n < all.size(); ++n)
      if (trial.omissions[n].refused.empty()) trial.omissions[n].saving = 1.0 - all[n]->core_seconds() / core_seconds;
  }
  std::stable_sort(trial.omissions.begin(), trial.omissions.end(),
                   [](const Omission& a, const Omission& b) { return a.saving > b.saving; });
  return trial;
}

}  // namespace spindrift::app
