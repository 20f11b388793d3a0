// spindrift check: validates a scene and says what will be modelled, at what cost and at which limits. Runs nothing.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "src/aero/changing_wind.hpp"
#include "src/app/check_air.hpp"
#include "src/app/check_doubts.hpp"
#include "src/app/check_motion.hpp"
#include "src/app/check_omissions.hpp"
#include "src/app/check_sea.hpp"
#include "src/app/commands.hpp"
#include "src/app/cost.hpp"
#include "src/app/forecast.hpp"
#include "src/app/held_output.hpp"
#include "src/app/rotor_start.hpp"
#include "src/app/scene_file.hpp"
#include "src/coupling/doubts.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/memory_limits.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/angle_doubts.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::app {

namespace {

using coupling::FloatingSystem;

void print_models(const FloatingSystem& floating) {
  const coupling::Scenario& s = floating.scenario();
  fmt::print("\nWhat will be modelled\n");
  std::size_t width = 10;
  for (const coupling::RotorSource& rotor : floating.rotors()) width = std::max(width, rotor.name.size() + 2);
  const auto print = [width](const std::string& what, const std::string& how) { fmt::print("  {:<{}}{}\n", what, width, how); };
  print("bodies", coupling::describe_bodies(s));
  const std::vector<coupling::Scenario> each = coupling::by_rotor(s);
  if (each.empty()) print("rotor", coupling::describe_rotor(s));
  for (std::size_t n = 0; n < each.size(); ++n) print(spoken(floating.rotors()[n].name), coupling::describe_rotor(each[n]));
  if (s.has_rotor() && s.aero.model != "prescribed") print("wind", aero::describe_wind(s.wind));
  if (!each.empty())
    if (const std::string spread = floating.rotors()[0].loads.wind().spread(); !spread.empty()) print("", spread);
  print("sea", coupling::describe_sea(s));
  print("moorings", coupling::describe_moorings(s));
}

/// What moves by steps of its own, the engineering sea with it. Returns its processor time [s].
double print_steps(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Timeline& t = floating.timeline();
  const StepCost cost = measured_steps(floating, start);
  fmt::print("\nSize and cost\n");
  fmt::print("  {:<22}{} windows of {} s, {} step{} each ({})\n", "time", t.windows(), t.window_s(), t.steps_per_window(),
             t.steps_per_window() == 1 ? "" : "s", name(floating.multibody().integrator()));
  fmt::print(
      "  {:<22}{:.3g} core-s: {:.3g} steps of {:.3g} us{} and {:.3g} rows of history of {:.3g} us, measured now\n", "steps",
      cost.core_seconds(), cost.steps, 1e6 * cost.step_s,
      cost.exchanges > 0.0 ? fmt::format(", {:.3g} loads of the rotor of {:.3g} us", cost.exchanges, 1e6 * cost.exchange_s) : "",
      cost.rows, 1e6 * cost.row_s);
  if (!cost.trouble.empty()) fmt::print("  warning: {}; a run tries it again in pieces\n", cost.trouble);
  return cost.core_seconds();
}

/// Of a run in which nothing has a solver of its own but the bodies.
void print_cost_of_steps(const coupling::Timeline& t, const BaseCost& base, double steps_s) {
  const double seconds = base.core_seconds + steps_s;
  fmt::print("  {:<22}{:.3g} ({:.3g} s on one core, {:.0f} times real time; {:.3g} s of them to start and for files)\n",
             "predicted core-hours", seconds / 3600.0, seconds, t.windows() * t.window_s() / seconds, base.core_seconds);
  fmt::print("  {:<22}{:.0f} MB\n", "memory", base.bytes / 1e6);
  for (const std::string& warning : beyond_machine(base.bytes, seconds)) fmt::print("  warning: {}\n", warning);
}

/// Prints all but the verdict and what could be left out; bad_input where patches lack a condition.
ExitCode check_floating(const CheckArguments& arguments, const runtime::World& world, scene::Document& document,
                        const scene::Doubts& angles, coupling::Scenario scenario, double begin_s) {
  const coupling::OutputOptions output = scenario.output;
  FloatingSystem floating(std::move(scenario));
  require_expected_columns(document, output, columns_of(floating));
  const coupling::Start start = start_or_doubts(floating, angles, world.rank == 0);
  const coupling::Stability stability = coupling::stability(floating, start.state);
  require_grid(floating, start, world.size);
  const SavedParts saved = open_saved_parts(world, floating, start);
  const double start_s = processor_seconds() - begin_s;
  scene::Doubts accepted;
  std::optional<scene::SceneError> refusal;  // told below what helps to mend it
  try {
    accepted = require_limits(floating, start.state, stability);
  } catch (const scene::SceneError& e) { refusal = e; }
  if (world.rank == 0) {
    print_models(floating);
    for (const std::string& note : start.notes) fmt::print("  note: {}\n", note);
    for (const std::string& note : coupling::resolution_notes(floating)) fmt::print("  note: {}\n", note);
    print_doubts(angles, coupling::doubts(floating, start, stability));
    if (floating.rotor() && !start.state.motions.empty()) print_rotors_at_start(floating, start);
    if (!start.state.motions.empty()) print_modes(floating, start, stability);
  }
  if (refusal) throw *refusal;
  if (world.rank != 0) return done;
  print_doubts(accepted, {});
  const BaseCost base = base_cost(start_s, resident_memory());
  if (start.state.motions.empty()) {
    const PartCost cost = print_particles(floating, start, saved);
    print_cost(std::span(&cost, 1), floating.scenario().time.end_s, world.size, base);
    return done;
  }
  if (floating.rotor()) print_frequencies_and_coupling(floating, start, stability);
  print_statics(floating, start, stability);
  std::vector<PartCost> parts;
  if (floating.scenario().resolves_air()) {
    const std::optional<PartCost> air = print_air(floating, start, arguments.calibrate, world.size);
    if (!air) return bad_input;
    parts.push_back(*air);
  }
  if (floating.particle_plan()) {
    parts.push_back(print_particles(floating, start, saved));
    print_cost(parts, floating.scenario().time.end_s, world.size, base);
  } else if (const double steps_s = print_steps(floating, start); parts.empty())
    print_cost_of_steps(floating.timeline(), base, steps_s);
  else
    print_cost(parts, floating.scenario().time.end_s, world.size, {base.bytes, base.core_seconds + steps_s});
  return done;
}

ExitCode check_as_read(const CheckArguments& arguments, const runtime::World& world, scene::Document& document,
                       coupling::Scenario scenario, double begin_s) {
  coupling::require_memory(scenario, coupling::machine_memory() * world.size);
  const scene::Doubts angles = scene::angle_doubts(document.echo());
  if (!scenario.has_flow()) return check_floating(arguments, world, document, angles, std::move(scenario), begin_s);
  require_expected_columns(document, scenario.output, columns_of_air_alone());
  return check_air_alone(scenario, angles, arguments.calibrate, world, begin_s);
}

}  // namespace

int check(const CheckArguments& arguments, const runtime::World& world) {
  const double begin_s = processor_seconds();
  scene::Document document = load_scene(arguments.scene, arguments.overrides);
  coupling::Scenario scenario = coupling::read_scenario(document);
  HeldOutput held;
  int code = done;
  try {
    code = by_lines_at_rest(document, [&] { return check_as_read(arguments, world, document, std::move(scenario), begin_s); });
  } catch (...) {
    if (!held.empty()) held.release(arguments.scene + ": refused, for the reason at the end\n");
    throw;
  }
  if (world.rank != 0) return code;
  held.release(fmt::format("{}: {}\n", arguments.scene, code == done ? "valid" : "not yet valid, patches lack a condition"));
  if (code == done) print_omissions(arguments);
  return code;
}

}  // namespace spindrift::app
