// Limits on steps and windows: src/coupling/limits.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/limits.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

TEST_CASE("a slack line is held to the step that it needs taut", "[coupling][fast]") {
  // One tonne on a line of 1e8 N/m, above the body's centre: omega = sqrt(1e5) 1/s, leapfrog's limit 2 / omega = 6.3 ms.
  const std::vector<std::string> line{"time.integrator='symplectic'", "bodies.buoy.mass_kg=1000.0",
                                      "moorings.chain.tension_only=true", "moorings.chain.stiffness_N_m=1e8",
                                      "moorings.chain.rest_length_m=30.0"};
  const bodies::StepLimit limit = taut_line_limit(test::scenario(test::buoy, line));
  CHECK(limit.mode == "chain");
  CHECK(limit.step_s == Approx(2.0 / std::sqrt(1e5)).epsilon(1e-9));
  const auto require = [&](const std::string& step) {
    std::vector<std::string> overrides = line;
    overrides.insert(overrides.end(), {"time.step_s=" + step, "time.window_s=0.1"});
    Machine machine(test::scenario(test::buoy, overrides));
    require_stable_lines(machine);
  };
  CHECK_THROWS_WITH(require("0.01"), Contains("moorings.chain.tension_only") && Contains("0.00632"));
  CHECK_NOTHROW(require("0.005"));
  CHECK(std::isinf(taut_line_limit(test::scenario(test::buoy)).step_s));  // two-way: the linearisation sees it
}
