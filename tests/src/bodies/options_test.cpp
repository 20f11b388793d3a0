// [bodies.NAME] and [joints.NAME]: what is read, what it becomes, and what is refused with which words.
// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/options.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "kernels/rigid/rotation.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

struct Read {
  NamedBodies bodies;
  NamedJoints joints;
};

Read read(const std::string& text) {
  scene::Document document = scene::parse(text, "test.toml", std::filesystem::temp_directory_path());
  Read result{document.read_named(body_section()), document.read_named(joint_section())};
  check_bodies(document, result.bodies, result.joints);
  document.finish();
  return result;
}

const std::string mass = "mass_kg = 2.0\ninertia_kg_m2 = [1.0, 1.5, 2.0]\n";
const std::string platform = "[bodies.platform]\n" + mass + "centre_m = [0, 0, 10]\nreference_m = [0, 0, -4]\n";
const std::string rotor = "[bodies.rotor]\n" + mass + "centre_m = [1, 0, 100]\n";
const std::string bearing = "[joints.bearing]\nbodies = ['platform', 'rotor']\npoint_m = [0, 0, 100]\naxis = [2, 0, 0]\n";

}  // namespace

TEST_CASE("the declarations of bodies and joints are sound in themselves", "[bodies][fast]") {
  CHECK(body_section().faults().empty());
  CHECK(joint_section().faults().empty());
}

TEST_CASE("a scene's bodies and joints become those of the system", "[bodies][fast]") {
  const Read scene = read(platform + "gyroscopic = false\n" + rotor + bearing + "[joints.bearing.rotation]\nspeed_rpm = 60.0\n");
  const std::vector<Body> bodies = make_bodies(scene.bodies);
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0].name == "platform");
  CHECK(bodies[0].mass == 2.0);
  CHECK_FALSE(bodies[0].gyroscopic);
  CHECK(bodies[1].gyroscopic);
  CHECK(bodies[0].inertia(1, 1) == 1.5);
  const std::vector<Joint> joints = make_joints(scene.joints, scene.bodies);
  REQUIRE(joints.size() == 1);
  CHECK(joints[0].i == 0);
  CHECK(joints[0].j == 1);
  CHECK(joints[0].axis == Vector3d::UnitX());
  CHECK(joints[0].rotation->at(0.5).value == Approx(pi));
  CHECK(joints[0].rotation->at(0.5).rate == Approx(2 * pi));
}

TEST_CASE("a body starts displaced and turned about its reference point", "[bodies][fast]") {
  const Read scene = read(platform + "displacement_m = [1, 0, 0.5]\nrotation_deg = [0, 90, 0]\nomega_rad_s = [0, 0, 3]\n");
  const Motion m = start_motion(scene.bodies[0].options);
  CHECK((m.position - Vector3d(15, 0, -3.5)).norm() < 1e-12);  // the centre, 14 m above the reference, goes over to +x
  CHECK(euler_angles(m.attitude).y() == Approx(pi / 2));
  CHECK((m.omega_earth() - Vector3d(0, 0, 3)).norm() < 1e-15);
}

TEST_CASE("cylinders and forces are moved to body axes from the centre of mass", "[bodies][fast]") {
  const Read scene =
      read(platform +
           "[[bodies.platform.cylinders]]\nname = 'float'\nstart_m = [3, 0, -14]\nend_m = [3, 0, 6]\ndiameter_m = 4\n"
           "[[bodies.platform.forces]]\npoint_m = [0, 1, 12]\nforce_N = [5, 0, 0]\nfollows_body = true\n");
  const BodyOptions& options = scene.bodies[0].options;
  const Cylinder cylinder = make_cylinder(options.cylinders.at(0), options);
  CHECK(cylinder.start == Vector3d(3, 0, -24));
  CHECK(cylinder.end == Vector3d(3, 0, -4));
  CHECK(cylinder.start_radius == 2.0);
  CHECK(cylinder.end_radius == 2.0);
  const std::vector<PointLoad> loads = make_point_loads(scene.bodies);
  REQUIRE(loads.size() == 1);
  CHECK(loads[0].point == Vector3d(0, 1, 2));
  CHECK(loads[0].follows_body);
  // The load acts where it was put, turned with the body.
  Motion m;
  m.attitude = attitude({0, 0, pi / 2});
  std::vector<Wrench> wrench(1);
  point_load_source("forces", loads).loads(0.0, std::span(&m, 1), wrench);
  CHECK((wrench[0].force - Vector3d(0, 5, 0)).norm() < 1e-14);
  CHECK((wrench[0].moment - Vector3d(-10, 0, -5)).norm() < 1e-14);  // arm (-1, 0, 2)
}

TEST_CASE("a driver may follow a table in time", "[bodies][fast]") {
  std::ofstream(std::filesystem::temp_directory_path() / "spindrift_driver_test.csv") << "time_s,angle_deg\n0,0\n1,90\n2,180\n";
  const Read scene = read(platform + rotor + bearing + "[joints.bearing.rotation]\ntable = 'spindrift_driver_test.csv'\n");
  const std::vector<Joint> joints = make_joints(scene.joints, scene.bodies);
  CHECK(joints[0].rotation->at(1.0).value == Approx(pi / 2));
  CHECK(joints[0].rotation->at(1.5).rate == Approx(pi / 2));
}

TEST_CASE("a joint's law is read in degrees, and its table gives the load on the second body", "[bodies][fast]") {
  std::ofstream(std::filesystem::temp_directory_path() / "spindrift_law_test.csv")
      << "angle_deg,moment_N_m\n-90,200\n0,0\n90,-50\n";
  const Read scene = read(platform + rotor + bearing +
                          "[joints.bearing.rotation_law]\nstiffness_N_m_rad = 7.0\nrest_deg = 90.0\ndamping_N_m_s_rad = 2.0\n"
                          "table = 'spindrift_law_test.csv'\n");
  const std::vector<JointLaw> laws = make_joint_laws(scene.joints, scene.bodies);
  REQUIRE(laws.size() == 1);
  CHECK(laws[0].turns);
  CHECK(laws[0].point_j == Vector3d(-1, 0, 0));
  CHECK(laws[0].load({pi / 4, 0.5}) == Approx(7.0 * pi / 4 - 1.0 - 25.0));
  CHECK(laws[0].load({-3.0, 0.0}) == Approx(7.0 * (3.0 + pi / 2 - 2.0 * pi) + 200.0));  // the first row holds
}

TEST_CASE("a fixed joint needs no point: it is the centre of mass of the second body", "[bodies][fast]") {
  const auto point = [](const std::string& tied) {
    const Read scene = read(platform + rotor + "[joints.weld]\ntype = 'fixed'\n" + tied);
    return make_joints(scene.joints, scene.bodies)[0].point;
  };
  CHECK(point("bodies = ['platform', 'rotor']\n") == Vector3d(1, 0, 100));
  CHECK(point("bodies = ['earth', 'platform']\n") == Vector3d(0, 0, 10));
  CHECK(point("bodies = ['platform', 'earth']\n") == Vector3d(0, 0, 10));
  CHECK(point("bodies = ['earth', 'platform']\npoint_m = [0, 0, -4]\n") == Vector3d(0, 0, -4));
}

TEST_CASE("published inertias of a flat body, rounded, are a body's", "[bodies][fast]") {
  // The ITI barge of OpenFAST's tests: 7e-5 beyond what a plate has.
  const Read scene =
      read("[bodies.barge]\nmass_kg = 5452000\ninertia_kg_m2 = [726.9e6, 726.9e6, 1453.9e6]\ncentre_m = [0, 0, 0]\n");
  CHECK(make_bodies(scene.bodies)[0].inertia(2, 2) == 1453.9e6);
}

TEST_CASE("a malformed body or joint is refused with what is wrong", "[bodies][fast]") {
  struct Case {
    std::string text, message;
  };
  const auto c = GENERATE(
      Case{"", "at least one [bodies.NAME]"}, Case{"[bodies.a]\nmass_kg = 1\ncentre_m = [0, 0, 0]\n", "inertia_kg_m2"},
      Case{"[bodies.a]\nmass_kg = -1\ninertia_kg_m2 = [1, 1, 1]\ncentre_m = [0, 0, 0]\n", "mass_kg"},
      Case{"[bodies.a]\nmass_kg = 1\ninertia_kg_m2 = [1, 1, 3]\ncentre_m = [0, 0, 0]\n", "no mass can have it"},
      Case{"[bodies.a]\nmass_kg = 1\ninertia_kg_m2 = [1, 1, 2.01]\ncentre_m = [0, 0, 0]\n", "no mass can have it"},
      Case{"[bodies.a]\nmass_kg = 1\ninertia_kg_m2 = [1, 1, -1]\ncentre_m = [0, 0, 0]\n", "positive definite"},
      Case{"[bodies.earth]\n" + mass + "centre_m = [0, 0, 0]\n", "fixed frame"},
      Case{platform + "[joints.a]\nbodies = ['platform', 'rotr']\npoint_m = [0, 0, 0]\naxis = [1, 0, 0]\n",
           "known: platform, earth"},
      Case{platform + "[joints.a]\nbodies = ['platform', 'platform']\npoint_m = [0, 0, 0]\naxis = [1, 0, 0]\n",
           "two different bodies"},
      Case{platform + "[joints.a]\nbodies = ['platform', 'earth']\naxis = [1, 0, 0]\n", "is needed by a revolute joint"},
      Case{platform + "[joints.a]\nbodies = ['platform']\npoint_m = [0, 0, 0]\naxis = [1, 0, 0]\n", "bodies"},
      Case{platform + "[joints.a]\nbodies = ['platform', 'earth']\npoint_m = [0, 0, 0]\naxis = [0, 0, 0]\n", "not zero"},
      Case{platform + "[joints.a]\ntype = 'hinge'\nbodies = ['platform', 'earth']\npoint_m = [0, 0, 0]\n", "revolute"},
      Case{platform + "[joints.a]\ntype = 'universal'\nbodies = ['platform', 'earth']\npoint_m = [0, 0, 0]\naxis = [1, 0, 0]\n"
                      "second_axis = [2, 0, 0]\n",
           "parallel"},
      Case{platform + rotor + bearing + "[joints.bearing.translation]\nspeed_m_s = 1.0\n",
           "only where type is translational or cylindrical"},
      Case{platform + rotor + bearing + "[joints.bearing.translation_law]\nstiffness_N_m = 1.0\n",
           "only where type is translational or cylindrical"},
      Case{platform + rotor + bearing + "[joints.bearing.rotation_law]\nrest_deg = 1.0\n", "the law has no effect"},
      Case{platform + rotor + bearing +
               "[joints.bearing.rotation]\nspeed_rpm = 1.0\n[joints.bearing.rotation_law]\nfriction_N_m = 1.0\n",
           "cannot stand beside rotation"},
      Case{platform + rotor + bearing + "[joints.bearing.rotation]\namplitude_deg = 5.0\n", "period_s"},
      Case{platform + rotor + bearing + "[joints.bearing.rotation]\nspeed_m_s = 1.0\n", "speed_m_s"});
  CHECK_THROWS_WITH(read(c.text), Contains(c.message));
}
