// A run broken off and continued is the unbroken run, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

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
