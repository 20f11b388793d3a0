// The state a run starts from, its stability, and that a scene pays only for what it names: src/coupling/start.hpp,
// floating_system.hpp. SPDX-License-Identifier: Apache-2.0
#include "src/coupling/start.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"
#include "tests/src/coupling/windows.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

TEST_CASE("the buoy rests where weight, buoyancy and chain balance", "[coupling][fast]") {
  // k_water = rho g pi R^2 = 31416 N/m; the chain is relaxed at the draft of 2 m, where weight = buoyancy: heave 0.
  FloatingSystem floating(test::scenario(test::buoy, {"start.equilibrium=true"}));
  const Start start = make_start(floating);
  REQUIRE(start.equilibrium);
  CHECK(start.state.motions[0].position.z() == Approx(-1.5).margin(1e-7));

  // A force of 4.1416e4 N downwards sinks it by 1 m against both springs.
  FloatingSystem pressed(test::scenario(
      std::string(test::buoy) + "[[bodies.buoy.forces]]\npoint_m=[0.0,0.0,-1.5]\nforce_N=[0.0,0.0,-31415.926535897932]\n",
      {"start.equilibrium=true"}));
  // The chain goes up by what the buoy goes down: k_water z + k_chain z = -F.
  CHECK(make_start(pressed).state.motions[0].position.z() ==
        Approx(-1.5 - 31415.926535897932 / (31415.926535897932 + 1e4)).epsilon(1e-6));
}

TEST_CASE("the equilibrium is that under the mean loads, whatever wave stands there at t = 0", "[coupling][fast]") {
  // Waves of 2 m over a buoy with a draft of 2 m.
  const Eigen::Vector3d still =
      make_start(*std::make_unique<FloatingSystem>(test::scenario(test::buoy, {"start.equilibrium=true"})))
          .state.motions[0]
          .position;
  for (int seed = 1; seed <= 20; ++seed) {
    FloatingSystem floating(
        test::scenario(test::buoy, {"start.equilibrium=true", "sea.model='morison'", "waves.model='jonswap'",
                                    "waves.height_m=2.0", "waves.period_s=6.0", "waves.seed=" + std::to_string(seed)}));
    const Eigen::Vector3d at = make_start(floating).state.motions[0].position;
    CHECK((at - still).norm() < 1e-6);
  }
}

TEST_CASE("waves are not there at once unless the scene says so", "[coupling][fast]") {
  std::vector<std::string> waves{"start.equilibrium=true", "sea.model='morison'", "waves.model='airy'", "waves.height_m=1.0",
                                 "waves.period_s=6.0"};
  CHECK(test::scenario(test::buoy, waves).waves.ramp_s == 12.0);
  waves.push_back("waves.ramp_s=0.0");
  CHECK(test::scenario(test::buoy, waves).waves.ramp_s == 0.0);
}

TEST_CASE("a displaced start is the described position moved and turned about the reference point", "[coupling][fast]") {
  FloatingSystem floating(
      test::scenario(test::buoy, {"bodies.buoy.displacement_m=[0.0,0.0,0.5]", "bodies.buoy.velocity_m_s=[0.1,0.0,0.0]"}));
  const Start start = make_start(floating);
  CHECK(start.state.motions[0].position.z() == Approx(-1.0).margin(1e-14));
  CHECK(start.state.motions[0].velocity.x() == Approx(0.1));
}

TEST_CASE("a start that a hinge does not allow is refused by name, a spin about it takes the body along", "[coupling][fast]") {
  const std::string door = R"(
[time]
end_s = 1.0
window_s = 0.1
[bodies.door]
mass_kg = 10.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
centre_m = [1.0, 0.0, 0.0]
[joints.hinge]
bodies = ["earth", "door"]
point_m = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
)";
  FloatingSystem about(test::scenario(door, {"bodies.door.omega_rad_s=[0.0,0.0,2.0]"}));
  CHECK(make_start(about).state.motions[0].velocity.y() == Approx(2.0));
  FloatingSystem across(test::scenario(door, {"bodies.door.omega_rad_s=[1.0,0.0,2.0]"}));
  CHECK_THROWS_WITH(make_start(across),
                    Contains("bodies.door.omega_rad_s") && Contains("[1, 0, 2]") && Contains("leave [0, 0, 2]"));
  FloatingSystem along(test::scenario(door, {"bodies.door.velocity_m_s=[0.5,0.0,0.0]"}));
  CHECK_THROWS_WITH(make_start(along), Contains("bodies.door.velocity_m_s"));

  FloatingSystem open(test::scenario(door, {"bodies.door.rotation_deg=[0.0,0.0,30.0]"}));
  CHECK(make_start(open).state.motions[0].position.y() == Approx(0.5));  // its centre goes along
  FloatingSystem tilted(test::scenario(door, {"bodies.door.rotation_deg=[20.0,0.0,0.0]"}));
  CHECK_THROWS_WITH(make_start(tilted), Contains("bodies.door.rotation_deg") && Contains("[20, 0, 0]"));
  FloatingSystem lifted(test::scenario(door, {"bodies.door.displacement_m=[0.0,0.0,0.3]"}));
  CHECK_THROWS_WITH(make_start(lifted), Contains("bodies.door.displacement_m") && Contains("[0, 0, 0.3]"));
}

TEST_CASE("a step above the limit of the integrator is refused with limit and mode", "[coupling][fast]") {
  // Heave of the moored buoy: omega^2 = (31416 + 10000) / 6283; symplectic limit 2 / omega.
  const double limit = 2.0 / std::sqrt((31415.926535897932 + 1e4) / 6283.185307179586);
  FloatingSystem floating(test::scenario(test::buoy, {"time.integrator='symplectic'"}));
  const Stability s = stability(floating, make_start(floating).state);
  CHECK(s.limit.step_s == Approx(limit).epsilon(2e-3));
  CHECK(s.limit.mode == "heave of buoy");
  CHECK_NOTHROW(require_stable(floating, s));

  FloatingSystem bold(test::scenario(test::buoy, {"time.integrator='symplectic'", "time.window_s=1.0", "time.step_s=1.0"}));
  CHECK_THROWS_WITH(require_stable(bold, stability(bold, make_start(bold).state)),
                    Contains("time.step_s") && Contains("heave of buoy"));
  FloatingSystem naive(test::scenario(test::buoy, {"time.integrator='explicit_euler'"}));
  CHECK_THROWS_WITH(require_stable(naive, stability(naive, make_start(naive).state)), Contains("not damped"));
}

TEST_CASE("modes of a tower that is let go are those about its equilibrium, where weight softens it", "[coupling][fast]") {
  const std::string tower = SPINDRIFT_SOURCE_DIR "/inputs/validation/dtu_tower/dtu_tower.toml";
  const auto floating = test::floating_of(tower, {});
  const Stability s = stability(*floating, make_start(*floating).state);
  const auto slowest = [](const bodies::Linearisation& l) { return std::abs(l.modes.back().eigenvalue) / (2.0 * pi); };
  CHECK(slowest(s.shown()) == Approx(0.2473).margin(1e-4));
  CHECK(slowest(s.linearisation) == Approx(0.2532).margin(1e-4));
  const auto at_rest = test::floating_of(
      tower, {"start.equilibrium=true", "bodies.nacelle.velocity_m_s=[0.0,0.0,0.0]", "bodies.rotor.velocity_m_s=[0.0,0.0,0.0]"});
  CHECK(slowest(stability(*at_rest, make_start(*at_rest).state).shown()) == Approx(slowest(s.shown())).epsilon(1e-5));
}

TEST_CASE("a driven rotor that is heavier than its nacelle turns, and the nacelle on its tower does not", "[coupling][fast]") {
  const auto floating =
      test::floating_of(SPINDRIFT_SOURCE_DIR "/inputs/validation/dtu_tower/dtu_tower.toml",
                        {"bodies.nacelle.mass_kg=2e5", "bodies.rotor.mass_kg=3e5", "bodies.nacelle.velocity_m_s=[0.0,0.0,0.0]",
                         "bodies.rotor.velocity_m_s=[0.0,0.0,0.0]", "joints.shaft.type='revolute'",
                         "joints.shaft.axis=[1.0,0.0,0.0]", "joints.shaft.rotation.speed_rpm=9.6"});
  const Start start = make_start(*floating);
  CHECK(start.state.motions[0].omega.norm() == 0.0);
  CHECK(start.state.motions[1].omega.x() == Approx(9.6 * rad_s_per_rpm));
}

TEST_CASE("a scene has the sources of load that it names and no others", "[coupling][fast]") {
  const auto names = [](FloatingSystem& floating) {
    std::vector<std::string> result;
    for (const bodies::LoadSource& source : floating.multibody().loads()) result.push_back(source.name);
    return result;
  };
  FloatingSystem full(test::scenario(test::buoy));
  CHECK(names(full) == std::vector<std::string>{"gravity", "moorings", "sea"});
  const std::string bare = R"(
[time]
end_s = 1.0
window_s = 0.1
[bodies.stone]
mass_kg = 1.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
centre_m = [0.0, 0.0, 0.0]
)";
  FloatingSystem empty(test::scenario(bare));
  CHECK(names(empty) == std::vector<std::string>{"gravity"});
}
