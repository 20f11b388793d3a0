// The DTU 10-MW rotor on the default grid, one setting for all winds, against its 2013 report (Bak et al., DTU Wind Energy
// I-0092; tip-speed ratio 7.5) and the normal force along the span by blade element momentum (Madsen's induction, Prandtl's
// losses, cone 2.5 degrees, no tilt). Figures: docs/developer/notes/rotor_resolved.md. SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/aero/bem.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "tests/verification/rotor/bem_rows.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

ResolvedRotorSetup demo(double wind, double rpm, double pitch_deg) {
  ResolvedRotorSetup s;
  s.grid.resolution = 1.0, s.grid.sectors = "one";
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = rpm * pi / 30.0, s.rotor.blade_pitch = pitch_deg * pi / 180.0;
  s.wind = {wind, 0.0, 0.0};
  s.flow.time = "steady", s.flow.turbulence = "sa", s.flow.blades = Condition::wall_function, s.flow.preconditioner = "coarse";
  s.flow.cfl = 2.0, s.flow.cfl_max = 1000.0, s.flow.load_change = 1e-3, s.flow.max_pseudo_steps = 300;
  return s;
}

struct OperatingCase {
  double wind, rpm, pitch_deg, thrust, power;
};

}  // namespace

TEST_CASE("the rotor of default size has the report's thrust to five and its power to ten per cent in every wind",
          "[rotor][nightly]") {
  const auto o =
      GENERATE(OperatingCase{6.0, 6.0, 0.896, 498.1e3, 1532.7e3}, OperatingCase{8.0, 6.4257, 0.0, 797.3e3, 3730.7e3},
               OperatingCase{9.0, 7.229, 0.0, 1009.1e3, 5311.8e3}, OperatingCase{10.0, 8.0322, 0.0, 1245.8e3, 7286.5e3},
               OperatingCase{11.0, 8.8354, 0.0, 1507.4e3, 9698.3e3}, OperatingCase{13.0, 9.6, 7.266, 1082.0e3, 10648.5e3},
               OperatingCase{15.0, 9.6, 10.958, 890.8e3, 10683.7e3}, OperatingCase{20.0, 9.6, 17.618, 668.1e3, 10646.2e3});
  ResolvedRotor rotor(demo(o.wind, o.rpm, o.pitch_deg));
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  rotor.run();
  const RotorLoad load = rotor.load();
  CAPTURE(o.wind, load.thrust, load.power, rotor.solver().cells());
  CHECK(rotor.solver().cells() <= 20000);
  CHECK(rotor.solver().march().verdict == Verdict::converged);
  CHECK(load.thrust == Approx(o.thrust).epsilon(0.05));
  CHECK(load.power == Approx(o.power).epsilon(0.10));
  double friction = 0.0, tangential = 0.0, worst = 0.0;
  for (const SpanLoad& row : rotor.span_loads()) {
    friction += row.friction.tangential * row.length * row.radius, tangential += row.load.tangential * row.length * row.radius;
    const double share = row.radius / 89.166, off = row.load.normal / testing::bem_load(row.radius).normal - 1.0;
    if (share > 0.3 && share < 0.9) worst = std::max(worst, std::abs(off));
  }
  CHECK(friction / tangential < -0.02);
  CHECK(friction / tangential > -0.1);
  if (o.wind == 11.0) CHECK(worst < 0.15);
}

TEST_CASE("rotors of two and four blades on the default grid have the loads of blade elements to five and ten per cent",
          "[rotor][nightly]") {
  const auto [blades, rpm] = GENERATE(std::pair{2, 8.836}, std::pair{2, 10.0}, std::pair{4, 7.0});
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("spindrift_blades_" + std::to_string(getpid()) + ".toml");
  ResolvedRotorSetup setup = demo(11.0, rpm, 0.0);
  std::ofstream(file) << "base = \"" << setup.rotor.turbine << "\"\n[turbine]\nblades = " << blades << "\n";
  setup.rotor.turbine = file.string();
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  const DiscLoad by_elements = BladeElementMomentum(read_turbine(setup.rotor.turbine), "madsen", 1.225)(
      Eigen::Vector3d(11.0 * axis),
      {Eigen::Vector3d::Zero(), setup.rotor.speed * axis, axis, Eigen::Vector3d::UnitZ(), 0.0, 0.0});
  ResolvedRotor rotor(setup);
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  rotor.run();
  std::filesystem::remove(file);
  const double power = by_elements.moment.x() * setup.rotor.speed;
  CAPTURE(blades, rpm, rotor.load().thrust, rotor.load().power, by_elements.force.x(), power, rotor.solver().cells());
  CHECK(rotor.solver().march().verdict == Verdict::converged);
  CHECK(rotor.load().thrust == Approx(by_elements.force.x()).epsilon(0.05));
  CHECK(rotor.load().power == Approx(power).epsilon(0.10));
}
