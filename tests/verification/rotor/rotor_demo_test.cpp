// The DTU 10-MW rotor on the demo's grid at 11 m/s, 8.836 rpm, pitch 0 against its 2013 report (1507 kN, 9.70 MW; Bak et al., DTU
// Wind Energy I-0092) and the normal force along the span by blade element momentum (Madsen's induction, Prandtl's losses,
// cone 2.5 degrees, no tilt: 1511 kN, 9803 kW). What the demo grid misses is stated in docs/developer/notes/rotor_resolved.md;
// the test holds it there. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "tests/verification/rotor/bem_rows.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

ResolvedRotorSetup demo() {
  ResolvedRotorSetup s;
  s.grid.resolution = 1.0, s.grid.sectors = "one";
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = 8.836 * pi / 30.0;
  s.wind = {11.0, 0.0, 0.0};
  s.flow.time = "steady", s.flow.viscous = "none", s.flow.cfl = 2.0, s.flow.cfl_max = 100.0, s.flow.drop = 1e-4,
  s.flow.max_pseudo_steps = 300;
  return s;
}

}  // namespace

TEST_CASE("the demo rotor without friction has the thrust of blade element momentum to fifteen per cent", "[rotor][nightly]") {
  ResolvedRotor rotor(demo());
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  rotor.run();
  const RotorLoad load = rotor.load();
  CAPTURE(load.thrust, load.power, rotor.solver().march().steps(), rotor.solver().march().why());
  CHECK(rotor.solver().march().verdict() == Verdict::converged);
  CHECK(load.thrust == Approx(1507e3).epsilon(0.15));
  double worst = 0.0;
  for (const SpanLoad& row : rotor.span_loads()) {
    const double share = row.radius / 89.166, off = row.load.normal / testing::bem_load(row.radius).normal - 1.0;
    UNSCOPED_INFO("r/R " << share << ": " << row.load.normal << " N/m, off " << off << ", tangential " << row.load.tangential);
    if (share > 0.3 && share < 0.9) worst = std::max(worst, std::abs(off));
  }
  CHECK(worst < 0.25);
}

TEST_CASE("the demo rotor's friction by the law of the wall takes power as a rotor's does, which walls that stick miss",
          "[rotor][nightly]") {
  std::vector<double> share;
  for (const Condition blades : {Condition::no_slip, Condition::wall_law}) {
    ResolvedRotorSetup s = demo();
    s.flow.viscous = "full", s.flow.turbulence = "sa", s.flow.viscosity_Pa_s = 1.8e-5, s.flow.blades = blades;
    s.flow.drop = 1e-4;
    ResolvedRotor rotor(s);
    rotor.solver().start_uniform();
    rotor.prepare(MPI_COMM_SELF, {.threads = 1});
    rotor.run();
    const RotorLoad load = rotor.load();
    double friction = 0.0, tangential = 0.0;
    for (const SpanLoad& row : rotor.span_loads())
      friction += row.friction.tangential * row.length * row.radius, tangential += row.load.tangential * row.length * row.radius;
    share.push_back(friction / tangential);
    CAPTURE(int(blades), load.thrust, load.power, share.back(), rotor.solver().march().steps());
    CHECK(rotor.solver().march().verdict() == Verdict::converged);
    CHECK_FALSE(rotor.solver().march().spent());
    CHECK(load.thrust == Approx(1507e3).epsilon(0.15));
  }
  CHECK(std::abs(share[0]) < 0.005);
  CHECK(share[1] < -0.02);
  CHECK(share[1] > -0.08);
}
