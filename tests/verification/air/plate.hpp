// The flat plate of NASA's Turbulence Modeling Resource, Mach 0.2, Re 5e6 per metre: its air, its boundaries, its wall distances.
// Used by flat_plate_test.cpp and wall_function_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"

namespace spindrift::aero::testing {

inline FlowSetting plate_air(const std::string& model) {
  FlowSetting s = air(0.2);
  s.gas.temperature_reference = 300.0;
  s.speed = s.stream.u = 0.2 * std::sqrt(s.gas.gamma * s.gas.gas_constant * 300.0);
  s.gas.viscosity = {.mu0 = gas::density(s.gas, s.stream) * s.speed / 5e6, .T0 = 300.0, .S = 110.33};
  s.viscous = true;
  s.turbulence = model;
  s.physical_far_field =
      true;  // the codes' upper boundary is the physical Riemann condition, which holds the displaced flow back
  return s;
}

/// Ready to run, on one thread.
inline Case plate_case(MultiBlockGrid grid, const FlowSetting& setting, Condition wall_condition) {
  Case c(std::move(grid), setting,
         {{"wall", {wall_condition, true}},
          {"symmetry", {Condition::symmetry, false}},
          {"inflow", {Condition::reservoir, false}},
          {"outflow", {Condition::outflow, false}},
          {"top", {Condition::far_field, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  c.prepare(MPI_COMM_SELF, {.threads = 1});
  return c;
}

/// Where the published figures are taken [m].
inline constexpr double plate_station = 0.970084071;

struct PlateResult {
  double friction, drag, y_plus, reynolds_theta;  ///< at the station, the last by the momentum thickness there
  double drop;
  int steps;
};

inline PlateResult plate_result(const Case& c) {
  const FlowSetting& s = c.solver->setting();
  const double rho = gas::density(s.gas, s.stream), q = 0.5 * rho * s.speed * s.speed;
  std::vector<WallPoint> points;
  struct Sample {
    double x, z, mass, u;
  };
  std::vector<Sample> samples;
  for (const FlowTile& tile : c.solver->tiles()) {
    const auto of_tile = c.solver->wall_points(tile);
    points.insert(points.end(), of_tile.begin(), of_tile.end());
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* x = tile.geometry->centre_data.data() + tile.geometry->cell_box.at(k, j, i);
        const auto w = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
        samples.push_back(
            {x[0], x[2 * tile.geometry->cell_box.component], gas::density(s.gas, w) * w.u / (rho * s.speed), w.u / s.speed});
      }
    });
  }
  std::sort(points.begin(), points.end(), [](const WallPoint& a, const WallPoint& b) { return a.place[0] < b.place[0]; });
  std::size_t m = 1;
  while (m + 1 < points.size() && points[m].place[0] < plate_station) ++m;
  const double share = (plate_station - points[m - 1].place[0]) / (points[m].place[0] - points[m - 1].place[0]);
  const double friction = ((1.0 - share) * points[m - 1].traction[0] + share * points[m].traction[0]) / q;
  // The column of cells next to the station; grid lines stand upright.
  double column = samples.front().x;
  for (const Sample& a : samples)
    if (std::abs(a.x - plate_station) < std::abs(column - plate_station)) column = a.x;
  std::erase_if(samples, [&](const Sample& a) { return std::abs(a.x - column) > 1e-6; });
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.z < b.z; });
  double theta = 0.0, z = 0.0, before = 0.0, edge = 0.0;
  for (const Sample& a : samples) edge = std::max(edge, a.z < 0.1 ? a.u : 0.0);
  for (const Sample& a : samples) {
    if (a.z > 0.1) break;
    const double deficit = a.mass / edge * (1.0 - a.u / edge);
    theta += 0.5 * (a.z - z) * (before + deficit), z = a.z, before = deficit;
  }
  return {friction,
          c.solver->rows().back().force[0] / (2.0 * q),
          points[m].y_plus,
          5e6 * edge * theta,
          c.solver->march().density_drop(),
          c.solver->march().steps};
}

}  // namespace spindrift::aero::testing
