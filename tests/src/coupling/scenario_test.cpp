// Rules between the sections of a scene: src/coupling/scenario.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/scenario.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "src/aero/turbulence_box.hpp"
#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

namespace {

std::string refusal(const std::vector<std::string>& overrides, const std::string& more = "") {
  try {
    test::scenario(std::string(test::buoy) + more, overrides);
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("every section of the program declares its parameters without fault", "[coupling][fast]") {
  for (const scene::SectionBase* section : all_sections()) {
    INFO(section->name());
    CHECK(section->faults() == std::vector<std::string>{});
  }
}

TEST_CASE("a scene that is right is read without complaint", "[coupling][fast]") {
  const Scenario s = test::scenario(test::buoy);
  CHECK(s.has_sea());
  CHECK_FALSE(s.has_rotor());
  CHECK(s.time.step() == 0.02);
  CHECK(s.moorings.at(0).options.stiffness_N_m == 1.0e4);
}

TEST_CASE("what has no effect or contradicts itself is refused by name", "[coupling][fast]") {
  CHECK_THAT(refusal({"time.step_s=0.03"}), Contains("time.step_s") && Contains("whole steps"));
  CHECK_THAT(refusal({"time.end_s=2.05"}), Contains("time.end_s") && Contains("whole number of windows"));
  CHECK_THAT(refusal({"time.end_s=2.04"}), Contains("nearest: 2 s"));
  CHECK_THAT(refusal({"waves.model='airy'", "waves.height_m=1.0", "waves.period_s=8.0"}), Contains("waves"));
  CHECK_THAT(refusal({"wind.speed_m_s=11.0"}), Contains("wind"));
  CHECK_THAT(refusal({"start.ramp_s=5.0"}), Contains("start.ramp_s"));
  CHECK_THAT(refusal({}, "[joints.buoy]\ntype = 'spherical'\nbodies = ['buoy', 'earth']\npoint_m = [0.0, 0.0, 0.0]\n"),
             Contains("is the name of another body"));
  CHECK_THAT(refusal({"moorings.chain.body='boy'"}), Contains("known: buoy"));
}

TEST_CASE("a speed of the wind beside a file that has another is refused", "[coupling][fast]") {
  const std::string path = (std::filesystem::temp_directory_path() / ("spindrift_wind_" + std::to_string(getpid()))).string(),
                    table = path + ".csv", box = path + ".bts";
  std::ofstream(table) << "time_s,speed_m_s\n0,8\n10,12\n";
  aero::BtsFile file{.id = 8, .up = 2, .across = 2, .steps = 2, .up_m = 9, .across_m = 9, .step_s = 0.5f, .wind = 8};
  file.hub_height = 9, file.grid.resize(2 * 2 * 2 * 3);
  write_bts(file, box);
  const std::string rotor =
      "[aero]\nmodel = 'thrust_curve'\nthrust_coefficient = 0.8\n"
      "[rotor]\nbody = 'buoy'\nhub_m = [0.0, 0.0, 10.0]\ndiameter_m = 6.0\n[wind]\n";
  for (const std::string& wind : {"table = '" + table + "'\n", "turbulence = {model = 'bts', file = '" + box + "'}\n"}) {
    INFO(wind);
    CHECK(refusal({}, rotor + wind) == "");
    CHECK(refusal({"wind.speed_m_s=8.0"}, rotor + wind) == "");
    CHECK_THAT(refusal({"wind.speed_m_s=12.0"}, rotor + wind), Contains("wind.speed_m_s") && Contains("has no effect"));
  }
  std::filesystem::remove(table), std::filesystem::remove(box);
}

TEST_CASE("a controller is refused with a load that neither rotor speed nor pitch change", "[coupling][fast]") {
  const auto path = std::filesystem::temp_directory_path() / ("spindrift_curve_" + std::to_string(getpid()) + ".csv");
  const std::string given = "aero.curve='" + path.string() + "'";
  const auto problem = [](std::vector<std::string> aero) -> std::string {
    aero.push_back("rotor.diameter_m=178.33");
    try {
      test::scenario("base = \"inputs/control/dtu_10mw_fixed.toml\"\n", aero);
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  std::ofstream(path) << "wind_m_s,ct,cp,speed_rpm\n4,.8,.4,6\n25,.1,.1,9.6\n";
  CHECK_THAT(problem({"aero.model='prescribed'", "aero.thrust_N=1e6"}),
             Contains("aero.model") && Contains("leave [control] out"));
  CHECK_THAT(problem({"aero.model='thrust_curve'", "aero.thrust_coefficient=0.8"}),
             Contains("aero.thrust_coefficient") && Contains("leave [control] out"));
  CHECK_THAT(problem({"aero.model='thrust_curve'", given}), Contains("aero.curve") && Contains("leave [control] out"));
  CHECK(problem({"aero.model='thrust_curve'", given, "control.model='none'"}) == "");
  std::ofstream(path) << "tip_speed_ratio,blade_pitch_deg,ct,cp\n4,0,.5,.4\n8,0,.5,.4\n4,90,0,0\n8,90,0,0\n";
  CHECK(problem({"aero.model='thrust_curve'", given}) == "");
  std::filesystem::remove(path);
}

TEST_CASE("waves that break and shapes below the bed are refused", "[coupling][fast]") {
  CHECK_THAT(refusal({"sea.model='morison'", "waves.model='airy'", "waves.height_m=30.0", "waves.period_s=6.0"}),
             Contains("waves"));
  CHECK_THAT(refusal({"environment.water_depth_m=1.5"}), Contains("buoy") || Contains("hull"));
  CHECK(refusal({"sea.model='morison'", "waves.model='airy'", "waves.height_m=1.0", "waves.period_s=8.0"}).empty());
}

TEST_CASE("a scene without bodies says what is missing", "[coupling][fast]") {
  CHECK_THROWS_WITH(test::scenario("[time]\nend_s = 1.0\nwindow_s = 0.1\n"), Contains("no body"));
}
