// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/time_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "src/scene/columns.hpp"

namespace spindrift::coupling {

namespace {

/// A table in time that the run does not come to, or leaves at its very start: its first or its last value holds.
void doubt_time_of_table(scene::Doubts& doubts, const std::string& key, const std::string& path, double end_s) {
  if (path.empty()) return;
  constexpr double least = 2e-3;  // ramps that then hold are longer
  const scene::Columns file = scene::read_columns(path);
  const std::span<const double> time = file["time_s"];
  const bool too_late = time.front() >= end_s || (time.size() > 2 && time[1] > end_s);
  if (time.size() < 2 || (!too_late && time.back() >= least * end_s)) return;
  doubts.push_back({key,
                    fmt::format("rows at {:.4g}, {:.4g} to {:.4g} s in a run of {:.4g} s", time[0], time[1], time.back(), end_s),
                    "rows within the run", "one value or one line holds all along; look at the unit of its time_s: s, not ms"});
}

/// A driver's table that begins or ends within the run while it moves: the joint starts or stops at once.
void doubt_driver(scene::Doubts& doubts, const std::string& key, const PrescribedMotion& motion, double end_s) {
  constexpr double least = 0.01;  // of the steepest
  if (motion.table.empty()) return;
  for (const auto& [t, verb, inside] : {std::tuple{motion.table.begin(), "begins", motion.table.begin() > 0.0},
                                        std::tuple{motion.table.end(), "ends", motion.table.end() < end_s}})
    if (const double share = std::abs(motion.table.at(t).rate) / std::max(motion.table.steepest(), 1e-300);
        inside && share > least)
      doubts.push_back(
          {key, fmt::format("{} at {:.4g} s with {:.2g} of its largest rate, in a run of {:.4g} s", verb, t, share, end_s),
           "at rest there, by rows of the same value, or over the whole run", "the joint moves or stops at once"});
}

/// Windows, steps and rows of history that do not follow the waves, and waves that the run does not see grow.
void doubt_waves_in_time(scene::Doubts& doubts, const Scenario& s) {
  const bool wavy = s.has_waves() && s.waves.period_s > 0.0;
  if (wavy && s.time.window_s > s.waves.period_s / 8.0 && s.has_rotor() && s.coupling.scheme != SchemeKind::monolithic)
    doubts.push_back({"time.window_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.window_s, s.waves.period_s),
                      "up to an eighth of the period", "rotor and platform exchange loads once a window"});
  const bool own_steps = s.has_particles() && !s.time.step_s;  // those of the particles
  if (wavy && !own_steps && s.time.step() > s.waves.period_s / 8.0)
    doubts.push_back({"time.step_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.step(), s.waves.period_s),
                      "up to an eighth of the period", "the steps do not see the wave"});
  if (wavy && s.time.window_s * s.output.history_every > s.waves.period_s / 4.0)
    doubts.push_back(
        {"output.history_every",
         fmt::format("a row every {:.4g} s under waves of {:.4g} s", s.time.window_s * s.output.history_every, s.waves.period_s),
         "four rows to a period at least", "peaks fall between the rows"});
  if (wavy && s.time.end_s < s.waves.period_s)
    doubts.push_back({"time.end_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.end_s, s.waves.period_s),
                      "one period at least", "the run ends before the first wave has passed"});
  const double growth = s.waves.ramp_s.value_or(0.0);
  const bool as_usual = growth == sea::growth_time(s.waves);  // nobody asked for it
  if (wavy && as_usual && s.time.end_s >= s.waves.period_s && growth > s.time.end_s)
    doubts.push_back({"time.end_s", fmt::format("{:.4g} s under waves that grow over {:.4g} s", s.time.end_s, growth),
                      "longer than that, or waves.ramp_s = 0", "the run ends before the waves have their height"});
  for (const auto& [key, value] :
       {std::pair{"waves.ramp_s", wavy && !as_usual ? growth : 0.0}, std::pair{"start.ramp_s", s.start.ramp_s},
        std::pair{"sea.wavemaker.ramp_s", s.sea.wavemaker ? s.sea.wavemaker->ramp_s.value_or(0.0) : 0.0}})
    if (value > s.time.end_s)
      doubts.push_back({key, fmt::format("{:.4g} s in a run of {:.4g} s", value, s.time.end_s), "shorter than the run",
                        "the run ends before what grows is there; look at its unit: s"});
  if (constexpr double least = 0.05; wavy && !as_usual && growth > 0.0 && growth < least * s.waves.period_s)
    doubts.push_back({"waves.ramp_s", fmt::format("{:.4g} s under waves of {:.4g} s", growth, s.waves.period_s),
                      "0, or a period or more", "waves of their full height meet the bodies at once; look at its unit: s"});
}

/// What the run does not come to, or leaves at its very start.
void doubt_what_comes(scene::Doubts& doubts, const FloatingSystem& floating) {
  const Scenario& s = floating.scenario();
  if (s.wind.event && s.has_rotor() && s.wind.event->start_s > s.time.end_s)
    doubts.push_back({"wind.event.start_s", fmt::format("{:.4g} s in a run of {:.4g} s", s.wind.event->start_s, s.time.end_s),
                      "before the end of the run", "the gust does not come; look at its unit: s"});
  for (const bodies::Joint& joint : floating.multibody().joints())
    for (const auto& [kind, motion] : {std::pair{"rotation", &joint.rotation}, std::pair{"translation", &joint.translation}})
      if (*motion) doubt_driver(doubts, fmt::format("joints.{}.{}.table", joint.name, kind), **motion, s.time.end_s);
  doubt_time_of_table(doubts, "wind.table", s.has_rotor() ? s.wind.table : "", s.time.end_s);
  doubt_time_of_table(doubts, "aero.table", s.aero.table, s.time.end_s);
  for (const auto& [key, value] : {std::pair{"waves.crest_time_s", s.waves.crest_height_m ? s.waves.crest_time_s : 0.0},
                                   std::pair{"sea.wavemaker.start_s", s.sea.wavemaker ? s.sea.wavemaker->start_s : 0.0},
                                   std::pair{"sea.fields.from_s", s.sea.fields ? s.sea.fields->from_s : 0.0}})
    if (value > s.time.end_s)
      doubts.push_back({key, fmt::format("{:.4g} s in a run of {:.4g} s", value, s.time.end_s), "before the end of the run",
                        "it does not come; look at its unit: s"});
  if (const auto& box = s.wind.turbulence;
      box && box->model == aero::TurbulenceModel::kaimal && box->duration_s < 0.1 * s.time.end_s)
    doubts.push_back({"wind.turbulence.duration_s", fmt::format("{:.4g} s in a run of {:.4g} s", box->duration_s, s.time.end_s),
                      "a tenth of the run or more; ten minutes are usual",
                      "the same gusts come again and again; look at its unit: s"});
  for (std::size_t n = 0; n < s.control.events.size(); ++n)
    if (const double at = s.control.events[n].time_s; at > s.time.end_s)
      doubts.push_back({fmt::format("control.events[{}].time_s", n),
                        fmt::format("{:.4g} s in a run of {:.4g} s", at, s.time.end_s), "before the end of the run",
                        "it does not come; look at its unit: s"});
}

/// The length of the run against what is written, and what is settled before it.
void doubt_length_and_output(scene::Doubts& doubts, const Scenario& s) {
  constexpr double most_checkpoints = 320.0;
  if (constexpr double most = 36000.0; s.time.end_s > most)
    doubts.push_back(
        {"time.end_s", fmt::format("{:.4g} s", s.time.end_s), fmt::format("up to {:g} s, ten hours", most), "in ms? give s"});
  if (s.output.means_over_s > s.time.end_s)
    doubts.push_back({"output.means_over_s", fmt::format("{:.4g} s in a run of {:.4g} s", s.output.means_over_s, s.time.end_s),
                      "up to the length of the run", "look at its unit: s"});
  if (s.sea.fields && s.sea.has_particles() && s.sea.fields->interval_s > 0.0) {
    const double interval = s.sea.fields->interval_s;
    if (interval > s.time.end_s)
      doubts.push_back({"sea.fields.interval_s", fmt::format("{:.4g} s in a run of {:.4g} s", interval, s.time.end_s),
                        "shorter than the run", "only the start is written; look at its unit: s"});
    else if (interval < 0.99 * s.time.window_s)
      doubts.push_back({"sea.fields.interval_s", fmt::format("{:.4g} s with windows of {:.4g} s", interval, s.time.window_s),
                        "a window or more", "fields are written at ends of windows; look at its unit: s"});
  }
  if (const double interval = s.checkpoint.interval_s; interval > 0.0 &&
                                                       s.time.end_s > most_checkpoints * std::max(interval, s.time.window_s) &&
                                                       (s.has_particles() || s.resolves_air()))
    doubts.push_back({"checkpoint.interval_s",
                      fmt::format("{:.4g} s: {:.0f} states of all the water or air are written", interval,
                                  std::floor(s.time.end_s / std::max(interval, s.time.window_s))),
                      fmt::format("up to {:g} in a run", most_checkpoints),
                      "look at its unit: s; checkpoint.wall_interval_s saves by the clock, at little cost"});
  if (constexpr double least = 1.0; s.checkpoint.wall_interval_s > 0.0 && s.checkpoint.wall_interval_s < least)
    doubts.push_back({"checkpoint.wall_interval_s", fmt::format("{:.4g} s", s.checkpoint.wall_interval_s),
                      fmt::format("{:g} s or more; 600 by default", least), "in hours? give s"});
  if (s.sea.settle_s() > 10.0 * s.time.end_s)
    doubts.push_back({"sea.initial.settle_s", fmt::format("{:.4g} s before a run of {:.4g} s", s.sea.settle_s(), s.time.end_s),
                      "up to ten times the run", "look at its unit: s"});
}

}  // namespace

scene::Doubts time_doubts(const FloatingSystem& floating) {
  scene::Doubts all;
  doubt_waves_in_time(all, floating.scenario());
  doubt_what_comes(all, floating);
  doubt_length_and_output(all, floating.scenario());
  return all;
}

}  // namespace spindrift::coupling
