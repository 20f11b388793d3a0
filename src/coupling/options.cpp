// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/coupling/timeline.hpp"
#include "src/scene/section.hpp"

namespace spindrift::coupling {

namespace {

void check_time(const TimeOptions& o, const scene::Report& report) {
  if (!whole_ratio(o.window_s, o.step()))
    report("step_s", fmt::format("must divide the window of {} s into whole steps (nearest: {} s)", o.window_s,
                                 nearest_divisor(o.window_s, o.step())));
  if (!whole_ratio(o.end_s, o.window_s))
    report("end_s", fmt::format("must be a whole number of windows of {} s (nearest: {:.12g} s)", o.window_s,
                                std::max(o.window_s, nearest_multiple(o.end_s, o.window_s))));
}

}  // namespace

const scene::Section<TimeOptions>& time_section() {
  using scene::above;
  static const auto section =
      scene::Section<TimeOptions>("time", "Length of the run and of its steps.")
          .number("end_s", &TimeOptions::end_s, "s", "The run covers 0 to this time.", above(0.0).up_to(1e6))
          .required()
          .number("window_s", &TimeOptions::window_s, "s",
                  "Coupling window: parts exchange loads and motions, and history gets a row, at its end.", above(0.0).up_to(1e3))
          .required()
          .number("step_s", &TimeOptions::step_s, "s",
                  "Step of the bodies and of everything that loads them without a solver of its own; must divide the window, "
                  "which it is where absent.",
                  above(0.0).up_to(1e3))
          .choice("integrator", &TimeOptions::integrator,
                  {{"rk4", Integrator::rk4, "classical Runge-Kutta, fourth order"},
                   {"explicit_euler", Integrator::explicit_euler, "first order; unstable for undamped modes at any step"},
                   {"symplectic", Integrator::symplectic, "leapfrog (kick, drift, kick), second order"}},
                  "Time integration of the bodies.")
          .check(check_time);
  return section;
}

const scene::Section<EnvironmentOptions>& environment_section() {
  using scene::above, scene::between;
  static const auto section =
      scene::Section<EnvironmentOptions>("environment", "Gravity, water and air.")
          .number("gravity_m_s2", &EnvironmentOptions::gravity_m_s2, "m/s2", "Gravitational acceleration, along -z.",
                  between(0.0, 100.0))
          .number("water_density_kg_m3", &EnvironmentOptions::water_density_kg_m3, "kg/m3", "Density of the water.",
                  above(0.0).up_to(2e4))
          .number("water_depth_m", &EnvironmentOptions::water_depth_m, "m", "Depth of the still water.", above(0.0).up_to(1.2e4))
          .path("bathymetry", &EnvironmentOptions::bathymetry,
                "CSV file with columns x_m, y_m, depth_m, a row to each place of a grid: the bed on which lines of the model "
                "lumped_mass lie, straight between the places. Waves know water_depth_m alone.")
          .number("air_density_kg_m3", &EnvironmentOptions::air_density_kg_m3, "kg/m3", "Density of the air.",
                  above(0.0).up_to(100.0));
  return section;
}

const scene::Section<StartOptions>& start_section() {
  static const auto section =
      scene::Section<StartOptions>("start", "State at t = 0.")
          .flag("equilibrium", &StartOptions::equilibrium,
                "Start from the static equilibrium under the mean loads (wind without gusts, current, lines, still water; the "
                "rotor's over a turn), instead of from the positions of the scene.")
          .path("file", &StartOptions::file,
                "State of another run of the same floating system: a checkpoint, or another file of that run's folder (its "
                "scene.toml), which stands for its newest one. Bodies, water and air go on from it at its time. Windows, steps, "
                "scheme and the march of the air may be others; its time must be a whole number of windows.")
          .number("ramp_s", &StartOptions::ramp_s, "s",
                  "Rotor loads grow smoothly from nothing over this time; 0 applies them at once.", scene::between(0.0, 1e6))
          .integer("air_steps", &StartOptions::air_steps, "-",
                   "Resolved rotor on a body: pseudo-steps in the turning rotor's frame by which its air settles before t = 0, "
                   "hub held. 0: "
                   "the undisturbed wind everywhere, and no load on the bodies in the first window.",
                   scene::between(0, 1e6))
          .path(
              "air", &StartOptions::air,
              "Resolved rotor on a body: its air as another run left it, alone or coupled, on the same grid and with the same "
              "models. A "
              "checkpoint, or another file of that run's folder (its scene.toml), which stands for its newest one. Blades may be "
              "elsewhere: the flow is turned with them. For the sea: sea.initial.file.")
          .check([](const StartOptions& o, const scene::Report& report) {
            if (!o.air.empty() && o.air_steps > 0) report("air_steps", "must be 0 where start.air gives the air");
          });
  return section;
}

const scene::Section<ExpectedOptions>& expected_section() {
  static const auto section =
      scene::Section<ExpectedOptions>(
          "expected", "What the scene should give, by somebody else's account: the report sets it beside what it gave.")
          .text("column", &ExpectedOptions::column, "Column of history.csv.")
          .required()
          .number("mean", &ExpectedOptions::mean, "-", "Its mean, in the column's unit.")
          .required()
          .number("within", &ExpectedOptions::within, "-", "How far the mean may be from it, in the same unit.",
                  scene::not_negative())
          .required()
          .number("from_s", &ExpectedOptions::from_s, "s",
                  "The mean is that from here to the end of the run; over output.means_over_s where absent.",
                  scene::not_negative())
          .text("source", &ExpectedOptions::source, "Who says so: a paper with its table, a theory, a measurement.")
          .required();
  return section;
}

const scene::Section<OutputOptions>& output_section() {
  static const auto section =
      scene::Section<OutputOptions>("output", "What a run writes.")
          .text("title", &OutputOptions::title, "Title of the report; the scene's file name where empty.")
          .texts(
              "caveats", &OutputOptions::caveats,
              "What the scene lacks of what it stands for and answers depend on, one sentence each: the report tells it beside "
              "its verdict. An import writes what it left out.")
          .texts("notes", &OutputOptions::notes,
                 "What else a reader should know of the scene, one sentence each: in the report under what was modelled.")
          .integer("history_every", &OutputOptions::history_every, "-", "Windows from one row of history.csv to the next.",
                   scene::between(1, 1e9))
          .choice("openfast", &OutputOptions::openfast,
                  {{"none", "no other file"},
                   {"text", "history.out, the text format of OpenFAST"},
                   {"binary", "history.outb, its binary format: each column in 16 bits over its range"}},
                  "history.csv once more, at the end of the run, for tools that read OpenFAST's output.")
          .number("means_over_s", &OutputOptions::means_over_s, "s",
                  "Length of the time before the end over which summary.json, and spanwise.csv of a steady flow, give means; 0: "
                  "the last third of the run.",
                  scene::between(0.0, 1e6))
          .number(
              "air_interval_s", &OutputOptions::air_interval_s, "s",
              "Resolved rotor on a body: simulated time between fields of its air; 0: at the end alone; that of sea.fields where "
              "absent.",
              scene::between(0.0, 1e6))
          .tables("expected", &OutputOptions::expected, expected_section(), "References that the report compares with.");
  return section;
}

const scene::Section<CheckpointOptions>& checkpoint_section() {
  static const auto section =
      scene::Section<CheckpointOptions>("checkpoint", "Saved states, from which --restart goes on bit for bit.")
          .number("interval_s", &CheckpointOptions::interval_s, "s",
                  "Simulated time between checkpoints, besides those by the clock; 0: none.", scene::between(0.0, 1e6))
          .number(
              "wall_interval_s", &CheckpointOptions::wall_interval_s, "s",
              "Wall time between checkpoints, longer where saving would take more than a hundredth of it; 0: none. With any "
              "of the two, the first is saved at the start; the last, at the end, on a stop and on numerical failure, always.",
              scene::between(0.0, 1e6))
          .integer("keep", &CheckpointOptions::keep, "-", "How many of the last checkpoints are kept.", scene::between(1, 1000));
  return section;
}

const scene::Section<RuntimeOptions>& runtime_section() {
  static const auto section =
      scene::Section<RuntimeOptions>("runtime", "How the computer's time is used.")
          .number("wall_limit_s", &RuntimeOptions::wall_limit_s, "s",
                  "Wall time after which the run finishes its window, writes a checkpoint and ends with exit code 5; 0: none.",
                  scene::between(0.0, 1e9))
          .number(
              "watchdog_s", &RuntimeOptions::watchdog_s, "s",
              "Where no task completes for so long, what they wait for is said, and the run ends with exit code 4 unless one is "
              "at work. A rank that stands still is named within this time, and ends the run. 0: never.",
              scene::between(0.0, 1e9));
  return section;
}

}  // namespace spindrift::coupling
