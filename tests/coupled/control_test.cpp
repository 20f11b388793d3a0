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
// The turbine does not move: one evaluation a step of its body is as good as four.
const std::vector<std::string> quick{"time.integrator='explicit_euler'", "time.step_s=0.1"};
std::vector<std::string> with(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), quick.begin(), quick.end());
  return overrides;
}
scene::Columns history_of(const std::filesystem::path& folder) { return scene::read_columns((folder / "history.csv").string()); }
scene::Columns history_of(const Folder& folder) { return history_of(folder.path()); }
}  // namespace

TEST_CASE("from 6 to 25 m/s the DTU turbine turns within 1 % of its table and gives its power within 2 %", "[coupled][fast]") {
  const scene::Columns table = scene::read_columns(input("turbines/dtu_10mw_operation.csv"));
  const int wind = GENERATE(6, 7, 8, 9, 11, 12, 13, 16, 20, 25);
  const Folder folder("control");
  CAPTURE(wind);
  REQUIRE(run_scene(scene_file, with({"wind.speed_m_s=" + std::to_string(wind) + ".0", "time.end_s=150.0"}), folder.path())
              .exit_code == 0);
  const scene::Columns history = history_of(folder);
  const auto row = std::size_t(wind - 4);
  REQUIRE(table["wind_m_s"][row] == wind);
  CHECK(mean_of_last(history, "rotor.rpm", 30.0) == Approx(table["speed_rpm"][row]).epsilon(0.01));
  CHECK(mean_of_last(history, "rotor.power_W", 30.0) == Approx(table["power_W"][row]).epsilon(0.02));
}

TEST_CASE("between the last winds of K omega^2 and rated wind the DTU turbine gives rated power at most", "[coupled][fast]") {
  const double wind = GENERATE(11.3, 11.5, 11.65);
  const Folder folder("rated");
  CAPTURE(wind);
  REQUIRE(run_scene(scene_file, with({"wind.speed_m_s=" + std::to_string(wind), "time.end_s=150.0"}), folder.path()).exit_code ==
          0);
  const scene::Columns history = history_of(folder);
  const double rated = 10e6 / 0.94, power = mean_of_last(history, "rotor.power_W", 30.0);
  CHECK(power < 1.002 * rated);
  CHECK(power > 0.97 * rated);
  CHECK(mean_of_last(history, "rotor.rpm", 30.0) < 1.002 * 9.6);
}

TEST_CASE("peak shaving cuts the thrust about rated wind to its share, and leaves power far above and below alone",
          "[coupled][fast]") {
  const auto [wind, share] = GENERATE(table<double, double>({{11.0, 0.8}, {11.5, 0.8}, {11.5, 0.9}, {7.0, 0.8}, {12.5, 0.8}}));
  CAPTURE(wind, share);
  const auto run = [](double speed, const std::vector<std::string>& more, const Folder& folder) {
    std::vector<std::string> overrides = with({"wind.speed_m_s=" + std::to_string(speed), "time.end_s=120.0"});
    overrides.insert(overrides.end(), more.begin(), more.end());
    REQUIRE(run_scene(scene_file, overrides, folder.path()).exit_code == 0);
    return history_of(folder);
  };
  const Folder plain_folder("unshaved"), folder("shaved");
  const scene::Columns plain = run(wind, {}, plain_folder);
  const scene::Columns cut = run(wind, {"control.peak_shaving=" + std::to_string(share)}, folder);
  const auto ratio = [&](const char* column) { return mean_of_last(cut, column, 30.0) / mean_of_last(plain, column, 30.0); };
  if (wind == 7.0 || wind == 12.5) {
    CHECK(ratio("rotor.thrust_N") == Approx(1.0).epsilon(1e-3));
    CHECK(ratio("rotor.power_W") == Approx(1.0).epsilon(1e-3));
    return;
  }
  const Folder peak_folder("peak");
  const scene::Columns peak = run(11.3, {}, peak_folder);  // rated wind; the schedule's rows are 0.5 m/s apart
  CHECK(mean_of_last(cut, "rotor.thrust_N", 30.0) == Approx(share * mean_of_last(peak, "rotor.thrust_N", 30.0)).epsilon(0.01));
  CHECK(ratio("rotor.thrust_N") < (share < 0.9 ? 0.9 : 0.98));
  CHECK(ratio("rotor.power_W") < (share < 0.9 ? 0.97 : 1.0));
}

TEST_CASE("a turbine starts up from rest, makes its power and shuts down again", "[coupled][fast]") {
  const Folder folder("start_up");
  REQUIRE(
      run_scene(scene_file,
                with({"wind.speed_m_s=14.0", "control.start='parked'",
                      "control.events=[{what='start_up', time_s=10.0}, {what='shut_down', time_s=250.0}]", "time.end_s=350.0"}),
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

TEST_CASE("above rated wind gains of a fixed foundation make a slow pitch grow, those of floaters let it die",
          "[coupled][fast]") {
  // The turbine on a hinge with a weight below it: it pitches in 35 s, and rests at 7.5 degrees in 18 m/s. The hinge is 0.5
  // degrees off.
  const bool floating = GENERATE(false, true);
  const Folder folder("tuning");
  REQUIRE(run_scene(scene_file,
                    {"bodies.turbine.mass_kg=8e6", "bodies.turbine.inertia_kg_m2=[2e10, 2e10, 2e8]",
                     "bodies.turbine.centre_m=[0.0, 0.0, -8.2]", "bodies.turbine.rotation_deg=[0.0, 8.0, 0.0]",
                     "bodies.turbine.reference_m=[0.0, 0.0, 0.0]", "joints.foundation.type='revolute'",
                     "joints.foundation.axis=[0.0, 1.0, 0.0]", "wind.speed_m_s=18.0", "time.step_s=0.1", "time.end_s=160.0",
                     floating ? "control.tuning='floating'" : "control.tuning='fixed_foundation'"},
                    folder.path())
              .exit_code == 0);
  const scene::Columns history = history_of(folder);
  const auto swing = [&](double from, double to) {  // over one period, highest less lowest
    double low = 1e9, high = -1e9;
    for (std::size_t i = 0; i < history["time_s"].size(); ++i)
      if (history["time_s"][i] >= from && history["time_s"][i] < to)
        low = std::min(low, history["turbine.pitch_deg"][i]), high = std::max(high, history["turbine.pitch_deg"][i]);
    return high - low;
  };
  const double growth = swing(120.0, 160.0) / swing(20.0, 60.0);
  CAPTURE(floating, swing(20.0, 60.0), swing(120.0, 160.0));
  CHECK((floating ? growth < 0.7 : growth > 1.5));
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
  REQUIRE(
      run_scene(scene_file, with({"wind.speed_m_s=13.0", "time.end_s=60.0", std::string("wind.event=") + event}), folder.path())
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

namespace {

/// The DTU turbine with the tests' library on its shaft: K omega^2 on the generator's side of a gear of 50.
struct LibraryRun {
  Folder folder;
  std::filesystem::path input;
  explicit LibraryRun(const std::string& name, const std::string& text) : folder(name), input(folder.path().string() + ".in") {
    std::ofstream(input) << text;
  }
  ~LibraryRun() { std::filesystem::remove(input); }
  std::vector<std::string> overrides(std::vector<std::string> more) const {
    more.insert(more.end(),
                {"control.model='library'", "control.library='" SPINDRIFT_TEST_CONTROLLER "'",
                 "control.input_file='" + input.string() + "'",
                 "control.drive_train={rotor_inertia_kg_m2=1.563e8, generator_inertia_kg_m2=3.751e6, gear_ratio=50.0, "
                 "generator_efficiency=0.94}"});
    return more;
  }
};
// K of the table, 1.2e7 N m s2 and some on the rotor's side: Q_g = Q / 50, omega_g = 50 omega.
constexpr const char* optimal = "gain 97.6";

}  // namespace

TEST_CASE("a library that holds K omega squared holds the table's tip-speed ratio", "[coupled][fast]") {
  const LibraryRun run("library", optimal);
  REQUIRE(run_scene(scene_file, with(run.overrides({"wind.speed_m_s=9.0", "time.end_s=300.0"})), run.folder.path()).exit_code ==
          0);
  const scene::Columns history = history_of(run.folder), table = scene::read_columns(input("turbines/dtu_10mw_operation.csv"));
  REQUIRE(table["wind_m_s"][5] == 9.0);
  const double power = mean_of_last(history, "rotor.power_W", 30.0);
  CHECK(mean_of_last(history, "rotor.rpm", 30.0) == Approx(table["speed_rpm"][5]).epsilon(0.01));
  CHECK(power == Approx(table["power_W"][5]).epsilon(0.02));
  CHECK(mean_of_last(history, "rotor.electrical_power_W", 30.0) == Approx(0.94 * power).epsilon(1e-3));
}

TEST_CASE("a library is called once at the start and once after every step, and told the end", "[coupled][fast]") {
  const std::filesystem::path log = std::filesystem::temp_directory_path() / ("spindrift_calls_" + std::to_string(getpid()));
  std::filesystem::remove(log);
  const LibraryRun run("library_calls", std::string(optimal) + "\nlog " + log.string());
  REQUIRE(run_scene(scene_file, run.overrides({"time.end_s=2.0", "time.step_s=0.05"}), run.folder.path()).exit_code == 0);
  std::ifstream in(log);
  std::vector<double> status, time;
  std::string name;
  for (double s, t; in >> s >> t >> name;) status.push_back(s), time.push_back(t);
  REQUIRE(status.size() == 42);
  CHECK((status.front() == 0.0 && status.back() == -1.0));
  for (std::size_t n = 0; n + 1 < status.size(); ++n) {
    CHECK(time[n] == Approx(0.05 * double(n)).margin(1e-6));
    CHECK(status[n] == (n == 0 ? 0.0 : 1.0));
  }
  std::filesystem::remove(log);
}

TEST_CASE("a run under a library broken off and continued is the unbroken run, bit for bit", "[coupled][fast]") {
  const LibraryRun run("library_restart", std::string(optimal) + "\npitch 0.05\nfrom 12.0\ncontactor 0");
  const std::vector<std::string> overrides = run.overrides({"time.end_s=20.0", "wind.speed_m_s=10.0"});
  REQUIRE(run_scene(scene_file, overrides, run.folder.path() / "whole").exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, run.folder.path() / "parts", {.until_s = 7.0, .quiet = true}).exit_code == 0);
  REQUIRE(run_scene(scene_file, overrides, run.folder.path() / "parts", {.restart = true, .quiet = true}).exit_code == 0);
  CHECK(text_of(run.folder.path() / "whole/history.csv") == text_of(run.folder.path() / "parts/history.csv"));
  const scene::Columns history = history_of(run.folder.path() / "whole");
  CHECK(history["rotor.electrical_power_W"][20] > 1e6);
  CHECK(history["rotor.electrical_power_W"][30] == 0.0);
}

TEST_CASE("a library that gives up ends the run with its words, exit code 3 and the state saved", "[coupled][fast]") {
  const LibraryRun run("library_fails", std::string(optimal) + "\nfail_from 3.0");
  const io::Summary summary = run_scene(scene_file, run.overrides({"time.end_s=20.0"}), run.folder.path());
  CHECK(summary.exit_code == 3);
  CHECK_THAT(summary.exit_reason, Catch::Matchers::Contains("pitch bearing is lost"));
}

TEST_CASE("a rotor that its library drives faster than air has loads for is stopped by name", "[coupled][fast]") {
  const LibraryRun run("library_drives", "gain -1e6");
  const io::Summary summary = run_scene(scene_file, run.overrides({"time.end_s=200.0"}), run.folder.path());
  CHECK(summary.exit_code == 3);
  CHECK_THAT(summary.exit_reason, Catch::Matchers::Contains("the rotor turns at"));
  CHECK_THAT(summary.exit_reason, Catch::Matchers::Contains("the limit is 1020 m/s"));
  const double fastest = 1020.0 / (0.5 * 178.3);
  for (const double rpm : history_of(run.folder)["rotor.rpm"]) CHECK(std::abs(rpm) * pi / 30.0 < fastest);
}

TEST_CASE("a library is refused where windows repeat, where it does not fit and where it is none", "[coupled][fast]") {
  const LibraryRun run("library_refused", optimal);
  const auto refusal = [&](std::vector<std::string> more) -> std::string {
    std::vector<std::string> overrides = run.overrides({});
    overrides.insert(overrides.end(), more.begin(), more.end());
    try {
      scene::Document document = scene::load(scene_file, overrides);
      read_scenario(document);
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  CHECK(refusal({}).empty());
  CHECK(refusal({"coupling.scheme='iqn_ils'"}).find("coupling.scheme") != std::string::npos);
  CHECK(refusal({"control.library='" + run.input.string() + "'"}).find("is no library that can be loaded") != std::string::npos);
  CHECK(refusal({"control.procedure='CONTROLLER'"}).find("has no procedure CONTROLLER") != std::string::npos);
  CHECK(refusal({"control.events=[{what='shut_down', time_s=1.0}]"}).find("is the library's business") != std::string::npos);
  CHECK(refusal({"control.records=[{record=47, value=1.0}]"}).find("is filled by the program") != std::string::npos);
  CHECK(refusal({"control.tuning='floating'"}).find("control.tuning") != std::string::npos);
}
