// A run broken off and continued is the unbroken run, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <utility>

#include "tests/coupled/runs.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

TEST_CASE("2 N windows are N windows, a restart, and N windows, bit for bit", "[coupled][fast]") {
  const std::string scene = input("leble_barakos/case2_engineering.toml");
  const auto integrator = GENERATE("time.integrator='rk4'", "time.integrator='symplectic'");
  const Folder folder("restart");
  const std::vector<std::string> overrides{"time.end_s=20.0", integrator};
  REQUIRE(run_scene(scene, overrides, folder.path() / "whole").exit_code == 0);
  REQUIRE(run_scene(scene, overrides, folder.path() / "parts", {.until_s = 10.0, .quiet = true}).exit_code == 0);
  const std::string half = text_of(folder.path() / "parts/history.csv");
  REQUIRE(run_scene(scene, overrides, folder.path() / "parts", {.restart = true, .quiet = true}).exit_code == 0);
  const std::string whole = text_of(folder.path() / "whole/history.csv");
  CHECK(half.size() < whole.size());
  CHECK(whole == text_of(folder.path() / "parts/history.csv"));
}

TEST_CASE("a checkpoint in the middle changes nothing", "[coupled][fast]") {
  const std::string scene = input("leble_barakos/case1_engineering.toml");
  const Folder folder("checkpoint");
  REQUIRE(run_scene(scene, {"time.end_s=5.0"}, folder.path() / "without").exit_code == 0);
  REQUIRE(run_scene(scene, {"time.end_s=5.0", "checkpoint.interval_s=1.0"}, folder.path() / "with").exit_code == 0);
  CHECK(text_of(folder.path() / "without/history.csv") == text_of(folder.path() / "with/history.csv"));
}

namespace {

/// A cylinder in water of the plane: through the surface and on, or on the spot while it spins.
std::string cylinder(const std::string& moves, double z) {
  return R"(
[time]
end_s = 0.068
window_s = 0.002
integrator = "symplectic"
[environment]
gravity_m_s2 = 9.81
water_density_kg_m3 = 1000.0
water_depth_m = 0.3
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.012
[sea.tank]
x_m = [-0.3, 0.3]
top_m = 0.3
[bodies.cylinder]
mass_kg = 9.0
inertia_kg_m2 = [1.4e-2, 1.4e-2, 1.4e-2]
centre_m = [0.0, 0.0, )" +
         std::to_string(z) + "]\n" + moves + R"(
[[bodies.cylinder.cylinders]]
name = "cylinder"
start_m = [0.0, -0.5, )" +
         std::to_string(z) + R"(]
end_m = [0.0, 0.5, )" +
         std::to_string(z) + R"(]
diameter_m = 0.11
)";
}

}  // namespace

TEST_CASE("a body far from where the run started restarts bit for bit, after a way and after a roll", "[coupled][fast]") {
  const auto [moves, z] =
      GENERATE(std::pair("velocity_m_s = [0.0, 0.0, -3.5]", 0.055), std::pair("omega_rad_s = [0.0, 50.0, 0.0]", -0.12));
  const Folder folder("restart_far");
  const auto scene = folder.path() / "scene.toml";
  std::filesystem::create_directories(folder.path());
  std::ofstream(scene) << cylinder(moves, z);
  REQUIRE(run_scene(scene, {}, folder.path() / "whole").exit_code == 0);
  REQUIRE(run_scene(scene, {}, folder.path() / "parts", {.until_s = 0.06, .quiet = true}).exit_code == 0);
  CHECK(run_scene(scene, {}, folder.path() / "parts", {.restart = true, .quiet = true}).exit_code == 0);
  CHECK(text_of(folder.path() / "whole/history.csv") == text_of(folder.path() / "parts/history.csv"));
}

TEST_CASE("a start from a file is refused where the water remembers other steps than the scene's", "[coupled][fast]") {
  const Folder folder("start_steps");
  const std::string scene = SPINDRIFT_SOURCE_DIR "/tests/extremes/potential.toml";
  REQUIRE(run_scene(scene, {}, folder.path() / "first", {.until_s = 0.2, .quiet = true}).exit_code == 0);
  const auto checkpoint = std::filesystem::directory_iterator(folder.path() / "first/checkpoints")->path();
  const std::string from = "start.file='" + checkpoint.string() + "'";
  CHECK(run_scene(scene, {from}, folder.path() / "same", {.until_s = 0.4, .quiet = true}).exit_code == 0);
  CHECK_THROWS_WITH(run_scene(scene, {from, "time.step_s=0.025", "sea.potential.memory_s=7.5"}, folder.path() / "other"),
                    Catch::Contains("steps of 0.05 s"));
}
