// [aero.grid] of a scene: the grid round a resolved rotor. Declared in options.cpp; used by `spindrift grid`; tested in
// tests/src/aero/rotor_grid/options_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::aero {

struct RotorGridSpec;
struct Turbine;

struct RotorGridOptions {
  double resolution = 1.0;
  std::optional<int> cells_round, cells_trailing_edge, cells_layers, cells_span, cells_outboard, cells_beside, cells_upstream,
      cells_downstream;
  std::optional<double> first_cell_chords, first_cell_m, y_plus;
  double kinematic_viscosity_m2_s = 1.46e-5;  ///< air at 15 C
  std::optional<double> hub_radius_m;
  double radial_extent = 12.0, upstream_extent = 10.0, downstream_extent = 12.0;
  std::string sectors = "one";
  std::string trailing_edge = "kept";
  int coarsen = 0;
  double least_scaled_jacobian = 0.01;
  double most_off_orthogonal_deg = 88.0;
};

const scene::Section<RotorGridOptions>& rotor_grid_section();

/// What the generator is told. `speed` [rad/s] and `wind_m_s` matter where y+ is asked for; `pitch` [rad].
RotorGridSpec rotor_grid_spec(const RotorGridOptions& options, const Turbine& turbine, double pitch, double speed,
                              double wind_m_s);

}  // namespace spindrift::aero
