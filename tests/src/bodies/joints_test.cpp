// Joints, drivers, redundancy and contradiction as the system meets them: src/bodies/system.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/rigid/rotation.hpp"
#include "src/bodies/statics.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;
using Catch::Matchers::Contains;

namespace {

const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();

Body box(std::string name, const Vector3d& at) { return body(std::move(name), 3.0, {1, 2, 2.5}, at); }

}  // namespace

TEST_CASE("each joint leaves its freedoms, between bodies and to the earth", "[bodies][fast]") {
  const auto [type, freedoms] = GENERATE(table<JointType, int>({{JointType::fixed, 0},
                                                                {JointType::revolute, 1},
                                                                {JointType::spherical, 3},
                                                                {JointType::universal, 2},
                                                                {JointType::translational, 1},
                                                                {JointType::cylindrical, 2},
                                                                {JointType::planar, 3}}));
  Joint to_earth = joint("a", type, earth, 0, {0.5, 0.1, 0}, Vector3d(1, 2, 3)),
        between = joint("b", type, 0, 1, {1, 1, 1}, Vector3d(-1, 0, 2));
  to_earth.second_axis = Vector3d(3, 0, -1);
  between.second_axis = Vector3d(2, 5, 1);
  System system({box("first", {0, 0, 0}), box("second", {2, 1, 0})}, {to_earth, between}, {});
  const Assembly assembly = system.assemble();
  CHECK(assembly.contradiction == "");
  CHECK(assembly.redundant.empty());
  CHECK(assembly.degrees_of_freedom == 2 * freedoms);
}

TEST_CASE("a spinning chain of every kind of joint keeps its constraints and its energy", "[bodies][fast]") {
  const auto type = GENERATE(JointType::revolute, JointType::spherical, JointType::universal, JointType::cylindrical);
  std::vector<Body> bodies{box("first", {0.5, 0, 0}), box("second", {1.5, 0.2, 0})};
  bodies[0].initial.omega = {0.5, 1.0, 2.0};
  bodies[1].initial.omega = {-1.0, 0.3, 0.8};
  Joint ball = joint("ball", JointType::spherical, earth, 0, {0, 0, 0}),
        other = joint("other", type, 0, 1, {1, 0.1, 0}, Vector3d(1, 1, 0));
  other.second_axis = Vector3d(1, -1, 0.5);
  System system(bodies, {ball, other}, {gravity_source(bodies, 9.81)});
  BodiesState state = start(system);
  const auto energy = [&] {
    return system.kinetic_energy(state) + 3.0 * 9.81 * (state.motions[0].position.z() + state.motions[1].position.z());
  };
  const double before = energy();
  run(system, state, 5e-4, 4000);
  CHECK(energy() == Approx(before).margin(1e-7));
  CHECK(system.constraint_residual(state, 2.0) < 1e-12);
}

TEST_CASE("a driver turns its joint at its rate over many turns, whatever it carries", "[bodies][fast]") {
  std::vector<Body> bodies{box("stand", {0, 0, 0}), box("rotor", {0.3, 0, 1})};
  Joint bearing = joint("bearing", JointType::revolute, 0, 1, {0, 0, 1}, x);
  bearing.rotation = PrescribedMotion{.rate = 5.0};
  System system(bodies, {joint("foot", JointType::spherical, earth, 0, {0, 0, -1}), bearing}, {gravity_source(bodies, 9.81)});
  BodiesState state = start(system);
  CHECK(state.motions[0].omega.norm() == 0.0);  // assembly starts the rotor, not its stand
  CHECK(state.motions[1].omega.x() == Approx(5.0));
  run(system, state, 1e-3, 10000);
  CHECK(state.joint_angles[1] == Approx(50.0).margin(1e-9));
  CHECK(system.constraint_residual(state, 10.0) < 1e-12);
}

TEST_CASE("a driven rotor turns on what the earth or a beam holds, however heavy it is", "[bodies][fast]") {
  const bool on_beam = GENERATE(false, true), first = GENERATE(false, true);
  std::vector<Body> bodies{box("nacelle", {0, 0, 0}), box("rotor", {0.3, 0, 1})};
  bodies[1].mass = 5.0;
  bodies[1].gyroscopic = false;
  bodies[0].on_beam = on_beam;
  Joint bearing = joint("bearing", JointType::revolute, first ? 1 : 0, first ? 0 : 1, {0, 0, 1}, x);
  bearing.rotation = PrescribedMotion{.rate = first ? -5.0 : 5.0};
  std::vector<Joint> joints{bearing};
  if (!on_beam) joints.push_back(joint("foot", JointType::spherical, earth, 0, {0, 0, -1}));
  System system(bodies, joints, {});
  const BodiesState state = start(system);
  CHECK(state.motions[0].omega.norm() == 0.0);
  CHECK(state.motions[1].omega.x() == Approx(5.0));
  const BodiesState rest = find_equilibrium(system, state, 0.0).state;
  CHECK(rest.motions[0].omega.norm() == 0.0);
  CHECK(rest.motions[1].omega.x() == Approx(5.0));
}

TEST_CASE("a prescribed slide moves its body along the axis and reports the force it takes", "[bodies][fast]") {
  const std::vector<Body> bodies{box("sledge", {0, 0, 0})};
  Joint rail = joint("rail", JointType::translational, earth, 0, {0, 0, 0}, x);
  rail.translation = PrescribedMotion{.amplitude = 0.5, .omega = 2.0};
  System system(bodies, {rail}, {gravity_source(bodies, 9.81)});
  BodiesState state = start(system);
  run(system, state, 1e-2, 130);
  CHECK(state.motions[0].position.x() == Approx(0.5 * std::sin(2.6)).margin(1e-12));
  CHECK(state.motions[0].velocity.x() == Approx(std::cos(2.6)).margin(1e-12));
  const Evaluation& now = system.evaluate(state, 1.3);
  CHECK(now.acceleration[0].x() == Approx(-2.0 * std::sin(2.6)).margin(1e-11));
  CHECK(now.joint_reactions[0].force.x() == Approx(3.0 * -2.0 * std::sin(2.6)).margin(1e-10));
  CHECK(now.joint_reactions[0].force.z() == Approx(3.0 * 9.81).margin(1e-10));  // the rail carries the weight
  CHECK(now.by_source[0][0].force.z() == Approx(-3.0 * 9.81));
}

TEST_CASE("the reaction of a cantilever is its weight and its moment about the clamp", "[bodies][fast]") {
  const std::vector<Body> bodies{box("arm", {2, 0, 0})};
  System system(bodies, {joint("clamp", JointType::fixed, earth, 0, {0, 0, 0})}, {gravity_source(bodies, 10.0)});
  const Wrench reaction = system.evaluate(start(system), 0.0).joint_reactions[0];
  CHECK((reaction.force - Vector3d(0, 0, 30)).norm() < 1e-12);
  CHECK((reaction.about({0, 0, 0}).moment - Vector3d(0, -60, 0)).norm() < 1e-12);  // holds the arm up against a weight at x = 2
}

TEST_CASE("redundant joints are handled and named", "[bodies][fast]") {
  const std::vector<Body> bodies{box("door", {0.5, 0, 0})};
  System system(bodies,
                {joint("upper hinge", JointType::revolute, earth, 0, {0, 0, 1}, z),
                 joint("lower hinge", JointType::revolute, earth, 0, {0, 0, -1}, z)},
                {point_load_source("push", {{.body = 0, .moment = {0, 0, 4.5}}})});
  const Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  CHECK(assembly.degrees_of_freedom == 1);
  std::string all;
  for (const std::string& line : assembly.redundant) all += line;
  CHECK_THAT(all, Contains("hinge") && Contains("repeats") && Contains("follow from"));
  BodiesState state = assembly.state;
  run(system, state, 1e-2, 100);
  CHECK(state.joint_angles[0] == Approx(0.5 * 4.5 / (2.5 + 3.0 * 0.25)).epsilon(1e-8));
}

TEST_CASE("contradictory joints are refused by name", "[bodies][fast]") {
  const std::vector<Body> bodies{box("door", {0.5, 0, 0})};
  Joint hinge = joint("hinge", JointType::revolute, earth, 0, {0, 0, 0}, z),
        motor = joint("motor", JointType::revolute, earth, 0, {0, 0, 0}, z);
  hinge.rotation = PrescribedMotion{.rate = 1.0};
  SECTION("two drivers of different rates on one axis") {
    motor.rotation = PrescribedMotion{.rate = 2.0};
    CHECK_THAT(System(bodies, {hinge, motor}, {}).assemble().contradiction,
               Contains("velocities") && Contains("'hinge'") && Contains("'motor'"));
  }
  SECTION("two drivers that start at different angles") {
    motor.rotation = PrescribedMotion{.start = 0.5, .rate = 1.0};
    CHECK_THAT(System(bodies, {hinge, motor}, {}).assemble().contradiction, Contains("'hinge'") && Contains("'motor'"));
  }
  SECTION("a driver on a body that is clamped") {
    CHECK_THAT(System(bodies, {hinge, joint("clamp", JointType::fixed, earth, 0, {0, 0, 0})}, {}).assemble().contradiction,
               Contains("'clamp'") || Contains("'hinge'"));
  }
  SECTION("the same rates agree") {
    motor.rotation = PrescribedMotion{.rate = 1.0};
    CHECK(System(bodies, {hinge, motor}, {}).assemble().contradiction == "");
  }
}

TEST_CASE("hinges that agree at the start but not in motion stop the run and name themselves", "[bodies][fast]") {
  // Two drivers with equal angle and rate at t = 0 and different accelerations: nothing to see in the assembly.
  std::vector<Body> bodies{box("door", {0.5, 0, 0})};
  Joint hinge = joint("hinge", JointType::revolute, earth, 0, {0, 0, 0}, z), motor = hinge;
  motor.name = "motor";
  hinge.rotation = PrescribedMotion{.rate = 1.0};
  motor.rotation = PrescribedMotion{.amplitude = 0.5, .omega = 2.0};
  System system(bodies, {hinge, motor}, {});
  BodiesState state = start(system);
  StepReport report;
  int steps = 0;
  while ((report = system.advance(state, 1e-2, 1)).ok() && steps < 1000) ++steps;
  REQUIRE(steps < 1000);
  CHECK(report.trouble == StepReport::Trouble::inconsistent);
  CHECK_THAT(system.describe(report), Contains("'hinge'") || Contains("'motor'"));
  const NumericalFailure failure = system.failure(report, state, 1e-2);
  CHECK(failure.step == state.tick);
  CHECK(failure.place.size() > 0);
}

TEST_CASE("bodies of very different mass in one chain", "[bodies][fast]") {
  const double ratio = GENERATE(1e-6, 1e-3, 1e3, 1e6);
  std::vector<Body> bodies{rod("upper", 1.0, {0, 0, 0}, {1, 0, 0}), rod("lower", ratio, {1, 0, 0}, {2, 0, 0})};
  System system(
      bodies,
      {joint("top", JointType::revolute, earth, 0, {0, 0, 0}, y), joint("middle", JointType::revolute, 0, 1, {1, 0, 0}, y)},
      {gravity_source(bodies, 9.81)});
  BodiesState state = start(system);
  run(system, state, 1e-3, 3000);
  const double energy =
      system.kinetic_energy(state) + 9.81 * (state.motions[0].position.z() + ratio * state.motions[1].position.z());
  CHECK(std::abs(energy) < 1e-5 * (1.0 + ratio));
  CHECK(system.constraint_residual(state, 3.0) < 1e-12);
}

TEST_CASE("a door on a spring swings about its rest at its frequency and gives the spring's energy to the damper",
          "[bodies][fast]") {
  // Inertia about the hinge 2.5 + 3 x 1 = 5.5 kg m2, spring 50 N m/rad about 0.3 rad: omega = sqrt(50 / 5.5).
  const double damping = GENERATE(0.0, 2.0), quadratic = GENERATE(0.0, 0.5);
  const std::vector<Body> bodies{box("door", {1, 0, 0})};
  const JointLaw spring{.i = earth,
                        .j = 0,
                        .axis = z,
                        .point_j = {-1, 0, 0},
                        .stiffness = 50.0,
                        .rest = 0.3,
                        .damping = damping,
                        .quadratic_damping = quadratic};
  System system(bodies, {joint("hinge", JointType::revolute, earth, 0, {0, 0, 0}, z)}, {joint_law_source({spring})});
  BodiesState state = start(system);
  const auto energy = [&] {
    const double off = spring.deflection(state.motions).place - 0.3;
    return system.kinetic_energy(state) + 25.0 * off * off;
  };
  const double before = energy(), period = 2.0 * pi * std::sqrt(5.5 / 50.0);
  double lost = 0.0;
  for (int n = 0; n < 4000; ++n) {
    const double rate = spring.deflection(state.motions).rate;
    run(system, state, 0.25e-3 * period, 1);
    const double next = spring.deflection(state.motions).rate, middle = 0.5 * (rate + next);
    lost += 0.25e-3 * period * (damping + quadratic * std::abs(middle)) * middle * middle;
  }
  CHECK(energy() == Approx(before - lost).epsilon(1e-5));
  if (damping + quadratic == 0.0) CHECK(spring.deflection(state.motions).place == Approx(0.0).margin(1e-9));  // a whole period
}

TEST_CASE("a spring of a joint that turns right round does no work in a turn, wherever it rests", "[bodies][fast]") {
  const JointLaw spring{.i = earth, .j = 0, .axis = z, .stiffness = 50.0, .rest = GENERATE(0.0, pi / 2, -pi / 2, pi)};
  constexpr int places = 3600;
  double work = 0.0, most = 0.0;
  for (int n = 0; n < places; ++n) {
    Motion door;
    door.attitude = Eigen::AngleAxisd(2.0 * pi * (n + 0.5) / places, z);
    const double moment = spring.load(spring.deflection(std::span(&door, 1)));
    work += 2.0 * pi / places * moment, most = std::max(most, std::abs(moment));
  }
  CHECK(most == Approx(50.0 * pi).epsilon(1e-3));
  CHECK(std::abs(work) < 1e-3 * most);
}

TEST_CASE("a slider between two free bodies pulls both, and its friction brings it to rest", "[bodies][fast]") {
  const std::vector<Body> bodies{box("first", {0, 0, 0}), box("second", {2, 0, 0})};
  JointLaw law{.i = 0, .j = 1, .axis = x, .point_i = {1, 0, 0}, .point_j = {-1, 0, 0}, .turns = false, .friction = 3.0};
  std::vector<Body> moving = bodies;
  moving[1].initial.velocity = {2, 0, 0};
  System system(moving, {joint("slide", JointType::translational, 0, 1, {1, 0, 0}, x)}, {joint_law_source({law})});
  BodiesState state = start(system);
  const double speed = law.deflection(state.motions).rate;
  const Vector3d together = state.motions[0].velocity + state.motions[1].velocity;
  REQUIRE(speed > 0.5);
  // Both slow down against each other by 3 N (1/3 + 1/3) 1/kg = 2 m/s2.
  run(system, state, 1e-3, 100);
  CHECK(law.deflection(state.motions).rate == Approx(speed - 0.2));
  run(system, state, 1e-3, 2000);
  CHECK(std::abs(law.deflection(state.motions).rate) < 1e-6);
  CHECK(law.deflection(state.motions).place == Approx(0.25 * speed * speed).epsilon(0.01));
  CHECK((state.motions[0].velocity + state.motions[1].velocity - together).norm() < 1e-9);  // momentum
}
