// The OC3 spar as a scene of the program against OpenFAST 5.0: inputs/validation/oc3_heave_decay.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

TEST_CASE("the OC3 scene decays in heave as OpenFAST has it: period 30.87 s, peaks within 2 %", "[coupled][fast]") {
  const Folder folder("oc3");
  REQUIRE(run_scene(input("validation/oc3_heave_decay/oc3_heave_decay.toml"), {}, folder.path()).exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const scene::Columns reference = scene::read_columns(input("validation/oc3_heave_decay/reference.csv"));
  const auto time = history["time_s"], heave = history["spar.z_m"];
  std::vector<double> when, height;  // extremes, by a parabola through three samples
  for (std::size_t i = 1; i + 1 < time.size(); ++i) {
    const double a = heave[i - 1], b = heave[i], c = heave[i + 1];
    if ((b - a) * (c - b) > 0.0) continue;
    const double curve = a - 2.0 * b + c, slope = 0.5 * (c - a);
    when.push_back(time[i] - slope / curve * (time[1] - time[0]));
    height.push_back(b - 0.5 * slope * slope / curve);
  }
  REQUIRE(when.size() == 9);
  CHECK((when[7] - 0.0) / 4.0 == Approx(30.87).epsilon(0.005));
  for (std::size_t i = 0; i < when.size(); ++i) {
    CHECK(when[i] == Approx(reference["time_s"][i + 1]).epsilon(0.005));
    CHECK(height[i] == Approx(reference["heave_m"][i + 1]).epsilon(0.02));
  }
}
