// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/sweep.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/scene/cases.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

const scene::Section<PatchOptions>& patch_section() {
  static const auto section =
      scene::Section<PatchOptions>("boundaries", "What acts on a patch of the grid.")
          .text("patch", &PatchOptions::patch, "Name of the patch in the grid's map.")
          .required()
          .choice("condition", &PatchOptions::condition, scene::cases<PatchOptions, Condition>(conditions()),
                  "Boundary condition.")
          .number("temperature_K", &PatchOptions::temperature_K, "K", "Temperature that the wall is held at. Default: adiabatic.",
                  scene::between(50.0, 2000.0))
          .only_if("condition", conditions().with("temperature_K"))
          .flag("loads", &PatchOptions::loads, "Whether the force on it (of a wall) is summed into the flow's columns.");
  return section;
}

/// The keys that a made grid's width follows from where it is not width_m; nothing else.
const char* own_width(const GenerateOptions& g) {
  if (g.kind == "wing") return "span_m";
  return g.kind.ends_with("box") ? "low_m and high_m" : nullptr;
}

std::vector<scene::Choice> turbulence_choices() {
  std::vector<scene::Choice> choices = closures().choices();
  choices.insert(choices.begin(), {"none", "laminar"});
  return choices;
}

}  // namespace

const scene::Section<FlowOptions>& flow_section() {
  using scene::above, scene::between;
  static const auto section =
      scene::Section<FlowOptions>("flow", "The resolved air: compressible finite volumes on a structured grid.")
          .path("grid", &FlowOptions::grid,
                "Grid file: CGNS (.cgns), or Plot3D, formatted or binary; a two-dimensional one lies in the x-z plane.")
          .path("map", &FlowOptions::map, "Neutral map file of a Plot3D grid: which sides of its blocks meet, which are patches.")
          .table("generate", &FlowOptions::generate, generate_section(), "A grid made by the program, in place of a file.")
          .table("motion", &FlowOptions::motion, grid_motion_section(), "Walls that turn and heave, in a scene of the air alone.")
          .number("width_m", &FlowOptions::width_m, "m", "Width of a two-dimensional grid. Default: 1.", above(0.0).up_to(1e6))
          .tables("boundaries", &FlowOptions::boundaries, patch_section(), "Conditions by patch; each patch of the grid once.")
          .choice("blades", &FlowOptions::blades,
                  scene::cases<FlowOptions, Condition>(conditions(), [](const BoundaryCondition& c) { return sticks(c); }),
                  "Blades of a resolved rotor in viscous air that no boundary names. Default: \"wall_function\" where first "
                  "cells have y+ of 10 and more and the turbulence model has a law of the wall.")
          .number("temperature_K", &FlowOptions::temperature_K, "K", "Temperature of the undisturbed air.", between(50.0, 2000.0))
          .number("viscosity_Pa_s", &FlowOptions::viscosity_Pa_s, "Pa s",
                  "Dynamic viscosity at that temperature (Sutherland's law around it).", above(0.0).up_to(1e3))
          .choice("viscous", &FlowOptions::viscous,
                  {{"none", "inviscid"}, {"thin_layer", "differences across faces only"}, {"full", "all gradients"}},
                  "Viscous terms.")
          .choice("turbulence", &FlowOptions::turbulence, turbulence_choices(), "Turbulence model.")
          .only_if("viscous", {"thin_layer", "full"})
          .choice("wall_distance", &FlowOptions::wall_distance,
                  {{"exact", "to the nearest point of all walls"},
                   {"poisson", "from Poisson's equation (Spalding): smooth, larger than the exact one where walls are convex"}},
                  "Distance from walls for the turbulence model.")
          .only_if("turbulence", closures().with("wall_distance"))
          .number("wind_eddy_viscosity", &FlowOptions::wind_eddy_viscosity, "-",
                  "Eddy viscosity of the undisturbed air over its laminar one. Default by closure: 0.21 of Spalart-Allmaras "
                  "(nu tilde three times nu), 0.009 of two equations.",
                  above(0.0).up_to(1e6))
          .only_if("turbulence", closures().with("wind_eddy_viscosity"))
          .number("wind_intensity", &FlowOptions::wind_intensity, "-",
                  "Intensity of the modelled turbulence of the undisturbed air: root mean square of a component over the wind's "
                  "speed; with wind_eddy_viscosity. Default: k of 9e-9 times the sound speed squared.",
                  above(0.0).up_to(1.0))
          .only_if("turbulence", closures().with("wind_intensity"))
          .choice("flux", &FlowOptions::flux,
                  {{"roe_low_mach", "Roe with Rieper's scaling: accurate at any Mach number below one and above"},
                   {"roe", "Roe"},
                   {"osher", "Osher, physical ordering"},
                   {"osher_inverse", "Osher, inverse ordering"},
                   {"rusanov", "local Lax-Friedrichs, the most dissipative"}},
                  "Numerical flux.")
          .choice("limiter", &FlowOptions::limiter,
                  {{"none", "third-order upwind-biased reconstruction as it is"},
                   {"van_albada", "smooth"},
                   {"van_leer", "harmonic"},
                   {"minmod", "the most dissipative"},
                   {"first_order", "no reconstruction"}},
                  "Limiter of the reconstruction.")
          .number("upwinding", &FlowOptions::upwinding, "-",
                  "Share of the jump between reconstructed states in the flux; below 1 less dissipation, for resolved eddies.",
                  above(0.0).up_to(1.0))
          .flag("first_order_turbulence", &FlowOptions::first_order_turbulence,
                "Whether what the turbulence model transports is carried by first-order upwind differences, as in CFL3D and "
                "FUN3D, and not by limited "
                "second-order ones: converges sooner with two equations.")
          .flag("low_mach", &FlowOptions::low_mach,
                "Low-Mach preconditioning of the pseudo-time; the solution does not depend on it.")
          .flag("physical_far_field", &FlowOptions::physical_far_field,
                "Whether the far field's characteristic conditions take the waves at their physical speeds also with low_mach: "
                "as most codes do; "
                "reflects more, and holds a displaced flow back with the pressure rho c v.")
          .choice("time", &FlowOptions::time,
                  {{"steady", "one march to the steady state; a window is at most one pseudo-step, its length a count"},
                   {"bdf1", "first order, a step per window"},
                   {"bdf2", "second order, a step per window"},
                   {"bdf3",
                    "third order, a step per window, after one of first and one of second order; keeps a step more. Not A-stable "
                    "but A(86 degrees): what swings with little damping in less than some twenty steps a period may grow"}},
                  "Time integration. Default: \"bdf2\" where bodies carry a resolved rotor.")
          .number(
              "time_tolerance", &FlowOptions::time_tolerance, "-",
              "Tolerance of the error in time of a step, momentum over what the air has beyond the undisturbed stream; keeps a "
              "past state more. Air by itself divides its windows into 1 to 16 steps to hold it; on bodies a window stays one "
              "step, and is warned of. Not given: no estimate.",
              above(0.0).up_to(1.0))
          .only_if("time", {"bdf2", "bdf3"})
          .number("cfl", &FlowOptions::cfl, "-", "CFL number of the first pseudo-step. Default: 2 of a resolved rotor.",
                  above(0.0).up_to(1e6))
          .number("cfl_max", &FlowOptions::cfl_max, "-", "Largest CFL number. Default: 1000 of a resolved rotor.",
                  above(0.0).up_to(1e8))
          .number("drop", &FlowOptions::drop, "-",
                  "Drop of the residual that ends a march. Default: 1e-3 in the windows of a resolved rotor. A steady march that "
                  "takes all its steps without it has not converged and ends with exit code 3; 0: it is to take them all.",
                  between(0.0, 1.0))
          .choice("drop_of", &FlowOptions::drop_of,
                  {{"balance", "norm of the flux balances of all equations, scaled, mean flow and turbulence"},
                   {"density", "root mean square of the rate of change of the density, which the smallest cells rule"}},
                  "Residual whose drop ends a march.")
          .number("unconverged_share", &FlowOptions::unconverged_share, "-",
                  "Share of a run's windows that may spend max_pseudo_steps without the drop; with more the run ends with exit "
                  "code 3.",
                  between(0.0, 1.0))
          .only_if("time", {"bdf1", "bdf2", "bdf3"})
          .number("residual_kg_m3_s", &FlowOptions::residual_kg_m3_s, "kg/(m3 s)",
                  "Density residual (as flow.density_residual) that ends a march whatever its drop; 0: not looked at.",
                  between(0.0, 1e6))
          .number(
              "load_change", &FlowOptions::load_change, "-",
              "Relative change of the force over 20 pseudo-steps that ends a march; 0: not looked at. By default 0.001 for a "
              "steady resolved rotor, whose far wake settles hundreds of pseudo-steps after its loads, if drop is not 0; else 0. "
              "Steps with a CFL number below 1 do not count.",
              between(0.0, 1.0))
          .integer("max_pseudo_steps", &FlowOptions::max_pseudo_steps, "-", "Most pseudo-steps of a physical step.",
                   between(1, 1e6))
          .only_if("time", {"bdf1", "bdf2", "bdf3"})
          .integer(
              "coarse_steps", &FlowOptions::coarse_steps, "-",
              "Most pseudo-steps on each coarser grid, whose flow a steady march then begins with: of half the resolution of "
              "[aero.grid]; else of every second node, and there the drop still counts from the wind's residual on the fine "
              "grid. Default: 100 where every second node makes a grid, none with [aero.grid]. 0: none.",
              between(0, 1e6))
          .only_if("time", {"steady"})
          .integer("coarse_levels", &FlowOptions::coarse_levels, "-",
                   "Most coarser grids, each of every second node of the next; fewer where the grid allows fewer.", between(1, 8))
          .only_if("time", {"steady"})
          .number("coarse_drop", &FlowOptions::coarse_drop, "-",
                  "Drop of the residual that ends the march on a coarser grid sooner.", between(0.0, 1.0))
          .only_if("time", {"steady"})
          .choice("krylov", &FlowOptions::krylov,
                  {{"gmres", KrylovMethod::gmres, "GMRES, one set of vectors"},
                   {"fgmres", KrylovMethod::fgmres, "flexible GMRES: keeps the directions too, the preconditioner may change"},
                   {"gcg", KrylovMethod::gcg, "generalised conjugate gradients: keeps the directions too"}},
                  "Method of the linear solver; all three minimise the same residual.")
          .choice("preconditioner", &FlowOptions::preconditioner,
                  {{"block_ilu", "block ILU(0), tile by tile"},
                   {"block_jacobi", "each cell by itself"},
                   {"identity", "none"},
                   {"coarse", "block ILU(0) after a coarse correction: groups of cells move together, over all tiles"},
                   {"auto",
                    "block_ilu or coarse, by trial at the start: iterations and a model of their cost; logged and written into "
                    "scene.toml"}},
                  "Approximate inverse that the linear solver works with; docs/user/air_choices.md says which for what. Default: "
                  "\"coarse\" of a resolved rotor.")
          .integer("tile_cells", &FlowOptions::tile_cells, "-",
                   "Most cells of a tile, as far as 16 lines of cells (8 in the plane) from a wall through their block have no "
                   "more. A tile is a task and is factorised by itself: smaller ones suit more cores, and take more iterations. "
                   "Changes the last digits.",
                   between(256, 1e6))
          .integer("group_cells", &FlowOptions::group_cells, "-",
                   "Longest side of a group of cells of the coarse correction; 0: a group is a whole tile.", between(0, 64))
          .only_if("preconditioner", {"coarse", "auto"})
          .integer("direct_groups", &FlowOptions::direct_groups, "-",
                   "Most groups that are solved by elimination, with bits that no number of ranks changes; more go to algebraic "
                   "multigrid (hypre).",
                   between(0, 4096))
          .only_if("preconditioner", {"coarse", "auto"})
          .integer("common_every", &FlowOptions::common_every, "-",
                   "Matrices of a physical step, or of a steady march, that one set-up of the coarse correction serves.",
                   between(1, 1000))
          .only_if("preconditioner", {"coarse", "auto"})
          .integer("common_steps", &FlowOptions::common_steps, "-",
                   "Physical steps whose first common_every matrices one set-up serves: it is made anew in every so many-th "
                   "step, whatever the restarts. "
                   "Above 1 it needs common_every of at least max_pseudo_steps (or 1000).",
                   between(1, 1e6))
          .only_if("time", {"bdf1", "bdf2", "bdf3"})
          .integer("refresh_every", &FlowOptions::refresh_every, "-",
                   "Pseudo-steps that a matrix of the preconditioner serves where products are matrix-free; less where the CFL "
                   "number changes by "
                   "a factor of two or the linear systems are solved worse.",
                   between(1, 1000))
          .integer("krylov_steps", &FlowOptions::krylov_steps, "-",
                   "Most iterations of the linear solver in a pseudo-step; memory grows with it.", between(2, 40))
          .number("krylov_drop", &FlowOptions::krylov_drop, "-", "Drop of the linear residual that is enough.",
                  above(0.0).up_to(1.0))
          .number(
              "matrix_free_below", &FlowOptions::matrix_free_below, "-",
              "Drop of the density residual from which on the operator is the linearised residual itself (Newton), not the "
              "stored first-order matrix; 0: never. Default: 1, from the first step on, of a steady march; 0.01 of an unsteady "
              "one's.",
              between(0.0, 1.0))
          .choice("start", &FlowOptions::start,
                  {{"wind", "the wind everywhere"},
                   {"rest", "air at rest, into which the wind breaks from the boundaries"},
                   {"taylor_green", "Taylor and Green's vortex of the wind's speed, wave length 2 pi m"}},
                  "State at the beginning.")
          .flag("surfaces", &FlowOptions::surfaces, "Whether walls are written to fields/walls.xdmf: pressure, friction, y+.")
          .degrees("incidence_deg", &FlowOptions::incidence, "Angle by which the wind blows upwards.", between(-90.0, 90.0))
          .number("reference_area_m2", &FlowOptions::reference_area_m2, "m2",
                  "Area of the coefficients in history.csv. Default: 1 m, the chord of what `generate` makes, times the width of "
                  "a two-dimensional grid or the span of a wing.",
                  above(0.0).up_to(1e9))
          .check([](const FlowOptions& o, const scene::Report& report) {
            const bool transports = o.viscous != "none" && model_sweeps(o.turbulence).equations > 0;
            for (const PatchOptions& b : o.boundaries)
              if (o.viscous == "none" && sticks(b.condition))
                report("boundaries",
                       fmt::format("patch \"{}\": \"{}\" has no effect on inviscid air, which slips along walls: "
                                   "take condition = \"slip\"{}, or viscous = \"thin_layer\" or \"full\"",
                                   b.patch, of(b.condition).name, b.temperature_K ? " and leave out temperature_K" : ""));
              else if (of(b.condition).wall_law && !transports)
                report("boundaries", fmt::format("patch \"{}\": \"{}\" goes with turbulence that is modelled, not \"{}\"",
                                                 b.patch, of(b.condition).name, o.turbulence));
            if (of(o.blades).wall_law && !transports)
              report("blades",
                     fmt::format("\"{}\" goes with turbulence that is modelled, not \"{}\"", of(o.blades).name, o.turbulence));
            if (o.wind_intensity && !o.wind_eddy_viscosity)
              report("wind_intensity",
                     "has no effect by itself: with the default eddy viscosity, 0.009 of the laminar one, it "
                     "decays within a few cells; give wind_eddy_viscosity too, 10 say");
            if (o.motion && o.time == "steady" && o.motion->oscillates())
              report("motion", "oscillates, which steady flow cannot follow: take time = \"bdf2\", or pitch_deg alone");
            const bool common = o.preconditioner == "coarse" || o.preconditioner == "auto";
            if (o.common_steps > 1 && !common)
              report("common_steps", fmt::format("has no effect with preconditioner \"{}\"", o.preconditioner));
            if (const int needed = std::min(o.max_pseudo_steps, 1000); common && o.common_steps > 1 && o.common_every < needed)
              report("common_steps", fmt::format("is {} but common_every {}: later matrices of a step would have set-ups of "
                                                 "their own; set common_every to {}",
                                                 o.common_steps, o.common_every, needed));
            if (const char* own = o.width_m && o.generate ? own_width(*o.generate) : nullptr)
              report("width_m",
                     fmt::format("has no effect: a grid of kind \"{}\" has the width of its {}", o.generate->kind, own));
            const bool cgns = o.grid.ends_with(".cgns");
            if (o.generate && !o.grid.empty()) report("generate", "is given beside a grid file: one of the two");
            if (!o.generate && !o.grid.empty() && !cgns && o.map.empty())
              report("map", "must be given: a Plot3D grid holds coordinates only");
            if ((o.generate || cgns) && !o.map.empty()) report("map", "has no effect: it belongs to Plot3D grids");
          });
  return section;
}

int time_order(const FlowMarchOptions& o) { return o.time == "steady" ? 0 : o.time.back() - '0'; }
int past_levels(const FlowMarchOptions& o) { return time_order(o) + (time_order(o) > 1 && o.time_tolerance ? 1 : 0); }

FlowSetting flow_setting(const FlowOptions& o, double density, const Eigen::Vector3d& wind, double dt,
                         const WindProfile& profile) {
  FlowSetting s;
  s.gas.temperature_reference = o.temperature_K;
  s.gas.pressure_reference = density * s.gas.gas_constant * o.temperature_K;
  s.gas.viscosity = {.mu0 = o.viscosity_Pa_s, .T0 = o.temperature_K, .S = 110.33};
  s.stream = {0.0, wind.x(), wind.y(), wind.z(), 0.0};
  s.profile = profile;
  s.speed = wind.norm();
  s.flux = o.flux;
  s.limiter = o.limiter;
  s.upwinding = o.upwinding;
  s.first_order_model = o.first_order_turbulence;
  s.viscous = o.viscous != "none";
  s.thin_layer = o.viscous == "thin_layer";
  s.turbulence = s.viscous ? o.turbulence : "none";
  s.wind_eddy_viscosity = o.wind_eddy_viscosity, s.wind_intensity = o.wind_intensity;
  s.preconditioned = o.low_mach;
  s.physical_far_field = o.physical_far_field;
  s.time_order = time_order(o);
  if (s.time_order > 1) s.time_tolerance = o.time_tolerance;
  s.dt = s.time_order > 0 ? dt : 0.0;
  s.krylov = o.krylov;
  s.preconditioner = o.preconditioner == "auto" ? "block_ilu" : o.preconditioner;  // until chosen
  s.coarse = {.group_cells = o.group_cells,
              .direct_groups = o.direct_groups,
              .common_every = o.common_every,
              .common_steps = o.time == "steady" ? 1 : o.common_steps};
  s.march = {.cfl_start = o.cfl,
             .cfl_max = std::max(o.cfl, o.cfl_max),
             .drop = o.drop,
             .by_balance = o.drop_of == "balance",
             .absolute = o.residual_kg_m3_s,
             .load_change = o.load_change.value_or(0.0),
             .max_steps = o.max_pseudo_steps,
             .krylov_steps = o.krylov_steps,
             .krylov_drop = o.krylov_drop,
             .refresh_every = o.refresh_every,
             .matrix_free_below = o.matrix_free_below.value_or(s.time_order == 0 ? 1.0 : 1e-2)};
  return s;
}

double own_area(const FlowOptions& o) {
  constexpr double length = 1.0;
  return length * (o.generate && o.generate->kind == "wing" ? o.generate->span_m : planar_width(o));
}

std::vector<std::string> wall_patches(const FlowOptions& options) {
  std::vector<std::string> names;
  for (const PatchOptions& b : options.boundaries)
    if (is_closed(b.condition)) names.push_back(b.patch);
  return names;
}

TilingOptions tile_limits(const FlowOptions& options) { return {.max_cells = options.tile_cells}; }

namespace {

/// What makes the lines off the walls of a generated grid as long as they are.
const char* row_key(const std::string& kind) {
  if (kind == "box") return "cells";
  if (kind == "stretched_box") return "cell_m";
  return kind == "cylinder" ? "outward" : "refinement";
}

}  // namespace

Tiling flow_tiling(const FlowOptions& options, const MultiBlockGrid& grid) {
  TilingOptions tiling = tile_limits(options);
  for (const PatchOptions& b : options.boundaries)
    if (options.viscous != "none" && of(b.condition).surface == Surface::no_slip) tiling.sticky.push_back(b.patch);
  Tiling tiles = make_tiling(grid, wall_patches(options), tiling);
  if (!options.generate) {
    require_rows(tiles, options.grid, "", "");
  } else {
    const std::string key = row_key(options.generate->kind);
    const GenerateOptions& g = *options.generate;
    require_rows(tiles, "", "aero.flow.generate." + key, key == "refinement" ? fmt::format("{}", g.refinement) : "");
  }
  return tiles;
}

void require_rows(const Tiling& tiling, const std::string& source, const std::string& key, const std::string& value) {
  for (const Tile& tile : tiling.tiles)
    if (tile.ni > longest_row)
      throw scene::SceneError(
          {{source, 0, key, value,
            fmt::format("block {} \"{}\" of the grid has lines of {} cells off its walls, which stay whole: at most {}",
                        tile.block + 1, tiling.block_names[std::size_t(tile.block)], tile.ni, longest_row)}});
}

std::vector<PatchCondition> patch_conditions(const FlowOptions& options, const Tiling& tiling) {
  if (options.viscous != "none" && options.turbulence != "none" && closures().named(options.turbulence).resolves_eddies &&
      tiling.planar)
    throw scene::SceneError({{.key = "aero.flow.turbulence",
                              .value = fmt::format("\"{}\"", options.turbulence),
                              .message = "resolves eddies: the grid must have three dimensions"}});
  std::vector<PatchCondition> conditions(tiling.patches.size());
  std::vector<int> given(tiling.patches.size());
  for (const PatchOptions& b : options.boundaries) {
    const int patch = tiling.patch(b.patch);
    if (patch < 0)
      throw scene::SceneError(
          {{.key = "aero.flow.boundaries",
            .message = fmt::format("the grid has no patch \"{}\"; it has: {}", b.patch, fmt::join(tiling.patches, ", "))}});
    if (given[std::size_t(patch)]++ > 0)
      throw scene::SceneError({{.key = "aero.flow.boundaries", .message = fmt::format("patch \"{}\" is given twice", b.patch)}});
    conditions[std::size_t(patch)] = {b.condition, b.loads && is_closed(b.condition), b.temperature_K};
  }
  for (std::size_t p = 0; p < given.size(); ++p)
    if (given[p] == 0)
      throw scene::SceneError({{.key = "aero.flow.boundaries",
                                .message = fmt::format("patch \"{}\" of the grid has no condition", tiling.patches[p])}});
  return conditions;
}

}  // namespace spindrift::aero
