// Bodies in the bed and rotors in the water end a run by name: src/coupling/out_of_place.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/out_of_place.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "src/coupling/start.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

TEST_CASE("a body may touch the bed, and is named where it is in it by more than a tenth of its size", "[coupling][fast]") {
  FloatingSystem floating(test::scenario(test::buoy, {"environment.water_depth_m=20.0"}));
  bodies::BodiesState state = make_start(floating).state;
  // The hull reaches from -2 to 2 m about the start: half of its diagonal is sqrt(4 + 1 + 1) m.
  const double start = state.motions[0].position.z(), size = std::sqrt(1.0 + 1.0 + 4.0);
  state.motions[0].position.z() = start - 18.0 - 0.09 * size;
  CHECK(!out_of_place(floating, state));
  state.motions[0].position.z() = start - 18.0 - 0.11 * size;
  const auto found = out_of_place(floating, state);
  REQUIRE(found);
  CHECK_THAT(found->what(), Contains("body buoy") && Contains("in the bed at z = -20 m") && Contains("water_depth_m"));
  CHECK(found->place == "bodies.buoy");
}

TEST_CASE("a rotor is named where its lowest blade is in the water", "[coupling][fast]") {
  const auto at_height = [](const char* z) {
    FloatingSystem floating(test::scenario(
        test::buoy, {"aero.model='thrust_curve'", "aero.thrust_coefficient=0.8", "rotor.body='buoy'", "rotor.diameter_m=10.0",
                     std::string("rotor.hub_m=[0.0,0.0,") + z + "]", "rotor.speed_rpm=10.0", "wind.speed_m_s=8.0"}));
    return out_of_place(floating, make_start(floating).state);
  };
  CHECK(!at_height("5.1"));
  const auto found = at_height("4.0");
  REQUIRE(found);
  CHECK_THAT(found->what(), Contains("the rotor reaches 1 m into the water"));
}

TEST_CASE("a blade that bends by more than a third of its length is named", "[coupling][fast]") {
  const auto found_with = [](const char* structure) {
    FloatingSystem floating(test::scenario("base = \"inputs/leble_barakos/flexible_blades.toml\"\n",
                                           {std::string("rotor.blade_structure='" SPINDRIFT_SOURCE_DIR "/") + structure + "'"}));
    return out_of_place(floating, make_start(floating).state);
  };
  CHECK(!found_with("inputs/turbines/dtu_10mw/blade_structure.csv"));
  const auto found = found_with("tests/extremes/files/blade_rubber.csv");
  REQUIRE(found);
  CHECK_THAT(found->what(), Contains("blade") && Contains("a third of its length"));
  CHECK(found->place == "rotor");
}

TEST_CASE("blades so soft that the air's force follows their bending find their rest", "[coupling][fast]") {
  // The blade of rubber, softer still: passes that go their whole way swing to and fro.
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_softer_blade.csv";
  {
    std::ifstream rubber(SPINDRIFT_SOURCE_DIR "/tests/extremes/files/blade_rubber.csv");
    std::ofstream softer(file);
    for (std::string line; std::getline(rubber, line);) {
      double span, mass, flap, edge, twist;
      if (std::sscanf(line.c_str(), "%lf, %lf, %lf, %lf, %lf", &span, &mass, &flap, &edge, &twist) == 5)
        line = fmt::format("{}, {}, {}, {}, {}", span, mass, 0.7 * flap, 0.7 * edge, twist);
      softer << line << '\n';
    }
  }
  FloatingSystem floating(test::scenario("base = \"inputs/leble_barakos/flexible_blades.toml\"\n",
                                         {"rotor.blade_structure='" + file.string() + "'", "wind.speed_m_s=20.0"}));
  CHECK_NOTHROW(make_start(floating));
}

TEST_CASE("bodies that begin in each other or in the tank are refused by name, unless a joint ties them there",
          "[coupling][fast]") {
  const std::string tank = R"(
[time]
end_s = 1.0
window_s = 0.1
[environment]
water_depth_m = 0.6
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.05
[sea.tank]
x_m = [-1.5, 1.5]
top_m = 0.4
[bodies.box]
mass_kg = 80.0
inertia_kg_m2 = [2.1, 2.1, 2.1]
centre_m = [0.0, 0.0, 0.0]
boxes = [{name = "hull", centre_m = [0.0, 0.0, 0.0], size_m = [0.4, 1.0, 0.4]}]
)";
  const auto room = [&](std::vector<std::string> settings, const std::string& more = "") {
    FloatingSystem floating(test::scenario(tank + more, settings));
    require_room(floating, make_start(floating).state);
  };
  CHECK_NOTHROW(room({}));
  const std::string slope = "sea.tank.bed_m=[[-1.5,-0.6],[-0.3,-0.6],[0.3,0.1]]",
                    block = "sea.obstacles=[{low_m=[0.0,-1.0,-0.6],high_m=[0.3,1.0,-0.1]}]";
  CHECK_THROWS_WITH(room({slope}), Contains("bodies.box") && Contains("deep in the bed"));
  CHECK_THROWS_WITH(room({block}), Contains("deep in sea.obstacles[0]"));
  const std::string held = R"(
[joints.held]
type = "fixed"
bodies = ["earth", "box"]
point_m = [0.0, 0.0, 0.0]
)";
  CHECK_NOTHROW(room({slope}, held));
  const std::string barge = R"(
[bodies.barge]
mass_kg = 80.0
inertia_kg_m2 = [2.1, 2.1, 2.1]
centre_m = [0.3, 0.0, 0.0]
boxes = [{name = "hull", centre_m = [0.3, 0.0, 0.0], size_m = [0.4, 1.0, 0.4]}]
)",
                    hinge = R"(
[joints.hinge]
bodies = ["box", "barge"]
point_m = [0.15, 0.0, 0.0]
axis = [0.0, 1.0, 0.0]
)";
  CHECK_THROWS_WITH(room({}, barge), Contains("bodies.box") && Contains("deep in body barge"));
  CHECK_NOTHROW(room({"bodies.barge.displacement_m=[0.1,0.0,0.0]"}, barge));
  CHECK_NOTHROW(room({}, barge + hinge));

  // Statics know water that is level at z = 0 alone.
  const std::string water = "sea.water=[{low_m=[-1.5,-0.5,-0.6],high_m=[1.5,0.5,";
  const auto at_rest = [&](const std::string& level) {
    FloatingSystem floating(test::scenario(tank, {water + level + "]}]", "start.equilibrium=true"}));
    make_start(floating);
  };
  CHECK_NOTHROW(at_rest("0.0"));
  CHECK_THROWS_WITH(at_rest("-0.2"), Contains("start.equilibrium") && Contains("level at z = 0"));
}
