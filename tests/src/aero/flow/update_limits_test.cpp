// What is said of updates that the bounds of some cells shortened: how many, the most cells, the worst places.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/update_limits.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::aero;

TEST_CASE("updates with limits are counted with the most cells and their share; none is worth no word", "[flow][fast]") {
  UpdateLimits limits;
  for (const double limited : {0.0, 3.0, 12.0, 0.0}) limits.count(limited, 0.0);
  CHECK(limits.text("4 pseudo-steps", 1000, {}) ==
        "in 2 of 4 pseudo-steps the update was shortened, as up to 12 cells (1.2 %) would have changed too much");
  for (const double clipped : {0.0, 1.0}) limits.count(0.0, clipped);
  CHECK((limits.counted() == 6 && limits.shortened() == 2 && limits.clipped() == 1));
  CHECK(
      limits.text("6 pseudo-steps", 1000, {{0.5, "here"}, {0.25, "there"}}) ==
      "in 2 of 6 pseudo-steps the update was shortened, as up to 12 cells (1.2 %) would have changed too much; in 1 turbulence's "
      "update was kept above its bound, in up to 1 cell (0.1 %); most was here and there");
  UpdateLimits of_turbulence;
  CHECK(of_turbulence.text("0 windows", 1000, {}).empty());
  of_turbulence.count(0.0, 20.0);
  CHECK(of_turbulence.text("1 windows", 1000, {{}, {0.25, "there"}}) ==
        "in 1 of 1 windows turbulence's update was kept above its bound, in up to 20 cells (2 %); most was there");
  of_turbulence.count(0.0, 0.0);
  CHECK(of_turbulence.clipped() == 1);
  CHECK(limited_update(12.0, 1.0, 1000) == "12 cells (1.2 %) of the mean flow and 1 cell (0.1 %) of turbulence");
  CHECK(limited_update(0.0, 2.0, 1000) == "2 cells (0.2 %) of turbulence");
  CHECK(limited_update(0.0, 0.0, 1000).empty());
}

TEST_CASE("the worst places of several updates are kept with their times, each kind by itself", "[flow][fast]") {
  LimitPlaces worst;
  worst.keep_worse({{0.5, "a"}, {1.0, ""}}, "t = 1 s");
  CHECK(worst.text() == "a, t = 1 s");
  worst.keep_worse({{0.6, "b"}, {0.3, "c"}}, "t = 2 s");
  CHECK(worst.text() == "a, t = 1 s and c, t = 2 s");
  worst.keep_worse({{0.1, "d"}, {0.4, "e"}}, "t = 3 s");
  CHECK(worst.text() == "d, t = 3 s and c, t = 2 s");
}
