// The DTU turbine under its controller: on a fixed foundation it follows its operating table, events do what they say, a restart
// goes on bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/aero/operation.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {
const std::string scene_file = input("control/dtu_10mw_fixed.toml");
scene::Columns history_of(const Folder& folder) { return scene::read_columns((folder.path() / "history.csv").string()); }
}  // namespace

TEST_CASE("from 6 to 25 m/s the DTU turbine turns within 1 % of its table and gives its power within 2 %", "[coupled][fast]") {
  const scene::Columns table = scene::read_columns(input("turbines/dtu_10mw_operation.csv"));
  const int wind = GENERATE(6, 7, 8, 9, 10, 11, 12, 13, 15, 20, 25);
  const Folder folder("control");
  CAPTURE(wind);
  REQUIRE(run_scene(scene_file, {"wind.speed_m_s=" + std::to_string(wind) + ".0", "time.end_s=150.0"}, folder.path()).exit_code ==
          0);
  const scene::Columns history = history_of(folder);
  const auto row = std::size_t(wind - 4);
  REQUIRE(table["wind_m_s"][row] == wind);
  CHECK(mean_of_last(history, "rotor.rpm", 30.0) == Approx(table["speed_rpm"][row]).epsilon(0.01));
  CHECK(mean_of_last(history, "rotor.power_W", 30.0) == Approx(table["power_W"][row]).epsilon(0.02));
}

TEST_CASE("a turbine starts up from rest, makes its power and shuts down again", "[coupled][fast]") {
  const Folder folder("start_up");
  REQUIRE(run_scene(scene_file,
                    {"wind.speed_m_s=14.0", "control.start='parked'",
                     "control.events=[{what='start_up', time_s=10.0}, {what='shut_down', time_s=250.0}]", "time.end_s=350.0"},
                    folder.path())
              .exit_code == 0);
  const scene::Columns history = history_of(folder);
  const auto time = history["time_s"], rpm = history["rotor.rpm"], power = history["rotor.electrical_power_W"];
  const auto at = [&](double t) { return std::size_t(std::lower_bound(time.begin(), time.end(), t) - time.begin()); };
  CHECK(power[at(9.0)] == 0.0);
  CHECK(rpm[at(240.0)] == Approx(9.6).epsilon(0.01));
  CHECK(power[at(240.0)] == Approx(10.0e6).epsilon(0.02));
  CHECK(power[at(349.0)] == 0.0);
  CHECK(std::abs(rpm[at(349.0)]) < 2.0);
}

TEST_CASE("a controlled run broken off and continued is the unbroken run, bit for bit", "[coupled][fast]") {
  const Folder folder("control_restart");
  const std::vector<std::string> overrides{"time.end_s=20.0", "wind.speed_m_s=13.0",
                                           "control.events=[{what='grid_loss', time_s=12.0}]"};
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "whole").exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "parts", {.until_s = 11.0, .quiet = true}).exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "parts", {.restart = true, .quiet = true}).exit_code == 0);
  CHECK(text_of(folder.path() / "whole/history.csv") == text_of(folder.path() / "parts/history.csv"));
}

TEST_CASE("the controlled turbine rides out every event of the wind", "[coupled][fast]") {
  const auto event = GENERATE("{what='eog', start_s=20.0}", "{what='ecd', start_s=20.0}",
                              "{what='edc', start_s=20.0, reversed=true}", "{what='ews_vertical', start_s=20.0}",
                              "{what='ews_horizontal', start_s=20.0}", "{what='step', start_s=20.0, speed_change_m_s=3.0}",
                              "{what='ramp', start_s=20.0, speed_change_m_s=-3.0, duration_s=10.0}");
  CAPTURE(event);
  const Folder folder("event");
  REQUIRE(run_scene(scene_file, {"wind.speed_m_s=13.0", "time.end_s=60.0", std::string("wind.event=") + event}, folder.path())
              .exit_code == 0);
  const scene::Columns history = history_of(folder);
  const auto time = history["time_s"], rpm = history["rotor.rpm"], thrust = history["rotor.thrust_N"];
  double before = 0.0, most = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    CHECK(rpm[i] < 1.3 * 9.6);
    if (time[i] < 20.0)
      before = thrust[i];
    else
      most = std::max(most, std::abs(thrust[i] - before));
  }
  CHECK(most > 0.01 * before);  // it was felt
}

TEST_CASE("turbulence of a seed is the same in a run broken off and continued", "[coupled][fast]") {
  const Folder folder("turbulent_restart");
  const std::vector<std::string> overrides{
      "time.end_s=8.0", "wind.speed_m_s=12.0",
      "wind.turbulence={model='kaimal', seed=7, points_across=5, points_up=5, duration_s=60.0, step_s=0.5}"};
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "whole").exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "parts", {.until_s = 4.0, .quiet = true}).exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, folder.path() / "parts", {.restart = true, .quiet = true}).exit_code == 0);
  CHECK(text_of(folder.path() / "whole/history.csv") == text_of(folder.path() / "parts/history.csv"));
}
