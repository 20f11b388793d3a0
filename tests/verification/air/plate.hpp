// The flat plate of NASA's Turbulence Modeling Resource, Mach 0.2, Re 5e6 per metre: its air, its boundaries, its wall distances.
// Used by flat_plate_test.cpp and wall_function_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

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
  s.physical_far_field = true;  // the codes' upper boundary is the physical Riemann condition, which holds the displaced flow back
  return s;
}

/// Ready to run, on one thread.
inline Case plate_case(MultiBlockGrid grid, const FlowSetting& setting, Condition wall_condition) {
  Case c(std::move(grid), setting,
         {{"wall", {wall_condition, true}},
          {"symmetry", {Condition::symmetry, false}},
          {"inflow", {Condition::inflow_stagnation, false}},
          {"outflow", {Condition::outflow_pressure, false}},
          {"top", {Condition::far_field, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  c.prepare(MPI_COMM_SELF, {.threads = 1});
  return c;
}

}  // namespace spindrift::aero::testing
