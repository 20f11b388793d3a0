// The resolved rotor at its extremes: started impulsively at full speed, parked in a storm that breaks into air at rest, in a
// wind from behind, turning in still air. Each march stays positive and finite and ends for want of steps or with a named reason;
// loads have the sign that physics gives them. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/resolved_rotor.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

/// One sector of the DTU 10-MW rotor, 10 040 cells.
ResolvedRotorSetup rotor(double wind, double rpm, bool viscous) {
  ResolvedRotorSetup s;
  s.grid.resolution = 1.0, s.grid.sectors = "one";
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = rpm * pi / 30.0;
  s.wind = {wind, 0.0, 0.0};
  s.flow.time = "steady", s.flow.cfl = 2.0, s.flow.cfl_max = 100.0, s.flow.drop = 0.0, s.flow.max_pseudo_steps = 40;
  s.flow.viscous = viscous ? "full" : "none", s.flow.turbulence = "sa";
  if (viscous) s.flow.blades = Condition::wall_function;
  return s;
}

struct Left {
  RotorLoad load;
  double least_pressure = 1e30, least_density = 1e30, residual = 0.0, stirred = 0.0;
  bool finite = true;
};

Left march(const ResolvedRotorSetup& setup, bool from_rest) {
  ResolvedRotor r(setup);
  FlowSolver& solver = r.solver();
  from_rest ? solver.start([](const Eigen::Vector3d&) { return gas::Primitive<double>{}; }) : solver.start_uniform();
  r.prepare(MPI_COMM_SELF, {.threads = 1});
  r.run();
  const MarchState& m = solver.march();
  CAPTURE(m.why, m.cfl, m.rejections);
  CHECK((m.verdict == Verdict::converged || (m.verdict == Verdict::failed && *m.why != '\0')));
  Left left{.load = r.load(), .residual = m.now.density, .stirred = m.first.density};
  const gas::IdealGas& gas = solver.setting().gas;
  for (const FlowTile& tile : solver.tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
        left.least_pressure = std::min(left.least_pressure, gas::absolute_pressure(gas, q));
        left.least_density = std::min(left.least_density, gas::density(gas, q));
        left.finite = left.finite && std::isfinite(q.p + q.u + q.v + q.w + q.T);
      }
    });
  const auto thrust = 1e-3 * left.load.thrust, power = 1e-6 * left.load.power, pressure = 1e-3 * left.least_pressure;
  INFO("thrust " << thrust << " kN, power " << power << " MW, least pressure " << pressure << " kPa, least density "
                 << left.least_density << " kg/m3, residual fallen by " << left.residual / left.stirred);
  CHECK(left.finite);
  CHECK(left.least_pressure > 60e3);  // of 101 kPa; no flow here comes near a tenth of the dynamic pressure that would take
  CHECK(left.least_density > 0.8);    // of 1.225 kg/m3
  CHECK(left.residual < left.stirred);
  return left;
}

}  // namespace

TEST_CASE("a rotor put at full speed into the wind in one step stays sound and is driven", "[rotor][nightly]") {
  const bool viscous = GENERATE(false, true);
  const Left left = march(rotor(11.0, 8.836, viscous), false);
  CHECK(left.load.thrust > 0.8e6);
  CHECK(left.load.power > 0.0);
}
TEST_CASE("a storm of 50 m/s that breaks on a parked rotor in still air leaves a sound flow", "[rotor][nightly]") {
  const bool viscous = GENERATE(false, true);
  const Left left = march(rotor(50.0, 0.0, viscous), true);
  CHECK(left.load.thrust > 0.2e6);
  CHECK(left.load.power == 0.0);
}
TEST_CASE("wind from behind pushes a turning rotor upstream", "[rotor][nightly]") {
  const bool viscous = GENERATE(false, true);
  const Left left = march(rotor(-11.0, 8.836, viscous), false);
  CHECK(left.load.thrust < -0.2e6);
}
TEST_CASE("a rotor that turns in still air is braked by it", "[rotor][nightly]") {
  const bool viscous = GENERATE(false, true);
  const Left left = march(rotor(0.0, 8.836, viscous), false);
  CHECK(left.load.power < 0.0);
}
