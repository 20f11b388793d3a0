// SPDX-License-Identifier: Apache-2.0
#include "src/app/leave_out.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>

#include "src/aero/turbine.hpp"
#include "src/app/forecast.hpp"
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

constexpr double most_core_seconds = 0.4;  // of one trial

/// A smaller choice: changes the scenario and says how, or leaves it where it has nothing to offer.
struct Choice {
  const char* name;
  std::function<std::optional<std::string>(Scenario&)> make;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all{
      {"longer step",
       [](Scenario& s) -> std::optional<std::string> {
         const std::int64_t steps = coupling::whole_ratio(s.time.window_s, s.time.step()).value_or(1);
         const std::int64_t windows = coupling::whole_ratio(s.time.end_s, s.time.window_s).value_or(1);
         if (steps > 1) {
           s.time.step_s = s.time.window_s / double((steps + 1) / 2);
           return fmt::format("time.step_s = {:.12g}", *s.time.step_s);
         }
         s.time.window_s *= 2.0, s.time.step_s = s.time.window_s, s.time.end_s = s.time.window_s * double((windows + 1) / 2);
         return fmt::format("time.step_s = {0:g}, time.window_s = {0:g}", s.time.window_s);
       }},
      {"rows half as often",
       [](Scenario& s) -> std::optional<std::string> {
         s.output.history_every *= 2;
         return fmt::format("output.history_every = {}", s.output.history_every);
       }},
      {"still water",
       [](Scenario& s) -> std::optional<std::string> {
         if (!s.has_waves()) return std::nullopt;
         s.waves = {};
         return "without = [\"waves\"]";
       }},
      {"strips twice as long",
       [](Scenario& s) -> std::optional<std::string> {
         if (s.sea.model != "morison") return std::nullopt;
         s.sea.strip_length_m *= 2.0;
         return fmt::format("sea.strip_length_m = {:g}", s.sea.strip_length_m);
       }},
      {"buoyancy without strips",
       [](Scenario& s) -> std::optional<std::string> {
         if (s.sea.model != "morison") return std::nullopt;
         s.sea.model = "hydrostatic", s.waves = {}, s.sea.coefficients.clear();
         return "sea.model = \"hydrostatic\", without [waves] and the coefficients of strips in [sea]";
       }},
      {"first-order waves",
       [](Scenario& s) -> std::optional<std::string> {
         if (!s.has_waves() || !sea::wave_models().named(s.waves.model).nonlinear) return std::nullopt;
         s.waves.model = "airy";
         return "waves.model = \"airy\"";
       }},
      {"half the wave components",
       [](Scenario& s) -> std::optional<std::string> {
         if (!s.has_waves() || sea::wave_models().named(s.waves.model).regular || s.waves.components < 20 ||
             !s.waves.file.empty())
           return std::nullopt;
         s.waves.components /= 2;
         return fmt::format("waves.components = {}", s.waves.components);
       }},
      {"thrust curve for blades",
       [](Scenario& s) -> std::optional<std::string> {
         if (s.aero.model != "bem" || s.rotor.operation.empty()) return std::nullopt;
         s.aero.model = "thrust_curve", s.aero.curve = s.rotor.operation;
         s.rotor.diameter_m = 2.0 * aero::read_turbine(s.rotor.turbine).planform.span.back();
         return fmt::format("aero.model = \"thrust_curve\", aero.curve = \"{}\", rotor.diameter_m = {:g}", s.rotor.operation,
                            *s.rotor.diameter_m);
       }},
      {"no gyroscopic moments",
       [](Scenario& s) -> std::optional<std::string> {
         bool any = false;
         for (auto& body : s.bodies) any = any || body.options.gyroscopic, body.options.gyroscopic = false;
         return any ? std::optional<std::string>("bodies.NAME.gyroscopic = false") : std::nullopt;
       }},
  };
  return all;
}

struct Outcome {
  std::vector<Effect> columns;
  double core_seconds = 0.0;
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

/// The scene for `length_s`, rows and all.
Outcome run(Scenario scenario, double length_s, const std::vector<std::string>& columns) {
  coupling::FloatingSystem floating(std::move(scenario));
  const coupling::Start start = make_start(floating);
  require_limits(floating, start.state, stability(floating, start.state));
  const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("spindrift_trial_{}.csv", ::getpid());
  Outcome outcome;
  {
    io::History history;
    coupling::Recorder recorder(floating, history);
    std::vector<std::string> known;
    for (const io::Column& column : history.columns()) known.push_back(column.name);
    for (const std::string& column : columns)
      if (std::find(known.begin(), known.end(), column) == known.end()) {
        const std::string near = scene::nearest(column, known);
        throw scene::SceneError({{"--columns", 0, "", column,
                                  "is no column of this scene" + (near.empty() ? "" : "; did you mean \"" + near + "\"?")}});
      }
    history.open(file);
    bodies::BodiesState state = start.state;
    const coupling::Timeline& time = floating.timeline();
    const double begin = processor_seconds();
    const auto write_row = [&](double t) { recorder.fill(history.row(t), state, t), history.write(); };
    write_row(0.0);
    for (std::int64_t window = 1; double(window) * time.window_s() <= length_s * (1.0 + 1e-12); ++window) {
      for (std::int64_t n = 0; n < time.steps_per_window(); ++n)
        if (const bodies::StepReport report = floating.multibody().advance(state, time.tick_s(), 1); !report.ok())
          throw floating.multibody().failure(report, state, time.tick_s());
      if (window % floating.scenario().output.history_every == 0) write_row(time.window_end_s(window));
    }
    outcome.core_seconds = processor_seconds() - begin;
    history.flush();
  }
  const scene::Columns table = scene::read_columns(file.string());
  for (const std::string& column : columns) outcome.columns.push_back(of_column(table["time_s"], table[column]));
  std::filesystem::remove(file);
  return outcome;
}

/// Least of two, as others on the computer only add.
Outcome timed(const Scenario& scenario, double length_s, const std::vector<std::string>& columns) {
  Outcome first = run(scenario, length_s, columns);
  first.core_seconds = std::min(first.core_seconds, run(scenario, length_s, columns).core_seconds);
  return first;
}

}  // namespace

Trial try_omissions(const Scenario& scenario, const std::vector<std::string>& columns) {
  Trial trial;
  double pace = 0.0;  // core-seconds per simulated second
  {
    coupling::FloatingSystem floating{Scenario(scenario)};
    const coupling::Start start = make_start(floating);
    pace = measured_steps(floating, start).core_seconds() / scenario.time.end_s;
  }
  const double windows =
      std::max(3.0, std::floor(std::min(scenario.time.end_s, most_core_seconds / pace) / scenario.time.window_s));
  trial.length_s = std::min(scenario.time.end_s, windows * scenario.time.window_s);
  const Outcome own = timed(scenario, trial.length_s, columns);
  trial.own = own.columns;
  for (const Choice& choice : choices()) {
    Scenario smaller = scenario;
    const std::optional<std::string> keys = choice.make(smaller);
    if (!keys) continue;
    Omission omission{.name = choice.name, .keys = *keys, .effects = {}, .saving = 0.0, .refused = {}};
    try {
      const Outcome outcome = timed(smaller, trial.length_s, columns);
      omission.saving = 1.0 - outcome.core_seconds / own.core_seconds;
      for (std::size_t c = 0; c < columns.size(); ++c)
        omission.effects.push_back(
            {outcome.columns[c].mean - own.columns[c].mean, outcome.columns[c].deviation - own.columns[c].deviation});
    } catch (const std::exception& e) { omission.refused = e.what(); }
    trial.omissions.push_back(std::move(omission));
  }
  std::stable_sort(trial.omissions.begin(), trial.omissions.end(),
                   [](const Omission& a, const Omission& b) { return a.saving > b.saving; });
  return trial;
}

}  // namespace spindrift::app
