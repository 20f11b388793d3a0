// Time in whole windows and steps: src/coupling/timeline.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/timeline.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::coupling;

TEST_CASE("a window holds the same whole number of steps however long the run is", "[coupling][fast]") {
  const Timeline t(2e-2, 2e-4, 60.0);
  CHECK(t.steps_per_window() == 100);
  CHECK(t.windows() == 3000);
  CHECK(t.tick_of_window(2999) + t.steps_per_window() == t.tick_of_window(3000));
  CHECK(t.window_end_s(3000) == Approx(60.0).epsilon(1e-15));
  // The loop `for (t = 0; t < window; t += step)` in float takes 101 steps in most windows; here there is nothing to accumulate.
  CHECK(double(t.tick_of_window(3000)) * t.tick_s() == Approx(60.0).epsilon(1e-14));
}

TEST_CASE("steps that do not divide the window are refused, with the nearest that does", "[coupling][fast]") {
  CHECK(whole_ratio(0.1, 0.05) == 2);
  CHECK(whole_ratio(0.1, 0.1) == 1);
  CHECK(whole_ratio(0.3, 0.1) == 3);  // 0.3 / 0.1 = 2.9999999999999996
  CHECK_FALSE(whole_ratio(0.1, 0.03));
  CHECK_FALSE(whole_ratio(0.1, 0.2));
  CHECK_FALSE(whole_ratio(0.1, 0.0));
  CHECK(nearest_divisor(0.1, 0.03) == Approx(0.1 / 3));
  CHECK(nearest_divisor(0.1, 7.0) == Approx(0.1));
}
