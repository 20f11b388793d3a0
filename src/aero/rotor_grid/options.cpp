// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/aero/rotor_grid/layout.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

namespace {

constexpr double hub_root_chords = 0.93;  // equal root circles of three blades meet at 0.58 root chords

void check_grid(const RotorGridOptions& o, const scene::Report& report) {
  if (o.cells_round && *o.cells_round % 2 != 0)
    report("cells_round", "must be even: as many cells on the suction as on the pressure side");
  if (o.cells_trailing_edge && *o.cells_trailing_edge % 2 != 0)
    report("cells_trailing_edge", "must be even: the grid's cut is in its middle");
  const int round = o.cells_round.value_or(sizes_of(o.resolution).round),
            edge = o.cells_trailing_edge.value_or(sizes_of(o.resolution).edge);
  if (edge > round / 4)
    report("cells_trailing_edge",
           fmt::format("= {} must not be more than a quarter of the {} cells round the section", edge, round));
}

}  // namespace

const scene::Section<RotorGridOptions>& rotor_grid_section() {
  static const auto section =
      scene::Section<RotorGridOptions>("grid", "The grid round a resolved rotor, written by `spindrift grid`.")
          .number("resolution", &RotorGridOptions::resolution, "-",
                  "Number n that sizes the grid: about 18 000 n^3 cells a blade; every number of cells grows with n.",
                  scene::between(0.8, 10.0))
          .integer("cells_round", &RotorGridOptions::cells_round, "-", "Cells round the section, even; default 40 n.",
                   scene::between(24, 2000))
          .integer("cells_trailing_edge", &RotorGridOptions::cells_trailing_edge, "-",
                   "Of those on the blunt trailing edge, even; default about n.", scene::between(2, 64))
          .integer("cells_layers", &RotorGridOptions::cells_layers, "-",
                   "Cells from the wall to the edge of the O round the section, 1.4 chords off; default 10 n. About half of "
                   "them are in the boundary layer.",
                   scene::between(4, 500))
          .integer("cells_span", &RotorGridOptions::cells_span, "-", "Cells along the blade; default 12 n.",
                   scene::between(4, 2000))
          .integer("cells_outboard", &RotorGridOptions::cells_outboard, "-",
                   "Cells from the tip to the outer radius; default 8 n.", scene::between(3, 1000))
          .integer("cells_beside", &RotorGridOptions::cells_beside, "-",
                   "Cells from the O to half-way to the next blade, each side; default 6 n, of two blades 9 n, of one 18 n.",
                   scene::between(2, 1000))
          .integer("cells_upstream", &RotorGridOptions::cells_upstream, "-", "Cells from the O to the inflow; default 8 n.",
                   scene::between(2, 1000))
          .integer("cells_downstream", &RotorGridOptions::cells_downstream, "-", "Cells from the O to the outflow; default 9 n.",
                   scene::between(2, 1000))
          .number("first_cell_chords", &RotorGridOptions::first_cell_chords, "-",
                  "Height of the cells at the wall over the local chord; default 1e-3/n, for wall functions.",
                  scene::between(1e-7, 0.02))
          .number("first_cell_m", &RotorGridOptions::first_cell_m, "m",
                  "Height of the cells at the wall, the same all along the blade.", scene::between(1e-7, 0.1))
          .number("y_plus", &RotorGridOptions::y_plus, "-",
                  "y+ of the centres of the cells at the wall, by the flat-plate law at half the chord with wind and rotor speed "
                  "of the "
                  "scene.",
                  scene::between(0.1, 1000.0))
          .number("kinematic_viscosity_m2_s", &RotorGridOptions::kinematic_viscosity_m2_s, "m2/s",
                  "Of the air, for y_plus. Default with [aero.flow]: its viscosity over the air's density.", scene::positive())
          .number("hub_radius_m", &RotorGridOptions::hub_radius_m, "m",
                  "Radius of the slip cylinder that the blades end on; default 0.93 root chords.", scene::positive())
          .number("radial_extent", &RotorGridOptions::radial_extent, "-",
                  "Outer radius over the tip radius. At 3 it acts like a wind tunnel whose walls raise the rotor's wind by 5 %, "
                  "at 12 by 0.3 %.",
                  scene::between(1.2, 50.0))
          .number("upstream_extent", &RotorGridOptions::upstream_extent, "-",
                  "Distance of the inflow from the hub over the tip radius.", scene::between(0.5, 50.0))
          .number("downstream_extent", &RotorGridOptions::downstream_extent, "-",
                  "Distance of the outflow from the hub over the tip radius.", scene::between(0.5, 50.0))
          .choice(
              "sectors", &RotorGridOptions::sectors,
              {{"all", "every blade"}, {"one", "one blade, its sides joined by rotation: for axisymmetric flow"}},
              "How much of the rotor. Default: \"all\" where blades differ, by a wind off the axis, over height or turbulent, by "
              "individual_pitch or blade_stuck.")
          .choice("trailing_edge", &RotorGridOptions::trailing_edge,
                  {{"kept", "flat, as thick as the outline leaves it"}, {"rounded", "closed by half a circle on the flat"}},
                  "What closes the aerofoils.")
          .integer("coarsen", &RotorGridOptions::coarsen, "-",
                   "Keeps every second node of the grid, this many times: nested grids for Richardson extrapolation. The numbers "
                   "of cells "
                   "must allow it.",
                   scene::between(0, 5))
          .number("least_scaled_jacobian", &RotorGridOptions::least_scaled_jacobian, "-",
                  "Limit of quality: a grid with a worse cell is refused.", scene::between(0.0, 1.0))
          .number("most_off_orthogonal_deg", &RotorGridOptions::most_off_orthogonal_deg, "deg",
                  "Limit of quality: a grid with a face farther off the line of its cells' centres is refused.",
                  scene::between(0.0, 90.0))
          .at_most_one_of({"first_cell_chords", "first_cell_m", "y_plus"})
          .check(check_grid);
  return section;
}

RotorGridSpec rotor_grid_spec(const RotorGridOptions& o, const Turbine& turbine, double pitch, double speed, double wind_m_s) {
  RotorGridSpec spec;
  RotorGridSizes& s = spec.sizes;
  s = sizes_of(o.resolution);
  if (turbine.blades < 3) s.beside = s.beside * 3 / turbine.blades;  // the next blade is farther off
  const int fit = 1 << o.coarsen;  // numbers of cells that no one asked for are made to allow coarsening
  const auto up = [&](int n, int step) { return (n + step - 1) / step * step; };
  s.round = o.cells_round.value_or(up(s.round, 4 * fit));
  s.edge = o.cells_trailing_edge.value_or(up(s.edge, 2 * fit));
  s.box = up(s.round / 4, 2 * fit);
  s.layers = o.cells_layers.value_or(up(s.layers, fit)), s.span = o.cells_span.value_or(up(s.span, fit));
  s.outboard = o.cells_outboard.value_or(up(s.outboard, fit)), s.beside = o.cells_beside.value_or(up(s.beside, fit));
  s.upstream = o.cells_upstream.value_or(up(s.upstream, fit)), s.downstream = o.cells_downstream.value_or(up(s.downstream, fit));
  spec.first_cell_chords = o.first_cell_chords.value_or(1e-3 / spec.resolution());
  spec.first_cell_m = o.first_cell_m.value_or(0.0), spec.y_plus = o.y_plus.value_or(0.0);
  spec.kinematic_viscosity = o.kinematic_viscosity_m2_s;
  spec.rotor_speed = speed, spec.wind_m_s = wind_m_s, spec.pitch = pitch;
  spec.hub_radius_m = o.hub_radius_m.value_or(hub_root_chords * turbine.planform.chord.front());
  spec.radial_extent = o.radial_extent, spec.upstream_extent = o.upstream_extent, spec.downstream_extent = o.downstream_extent;
  spec.whole = o.sectors == "all", spec.rounded_edge = o.trailing_edge == "rounded", spec.coarsen = o.coarsen;
  return spec;
}

}  // namespace spindrift::aero
