// Gresho's vortex at Mach 1e-3 through one turn with BDF2: what the whole solver keeps of its kinetic energy. Gresho & Chan
// (1990), Int. J. Numer. Meth. Fluids 11, 621; at low Mach number Miczek, Roepke & Edelmann (2015), Astron. Astrophys. 576, A50.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <numbers>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// Velocity and pressure of the vortex round (0.5, 0.5), largest speed U, of gas of density rho.
gas::Primitive<double> gresho(double x, double z, double U, double rho, const gas::IdealGas& gas) {
  const double dx = x - 0.5, dz = z - 0.5, r = std::sqrt(dx * dx + dz * dz);
  double speed = 0.0, p = -2.0 + 4.0 * std::log(2.0);
  if (r < 0.2)
    speed = 5.0 * r, p = 12.5 * r * r;
  else if (r < 0.4)
    speed = 2.0 - 5.0 * r, p = 12.5 * r * r + 4.0 * (1.0 - 5.0 * r - std::log(0.2) + std::log(r));
  const double pressure = p * rho * U * U;  // at constant density the temperature follows the pressure
  return {pressure, -speed * U * dz / r, 0.0, speed * U * dx / r, pressure / (rho * gas.gas_constant)};
}

double kinetic_energy(const FlowSolver& solver) {
  double sum = 0;
  for (const FlowTile& tile : solver.tiles())
    for (int j = 0; j < tile.box.nj; ++j)
      for (int i = 0; i < tile.box.ni; ++i) {
        const auto w = gas::load_primitive<double>(tile.state.data() + tile.cells.at(0, j, i), std::size_t(tile.cells.component));
        sum += gas::density(solver.setting().gas, w) * gas::kinetic(w);
      }
  return sum;
}

double kept(double mach, const std::string& flux, int steps) {
  FlowSetting s = air(mach);
  s.stream = {};
  s.flux = flux;
  s.time_order = 2;
  s.dt = 2 * std::numbers::pi * 0.2 / s.speed / steps;
  s.march.drop = 1e-3, s.march.max_steps = 40, s.march.cfl_start = 100.0;
  const BoxOptions box{.ni = 80, .nj = 80, .nk = 1, .periodic = {true, true, false}};
  Case c(planar_box(box), s, {}, {.across_j = 40, .across_k = 1, .normal = 80});
  const double rho = gas::density(s.gas, s.stream);
  c.solver->start([&](const Eigen::Vector3d& x) { return gresho(x[0], x[2], s.speed, rho, s.gas); });
  c.prepare();
  const double before = kinetic_energy(*c.solver);
  c.run(std::uint32_t(steps));
  return kinetic_energy(*c.solver) / before;
}

}  // namespace

TEST_CASE("Gresho's vortex at Mach 1e-3 keeps 95 % of its kinetic energy over a turn", "[air][fast]") {
  const double low = kept(1e-3, "roe_low_mach", 40);
  INFO("kept " << low);
  CHECK(low > 0.95);
  CHECK(low <= 1.0);
}
