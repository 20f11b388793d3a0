// Static equilibrium: src/bodies/statics.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/statics.hpp"

#include <catch2/catch.hpp>

#include "kernels/rigid/rotation.hpp"
#include "tests/src/bodies/platform.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;
using Catch::Matchers::Contains;

TEST_CASE("the paper's platform under 1500 kN rests at its heave, pitch and surge", "[bodies][fast]") {
  System system = Platform{.thrust = 1.5e6}.system();
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  REQUIRE(rest.problem == "");
  CHECK(rest.unstable == "");
  CHECK(rest.free_directions.empty());
  const Motion& m = rest.state.motions[0];
  const Vector3d reference = m.point({0, 0, -4.1 - Platform::centre});
  CHECK(reference.z() + 4.1 == Approx(-0.603).margin(0.03));
  CHECK(euler_angles(m.attitude).y() / radians_per_degree == Approx(5.2).margin(0.2));
  CHECK(reference.x() == Approx(0.215).margin(0.03));
  CHECK(m.velocity.norm() == 0.0);
  CHECK(rest.state.motions[1].omega.x() == Approx(8.8 * rad_s_per_rpm));  // the driver turns the rotor on
  // It is at rest: accelerations vanish, and the moorings alone carry the thrust.
  const Evaluation& now = system.evaluate(rest.state, 0.0);
  CHECK(now.acceleration[0].norm() < 1e-8);
  CHECK(now.by_source[3][0].force.x() == Approx(-1.5e6).epsilon(1e-7));
}

TEST_CASE("yaw without moorings has no stiffness: it is left alone and reported", "[bodies][fast]") {
  System system = Platform{.moored = false}.system();
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  REQUIRE(rest.problem == "");
  const double draft = (4223938.0 + 227962.0) / (1025.0 * 3 * pi * 5.625 * 5.625);
  CHECK(rest.state.motions[0].position.z() - Platform::centre == Approx(14.0 - draft).epsilon(1e-9));  // 14.565 m
  CHECK(rest.free_directions.size() == 3);
  CHECK_THAT(rest.free_directions, Catch::Matchers::VectorContains(std::string("yaw of platform")));
}

TEST_CASE("a load on a direction without stiffness has no equilibrium and says which", "[bodies][fast]") {
  System system = Platform{.thrust = 1.5e6, .moored = false}.system();
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  CHECK_THAT(rest.problem, Contains("no equilibrium") && Contains("surge of platform") && Contains("no stiffness"));
}

TEST_CASE("a pendulum let go near the top comes to rest at the bottom", "[bodies][fast]") {
  const double angle = GENERATE(0.5, 3.0);
  Body bob = body("bob", 2.0, {1e-3, 1e-3, 1e-3}, {std::sin(angle), 0, -std::cos(angle)});
  const std::vector<Body> bodies{bob};
  System system(bodies, {joint("pivot", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0})}, {gravity_source(bodies, 9.81)});
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  REQUIRE(rest.problem == "");
  CHECK(rest.unstable == "");
  CHECK((rest.state.motions[0].position - Vector3d(0, 0, -1)).norm() < 1e-8);
  CHECK(rest.state.joint_angles[0] == Approx(angle).margin(1e-8));  // turned about +y, down from +x
}

TEST_CASE("an unstable equilibrium is named, a body that falls for ever refused", "[bodies][fast]") {
  Body bob = body("bob", 2.0, {1e-3, 1e-3, 1e-3}, {0, 0, 1});
  const std::vector<Body> bodies{bob};
  System top(bodies, {joint("pivot", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0})}, {gravity_source(bodies, 9.81)});
  CHECK_THAT(find_equilibrium(top, start(top), 0.0).unstable, Contains("of bob"));
  System falling(bodies, {}, {gravity_source(bodies, 9.81)});
  CHECK_THAT(find_equilibrium(falling, start(falling), 0.0).problem, Contains("heave of bob"));
}

TEST_CASE("a round float that a constant moment heels is not unstable: it neither stays nor goes in yaw", "[bodies][fast]") {
  const std::vector<Body> bodies{body("float", 2.0, {3.0, 3.0, 3.0}, {0, 0, 0})};
  const LoadSource rights{"rights",
                          [](double, std::span<const Motion> m, std::span<Wrench> w) {
                            w[0].add_force(-100.0 * m[0].position, m[0].position);
                            w[0].add_moment(100.0 * (m[0].attitude * Vector3d::UnitZ()).cross(Vector3d::UnitZ()));
                            w[0].add_moment({0, 50.0, 0});
                          },
                          {}};
  System system(bodies, {}, {rights});
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  REQUIRE(rest.problem == "");
  CHECK(euler_angles(rest.state.motions[0].attitude).y() == Approx(pi / 6.0));
  CHECK(rest.unstable == "");
}

TEST_CASE("rest a hundred metres away takes some forty iterations, with a stiff part that turns along", "[bodies][fast]") {
  // A rod on a soft spring under a side force; a second body on it by a spring a million times as stiff, as a tower's pull.
  const std::vector<Body> bodies{body("hull", 1e6, {1e9, 1e9, 1e9}, {0, 0, -50}), body("top", 1e5, {1e7, 1e7, 1e7}, {0, 0, 50})};
  const LoadSource springs{"springs",
                           [](double, std::span<const Motion> m, std::span<Wrench> w) {
                             w[0].add_force(-1e4 * (m[0].position - Vector3d(0, 0, -50)) + Vector3d(1e6, 0, 0), m[0].position);
                             w[0].add_moment(-1e9 * euler_angles(m[0].attitude) + Vector3d(0, 2e8, 0));
                             const Vector3d foot = m[0].point({0, 0, 100}), pull = -1e10 * (m[1].position - foot);
                             w[1].add_force(pull, m[1].position), w[0].add_force(-pull, foot);
                             w[1].add_moment(-1e9 * euler_angles(m[1].attitude));
                           },
                           {}};
  System system(bodies, {}, {springs});
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  REQUIRE(rest.problem == "");
  CHECK(rest.state.motions[0].position.x() == Approx(100.0));
  CHECK(euler_angles(rest.state.motions[0].attitude).y() == Approx(0.2));
  CHECK(rest.iterations < 50);  // 20 of 5 m each, halved where the stiff part turns, and Newton's last few
}
