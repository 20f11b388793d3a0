// Laws of src/scene/section.hpp: declarations read, and sound in themselves.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/section.hpp"

#include <catch2/catch.hpp>

#include "src/scene/document.hpp"
#include "tests/src/scene/example_sections.hpp"

using namespace spindrift;
using namespace spindrift::scene;

TEST_CASE("a scene fills plain options, defaults where it says nothing", "[scene][fast]") {
  Document doc = parse(R"(
[time]
end_s = 150          # an integer is a number
integrator = "euler"
[bodies.platform]
mass_kg = 4223938.0
inertia_kg_m2 = [[1.0, 0.5, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 3.0]]
centre_m = [0.0, 1.0, -4]
[[bodies.platform.cylinders]]
diameter_m = 11.25
[[bodies.platform.cylinders]]
diameter_m = 5.0
name = "second"
[bodies.buoy]
mass_kg = 3
pitch_deg = 45
[moorings.line_1]
body = "platform"
axial_stiffness_N = 4e8
[sea]
model = "sph"
current_m_s = [1.0, 0.0, 0.0]
probes_m = [1.0, 2]
bodies = ["platform"]
profile_m = [[0.0, -20.0], [50.0, -10.0]]
grid.cells = 7
)",
                       "test.toml", "/");
  const auto time = doc.read(example::time_section());
  CHECK(time.end_s == 150.0);
  CHECK(time.window_s == 0.1);
  CHECK(time.integrator == example::Integrator::euler);
  CHECK_FALSE(time.seed);
  const auto bodies = doc.read_named(example::body_section());
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0].name == "platform");  // file order, not the alphabet's
  CHECK(bodies[0].options.inertia_kg_m2(1, 0) == 0.5);
  CHECK(bodies[0].options.cylinders.at(1).name == "second");
  CHECK(bodies[0].options.cylinders.at(0).diameter_m == 11.25);
  CHECK(bodies[1].options.pitch == Approx(pi / 4));
  CHECK(bodies[1].options.inertia_kg_m2 == Eigen::Matrix3d::Identity());
  const auto lines = doc.read_named(example::line_section());
  CHECK(lines.at(0).options.axial_stiffness_N.value() == 4e8);
  const auto sea = doc.read(example::sea_section());
  CHECK(sea.profile_m == std::vector<std::array<double, 2>>{{0.0, -20.0}, {50.0, -10.0}});
  CHECK(sea.grid.value().cells == 7);
  CHECK(sea.probes_m == std::vector<double>{1.0, 2.0});
  CHECK_NOTHROW(doc.finish());
}

TEST_CASE("the example declarations are sound", "[scene][fast]") {
  for (const SectionBase* section : example::sections()) CHECK(section->faults() == std::vector<std::string>{});
}
