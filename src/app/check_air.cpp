// SPDX-License-Identifier: Apache-2.0
#include "src/app/check_air.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/aero/changing_wind.hpp"
#include "src/aero/first_cells.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/line_growth.hpp"
#include "src/aero/grid/tiling.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/app/check_doubts.hpp"
#include "src/app/forecast.hpp"
#include "src/app/rotor_start.hpp"
#include "src/coupling/doubts.hpp"
#include "src/coupling/first_cells.hpp"
#include "src/coupling/flow_scene.hpp"

namespace spindrift::app {

using coupling::FloatingSystem;

namespace {

void print_far_sides(const aero::RotorGridOptions& grid) {
  if (const std::string note = far_side_note(grid); !note.empty()) fmt::print("  note: {}\n", note);
}

/// What the walls' first cells will see of the boundary layer, before a run tells.
void print_first_cells(const aero::FirstCells& cells, const char* plate, const std::string& remedy) {
  if (cells.resolved.empty() && cells.by_law.empty()) return;
  fmt::print("\nFirst cells at walls, y+ as on a flat plate of {}\n", plate);
  if (!cells.resolved.empty()) fmt::print("  {:<24}{}\n", "resolved", describe(cells.resolved));
  if (!cells.by_law.empty()) fmt::print("  {:<24}{}\n", "by the law of the wall", describe(cells.by_law));
  const bool lines_known = std::ranges::any_of(cells.resolved, [](const aero::FirstCell& c) { return c.growth > 1.0; });
  if (lines_known)
    fmt::print("  {:<24}{}, up to y+ {:g}\n", "growth off resolved", describe_growth(cells.resolved), aero::wall_layer_y_plus);
  for (const std::string& doubt : doubts_of(cells, remedy)) fmt::print("  warning: {}\n", doubt);
}

/// Makes the grid of a resolved rotor: whether it can be made and shared out is known then. Not of so many cells that it takes
/// more than some seconds.
void try_grid(const aero::ResolvedRotorSetup& setup, int ranks) {
  constexpr long made_at_most = 2'000'000;
  if (aero::resolved_rotor_size(setup).cells << 3 * setup.grid.coarsen > made_at_most) return;
  const std::shared_ptr<const aero::MadeRotorGrid> made = aero::made_rotor_grid(setup);
  aero::require_ranks(std::size_t(aero::rotor_tiling(setup.flow, made->grid, made->edges).size()), ranks);
}

/// Of a resolved rotor on bodies; what is said of its loads elsewhere is by blade elements.
PartCost print_rotor_air(const FloatingSystem& floating, const coupling::Start& start, bool calibrate) {
  const coupling::Scenario& s = floating.scenario();
  const aero::ResolvedRotorSetup setup = resolved_rotor_on(floating, start);
  const aero::ResolvedRotorSize size = aero::resolved_rotor_size(setup);
  fmt::print("\nResolved air (estimates above take the rotor's load from blade elements)\n");
  fmt::print("  {:<22}{} in {} sector{}, {} rows of faces along each blade\n", "cells", size.cells, size.sectors,
             size.sectors == 1 ? ", which follows the hub along the axis only" : "s", size.stations);
  print_far_sides(setup.grid);
  print_first_cells(expected_first_cells(setup), "the blade's chord", coupling::more_layers(s));
  const bool strong = is_strong(s.coupling.scheme);
  return cost_of_air(setup, size, coupled_pseudo_steps(s, &setup), s.start.air_steps, strong ? 2 : 1, calibrate);
}

/// The turbulence model, or what the flow is without one.
std::string friction_of(const aero::FlowOptions& flow) {
  return flow.viscous == "none" ? "inviscid" : flow.turbulence == "none" ? "laminar" : flow.turbulence;
}

void print_resolved_rotor(const coupling::Scenario& s, const scene::Doubts& angles, bool calibrate, int ranks,
                          const BaseCost& base) {
  const aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
  const aero::ResolvedRotorSize size = aero::resolved_rotor_size(setup);
  fmt::print("\nWhat will be modelled\n");
  fmt::print("  {:<10}{}, {}, {}\n", "air", setup.flow.time, friction_of(setup.flow), setup.flow.flux);
  fmt::print("  {:<10}{}\n", "rotor", coupling::describe_rotor(s));
  fmt::print("  {:<10}{} sector{}, {} rows of faces along each blade\n", "grid", size.sectors,
             size.sectors == 1 ? ", periodic" : "s", size.stations);
  print_far_sides(setup.grid);
  print_doubts(angles, coupling::air_doubts(s));
  print_rotor_at_start(s);
  print_first_cells(expected_first_cells(setup), "the blade's chord", coupling::more_layers(s));
  const PartCost cost = cost_of_air(setup, size, expected_pseudo_steps(s, &setup), 0.0, 1, calibrate);
  print_cost(std::span(&cost, 1), s.time.end_s, ranks, base, setup.flow.time == "steady");
}

/// What a patch of this name most likely is.
const char* likely_condition(const std::string& patch, bool viscous) {
  const auto has = [&](const char* word) { return patch.find(word) != std::string::npos; };
  if (has("sym")) return "symmetry";
  if (has("wall") || has("solid") || has("blade") || has("wing") || has("foil") || has("body"))
    return viscous ? "no_slip" : "slip";
  return "far_field";
}

bool has_condition(const aero::FlowOptions& o, const std::string& patch) {
  return std::ranges::any_of(o.boundaries, [&](const aero::PatchOptions& b) { return b.patch == patch; });
}

/// Size of a grid that stands, its patches with their conditions; a block to paste where some have none. False then.
bool print_flow_grid(const aero::FlowOptions& o, const aero::MultiBlockGrid& grid, int ranks) {
  std::size_t cells = 0;
  for (const aero::Block& b : grid.blocks) cells += std::size_t(b.ni) * b.nj * b.nk;
  std::map<std::string, long> faces;
  for (const aero::Boundary& b : grid.boundaries)
    faces[b.patch] += long(b.where.high[0] - b.where.low[0]) * (b.where.high[1] - b.where.low[1]);
  fmt::print("  {:<10}{} cells in {} block{}{}\n", "", cells, grid.blocks.size(), grid.blocks.size() == 1 ? "" : "s",
             grid.planar ? ", planar" : "");
  std::vector<std::string> missing;
  fmt::print("\nPatches of the grid\n");
  for (const auto& [patch, count] : faces) {
    const bool given = has_condition(o, patch);
    fmt::print("  {:<22}{} faces{}\n", patch, count, given ? "" : ", no condition yet");
    if (!given) missing.push_back(patch);
  }
  if (missing.empty()) {
    const aero::Tiling tiling = aero::flow_tiling(o, grid);
    aero::patch_conditions(o, tiling);  // a condition for no patch is refused
    aero::require_ranks(std::size_t(tiling.size()), ranks);
    return true;
  }
  fmt::print("\nEach patch needs a condition. To paste under [aero.flow], after a look at each line:\n\nboundaries = [\n");
  for (const auto& [patch, count] : faces)
    fmt::print("  {{patch = \"{}\", condition = \"{}\"}},\n", patch, likely_condition(patch, o.viscous != "none"));
  fmt::print("]\n");
  return false;
}

/// Of an actuator that bodies carry; nothing where patches lack a condition.
std::optional<PartCost> print_actuated_air(const coupling::Scenario& s, int ranks) {
  const aero::MultiBlockGrid grid = aero::flow_grid(*s.aero.flow);
  const auto [rotor, hub_key] = coupling::placed_rotor(s);
  aero::require_rotor_inside(grid, rotor, hub_key);
  aero::require_inflow_plane_inside(grid, s.wind, coupling::wind_site(s));
  fmt::print("\nResolved air (estimates above take the rotor's load from blade elements)\n  {:<10}{}\n", "grid",
             aero::describe_flow_grid(*s.aero.flow));
  if (!print_flow_grid(*s.aero.flow, grid, ranks)) return {};
  return cost_of_flow(s, grid);
}

aero::FirstCells first_cells_of(const coupling::Scenario& s, const aero::MultiBlockGrid& grid) {
  const aero::FlowOptions& o = *s.aero.flow;
  return expected_first_cells(grid, o, flow_setting(o, s.environment.air_density_kg_m3, coupling::flow_wind(s), s.time.window_s));
}

/// Air through a grid of its own, which may hold an actuator.
ExitCode check_flow_alone(const coupling::Scenario& scenario, const scene::Doubts& angles, const runtime::World& world,
                          double begin_s) {
  const double resident = resident_memory();
  const aero::MultiBlockGrid grid = aero::flow_grid(*scenario.aero.flow);
  if (scenario.has_actuator()) {
    aero::require_rotor_inside(grid, scenario.rotor, "rotor.hub_m");
    aero::require_inflow_plane_inside(grid, scenario.wind, coupling::wind_site(scenario));
  }
  if (world.rank != 0) return done;
  fmt::print("\nWhat will be modelled\n  {:<10}{}, {}, grid {}\n", "air", scenario.aero.flow->time,
             friction_of(*scenario.aero.flow), aero::describe_flow_grid(*scenario.aero.flow));
  if (!print_flow_grid(*scenario.aero.flow, grid, world.size)) return bad_input;
  print_doubts(angles, coupling::air_doubts(scenario));
  if (scenario.has_actuator()) print_rotor_at_start(scenario);
  print_first_cells(first_cells_of(scenario, grid), "their length", coupling::more_layers(scenario));
  const double start_s = processor_seconds() - begin_s;
  const PartCost cost = cost_of_flow(scenario, grid);
  print_cost(std::span(&cost, 1), scenario.time.end_s, world.size, base_cost(start_s, resident),
             scenario.aero.flow->time == "steady");
  return done;
}

}  // namespace

void require_grid(const FloatingSystem& floating, const coupling::Start& start, int ranks) {
  if (has_resolved_rotor(floating.scenario())) try_grid(resolved_rotor_on(floating, start), ranks);
}

std::optional<PartCost> print_air(const FloatingSystem& floating, const coupling::Start& start, bool calibrate, int ranks) {
  if (floating.scenario().has_actuator()) return print_actuated_air(floating.scenario(), ranks);
  return print_rotor_air(floating, start, calibrate);
}

ExitCode check_air_alone(const coupling::Scenario& scenario, const scene::Doubts& angles, bool calibrate,
                         const runtime::World& world, double begin_s) {
  if (!has_resolved_rotor(scenario)) return check_flow_alone(scenario, angles, world, begin_s);
  try_grid(coupling::resolved_rotor_setup(scenario), world.size);
  if (world.rank == 0) print_resolved_rotor(scenario, angles, calibrate, world.size, base_cost(0.0, resident_memory()));
  return done;
}

}  // namespace spindrift::app
