// Limits on steps and windows: src/coupling/limits.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/limits.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "src/coupling/start.hpp"
#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

TEST_CASE("a slack line is held to what it needs taut", "[coupling][fast]") {
  // One tonne on a line of 1e8 N/m, above the body's centre: omega = sqrt(1e5) 1/s, leapfrog's limit 2 / omega = 6.3 ms.
  const auto with = [](const std::vector<std::string>& more) {
    std::vector<std::string> all{"bodies.buoy.mass_kg=1000.0", "moorings.chain.tension_only=true",
                                 "moorings.chain.stiffness_N_m=1e8", "moorings.chain.rest_length_m=30.0", "time.window_s=0.1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const auto require = [&](const std::vector<std::string>& overrides) {
    FloatingSystem floating(test::scenario(test::buoy, overrides));
    require_stable_lines(floating, make_start(floating).state);
  };
  FloatingSystem floating(test::scenario(test::buoy, with({"time.integrator='symplectic'"})));
  const bodies::StepLimit limit = taut_line_limit(floating, make_start(floating).state);
  CHECK(limit.mode == "chain");
  CHECK(limit.step_s >= 2.0 / std::sqrt(1e5) * (1.0 - 1e-9));  // added mass makes it longer
  CHECK(limit.step_s < 2.0 * 2.0 / std::sqrt(1e5));
  CHECK_THROWS_WITH(require(with({"time.integrator='symplectic'", "time.step_s=0.05"})),
                    Contains("moorings.chain.stiffness_N_m"));
  CHECK_NOTHROW(require(with({"time.integrator='symplectic'", "time.step_s=0.005"})));
  CHECK_NOTHROW(require(with({"time.step_s=0.05"})));  // rk4 tries a window that fails again with smaller steps
  CHECK_THROWS_WITH(require(with({"time.step_s=0.1", "moorings.chain.stiffness_N_m=1e12"})), Contains("tried again"));
  FloatingSystem two_way(test::scenario(test::buoy));
  CHECK(std::isinf(taut_line_limit(two_way, make_start(two_way).state).step_s));  // the linearisation sees it
}
