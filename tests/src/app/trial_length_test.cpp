// SPDX-License-Identifier: Apache-2.0
#include "src/app/trial_length.hpp"

#include <catch2/catch.hpp>

using spindrift::app::trial_length_s;

TEST_CASE("a trial that nearly carries the whole run covers all of it, a shorter one what the budget carries", "[app][fast]") {
  const double end_s = 120.0, window_s = 0.1;
  CHECK(trial_length_s(end_s, window_s, 10.0, 5.0) == end_s);
  CHECK(trial_length_s(end_s, window_s, 9.9, 10.0) == end_s);  // 118.8 s
  CHECK(trial_length_s(end_s, window_s, 9.5, 10.0) == end_s);
  CHECK(trial_length_s(end_s, window_s, 9.4, 10.0) == Approx(112.8));
  CHECK(trial_length_s(end_s, window_s, 5.0, 10.0) == Approx(60.0));
  CHECK(trial_length_s(end_s, window_s, 1e-9, 10.0) == Approx(3 * window_s));
  CHECK(trial_length_s(0.1, window_s, 1e-9, 10.0) == 0.1);  // no more than there is
}
