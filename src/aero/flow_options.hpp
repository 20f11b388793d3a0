// Options of the resolved air: [aero.flow] with its grid, its schemes, its march and what acts on the patches of the grid.
// Declared in flow_options.cpp; read as part of [aero]; tested in tests/src/aero/flow_grid_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kernels/rotor/wind_profile.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/grid_motion_options.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
class Document;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct FlowSetting;
enum class KrylovMethod : unsigned char;
struct PatchCondition;

struct PatchOptions {
  std::string patch;
  Condition condition = Condition::far_field;
  bool loads = true;                    ///< of walls
  std::optional<double> temperature_K;  ///< of a no-slip wall; unset: adiabatic
};

/// Pseudo-steps on each coarser grid of a grid that is no rotor's, where the scene does not say.
inline constexpr int usual_coarse_steps = 100;

/// The air and where it flows.
struct FlowDomain {
  std::string grid, map;  ///< paths: Plot3D or CGNS; neutral map of the former
  std::optional<GenerateOptions> generate;
  std::optional<GridMotionOptions> motion;
  std::optional<double> width_m;  ///< of planar grids; unset: 1 m
  std::vector<PatchOptions> boundaries;
  Condition blades = Condition::no_slip;  ///< of a resolved rotor in viscous air, where no boundary names them
  double temperature_K = 288.15;
  double viscosity_Pa_s = 1.8e-5;
  double incidence = 0.0;                                     ///< of the wind, turned about y: positive blows upwards [rad]
  std::optional<double> wind_eddy_viscosity, wind_intensity;  ///< of the undisturbed air; unset: the closure's own
  std::string start = "wind";
};

/// Which terms, and how they are made of the cells.
struct FlowSchemes {
  std::string viscous = "full", turbulence = "sa", wall_distance = "exact";
  std::string flux = "roe_low_mach", limiter = "none";
  double upwinding = 1.0;
  bool first_order_turbulence = false;
  bool low_mach = true, physical_far_field = false;
};

/// Steps in physical and pseudo-time, and when enough of them are made.
struct FlowMarchOptions {
  std::string time = "steady";
  std::optional<double> time_tolerance;  ///< of the error in time of a step; unset: it is neither estimated nor held
  double cfl = 5.0, cfl_max = 1e4, drop = 1e-6, residual_kg_m3_s = 0.0;
  std::optional<double> load_change;  ///< unset: 1e-3 for a steady resolved rotor, else 0
  std::string drop_of = "balance";
  double unconverged_share = 0.05;
  int max_pseudo_steps = 500;
  /// On each coarser grid before a steady march; unset: some, where the grid allows it.
  std::optional<int> coarse_steps;
  int coarse_levels = 2;
  double coarse_drop = 1e-3;
};

/// The linear system of a pseudo-step.
struct FlowLinearOptions {
  KrylovMethod krylov{};  ///< GMRES
  int krylov_steps = 18, refresh_every = 1;
  double krylov_drop = 0.05;
  std::optional<double> matrix_free_below;  ///< unset: from the first step of a steady march, from 1e-2 on of an unsteady one's
  std::string preconditioner = "block_ilu";
  int tile_cells = 8192;  ///< most cells of a tile: a task, a factorisation, what a rank has at least
  int group_cells = 8, direct_groups = 512, common_every = 1, common_steps = 1;  ///< of preconditioners with a coarse level
};

/// [aero.flow]
struct FlowOptions : FlowDomain, FlowSchemes, FlowMarchOptions, FlowLinearOptions {
  bool surfaces = true;
  std::optional<double> reference_area_m2;  ///< unset: own_area
};

/// A metre, the chord of sections and wings that the program makes, times the width of a planar grid or the wing's span [m2].
double own_area(const FlowOptions& options);
/// Area of the coefficients [m2]: as given, else own_area.
inline double reference_area(const FlowOptions& options) { return options.reference_area_m2.value_or(own_area(options)); }
/// [m], of a planar grid that the program makes or reads.
inline double planar_width(const FlowOptions& options) { return options.width_m.value_or(1.0); }

/// 0: steady.
int time_order(const FlowMarchOptions& options);
/// States of steps before that a physical step needs.
int past_levels(const FlowMarchOptions& options);

const scene::Section<FlowOptions>& flow_section();

/// The solver's own numbers: air of this density at this wind, over the height by `profile`; a physical step of dt [s] where the
/// scene is unsteady.
FlowSetting flow_setting(const FlowOptions& options, double density, const Eigen::Vector3d& wind, double dt,
                         const WindProfile& profile = {});

/// Conditions by patch of the tiling; a patch that no boundary names, or a name that no patch has, is a problem of the scene.
std::vector<PatchCondition> patch_conditions(const FlowOptions& options, const Tiling& tiling);
/// Names of the patches whose normal direction is to be a tile's i.
std::vector<std::string> wall_patches(const FlowOptions& options);
/// How large its tiles may be.
TilingOptions tile_limits(const FlowOptions& options);
/// How the grid of this flow is cut into tiles. Throws scene::SceneError where lines off a wall have more cells than a sweep
/// holds.
Tiling flow_tiling(const FlowOptions& options, const MultiBlockGrid& grid);
/// Throws scene::SceneError where a tile has longer rows than the sweeps hold; `source` and `key` say what asked for the grid.
void require_rows(const Tiling& tiling, const std::string& source, const std::string& key, const std::string& value);

}  // namespace spindrift::aero
