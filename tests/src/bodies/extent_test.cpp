// How fast a body meets the water. SPDX-License-Identifier: Apache-2.0
#include "src/bodies/extent.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Eigen::Vector3d;

namespace {

constexpr double gravity = 9.81;

/// A ball of 1 m diameter with its centre at this height.
NamedBodies ball(double height, const Vector3d& velocity = Vector3d::Zero()) {
  BodyOptions body;
  body.mass_kg = 100.0, body.centre_m = {0.0, 0.0, height}, body.velocity_m_s = velocity;
  body.spheres = {{"ball", body.centre_m, 1.0}};
  return {{"ball", body}};
}

/// The ball on a rail from the earth, driven or not.
NamedJoints rail(std::optional<DriverOptions> translation) {
  JointOptions joint;
  joint.type = JointType::translational, joint.bodies = {"earth", "ball"}, joint.axis = Vector3d::UnitZ();
  joint.translation = std::move(translation);
  NamedJoints joints;
  joints.push_back({"rail", joint});
  return joints;
}

}  // namespace

TEST_CASE("a free body enters the water with the speed of its fall, a floating one with that of its start", "[bodies][fast]") {
  CHECK(entry_speed(ball(0.0), {}, {}, gravity) == 0.0);
  CHECK(entry_speed(ball(0.0, {3.0, 0.0, -4.0}), {}, {}, gravity) == Approx(5.0));
  CHECK(entry_speed(ball(1.5), {}, {}, gravity) == Approx(std::sqrt(2.0 * gravity * 1.0)));
  CHECK(entry_speed(ball(1.5, {0.0, 0.0, -2.0}), {}, {}, gravity) == Approx(std::sqrt(4.0 + 2.0 * gravity * 1.0)));
}

TEST_CASE("a body falls on a rail that is not level, and on one that a mass rides on with it", "[bodies][fast]") {
  const double falls = std::sqrt(2.0 * gravity);
  CHECK(entry_speed(ball(1.5), rail({}), {}, gravity) == Approx(falls));
  NamedJoints joints = rail({});
  joints[0].options.axis = {1.0, 0.0, 1.0};
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == Approx(falls));
  joints[0].options.axis = Vector3d::UnitX();
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == 0.0);
  joints[0].options.type = JointType::cylindrical;
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == 0.0);
  joints[0].options.type = JointType::planar;
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == Approx(falls));
  joints[0].options.axis = Vector3d::UnitZ();
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == 0.0);
  joints[0].options.type = GENERATE(JointType::fixed, JointType::revolute, JointType::spherical, JointType::universal);
  CHECK(entry_speed(ball(1.5), joints, {}, gravity) == 0.0);
}

TEST_CASE("bodies that are tied together fall as one, until the lowest meets the water", "[bodies][fast]") {
  NamedBodies bodies = ball(1.5);
  BodyOptions mast;
  mast.mass_kg = 1.0, mast.centre_m = {0.0, 0.0, 3.0}, mast.boxes = {{"mast", mast.centre_m, {0.1, 0.1, 2.0}}};
  bodies.push_back({"mast", mast});
  JointOptions weld;
  weld.type = JointType::fixed, weld.bodies = {"ball", "mast"};
  NamedJoints joints;
  joints.push_back({"weld", weld});
  CHECK(entry_speed(bodies, {}, {}, gravity) == Approx(std::sqrt(2.0 * gravity * 2.0)));
  CHECK(entry_speed(bodies, joints, {}, gravity) == Approx(std::sqrt(2.0 * gravity * 1.0)));
  SECTION("where that floats, none falls") {
    bodies[0].options.displacement_m.z() = -1.5;
    CHECK(entry_speed(bodies, joints, {}, gravity) == 0.0);
  }
  SECTION("the earth holds all of them through one") {
    joints.push_back(rail({})[0]);
    CHECK(entry_speed(bodies, joints, {}, gravity) == Approx(std::sqrt(2.0 * gravity * 1.0)));
    joints[1].options.type = JointType::revolute;
    CHECK(entry_speed(bodies, joints, {}, gravity) == 0.0);
  }
  SECTION("a mass that slides up and down on another falls by itself") {
    joints[0].options.type = JointType::translational, joints[0].options.axis = Vector3d::UnitZ();
    bodies[0].options.displacement_m.z() = -1.5;
    CHECK(entry_speed(bodies, joints, {}, gravity) == Approx(std::sqrt(2.0 * gravity * 2.0)));
  }
}

TEST_CASE("a fall ends where the water is", "[bodies][fast]") {
  CHECK(entry_speed(ball(1.5), {}, {}, gravity, -1.0) == Approx(std::sqrt(2.0 * gravity * 2.0)));
  CHECK(entry_speed(ball(1.5), {}, {}, gravity, 1.2) == 0.0);
}

TEST_CASE("a body that is driven from the earth comes with the driver's speed", "[bodies][fast]") {
  DriverOptions steady, swing;
  steady.rate = -2.0, swing.amplitude = 0.5, swing.period_s = 3.14159265358979;
  CHECK(entry_speed(ball(1.5), rail(steady), {}, gravity) == Approx(2.0));
  CHECK(entry_speed(ball(1.5), rail(swing), {}, gravity) == Approx(1.0));
}

TEST_CASE("a nacelle on a flexible tower falls only with what carries it", "[bodies][fast]") {
  NamedBodies bodies = ball(100.0);
  BodyOptions platform;
  platform.mass_kg = 100.0, platform.spheres = {{"float", Vector3d::Zero(), 2.0}};
  bodies.push_back({"platform", platform});
  BeamOptions tower;
  tower.bodies = {"platform", "ball"};
  NamedBeams beams;
  beams.push_back({"tower", tower});
  CHECK(entry_speed(bodies, {}, beams, gravity) == 0.0);
}

TEST_CASE("the box about a cylinder is that of its discs", "[bodies][fast]") {
  BodyOptions body;
  body.cylinders = {{.start_m = {0, 0, -10}, .end_m = {0, 0, 20}, .diameter_m = 8.0, .end_diameter_m = 4.0}};
  CHECK(bounds(body).min().isApprox(Vector3d(-4, -4, -10)));
  CHECK(bounds(body).max().isApprox(Vector3d(4, 4, 20)));
  body.cylinders[0].end_m = {30, 0, -10};
  CHECK(bounds(body).min().isApprox(Vector3d(0, -4, -14)));
  CHECK(bounds(body).max().isApprox(Vector3d(30, 4, -6)));
}

TEST_CASE("a rotor that turns on a platform does not count", "[bodies][fast]") {
  NamedBodies bodies = ball(0.0);
  BodyOptions rotor;
  rotor.mass_kg = 1.0, rotor.centre_m = {0.0, 0.0, 100.0};
  bodies.push_back({"rotor", rotor});
  JointOptions bearing;
  bearing.bodies = {"ball", "rotor"}, bearing.point_m = rotor.centre_m, bearing.axis = Vector3d::UnitX();
  bearing.rotation.emplace().rate = 1.0;
  NamedJoints joints;
  joints.push_back({"bearing", bearing});
  CHECK(entry_speed(bodies, joints, {}, gravity) == 0.0);
}
