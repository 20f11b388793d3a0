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

TEST_CASE("a body on a joint does not fall; one that is driven from the earth comes with the driver's speed", "[bodies][fast]") {
  CHECK(entry_speed(ball(1.5), rail({}), {}, gravity) == 0.0);
  DriverOptions steady, swing;
  steady.rate = -2.0, swing.amplitude = 0.5, swing.period_s = 3.14159265358979;
  CHECK(entry_speed(ball(1.5), rail(steady), {}, gravity) == Approx(2.0));
  CHECK(entry_speed(ball(1.5), rail(swing), {}, gravity) == Approx(1.0));
}

TEST_CASE("a nacelle on a flexible tower does not fall into the water", "[bodies][fast]") {
  BeamOptions tower;
  tower.bodies = {"platform", "ball"};
  NamedBeams beams;
  beams.push_back({"tower", tower});
  CHECK(entry_speed(ball(100.0), {}, beams, gravity) == 0.0);
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
