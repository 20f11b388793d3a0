// When an output is due: one rule for rows, fields and checkpoints, for windows one by one and for several at once.
// SPDX-License-Identifier: Apache-2.0
#include "src/run/output.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace spindrift;
using run::Every, run::Windows;

TEST_CASE("every third window is due, held ones below zero too", "[run][fast]") {
  const Every every{.windows = 3};
  std::vector<std::int64_t> due;
  for (std::int64_t n = -4; n <= 7; ++n)
    if (every.due(n)) due.push_back(n);
  CHECK(due == std::vector<std::int64_t>{-3, 0, 3, 6});
}

TEST_CASE("an origin shifts the windows that are due, and bounds cut them off", "[run][fast]") {
  const Every every{.windows = 4, .origin = 2, .from = 2, .to = 11};
  std::vector<std::int64_t> due;
  for (std::int64_t n = -4; n <= 20; ++n)
    if (every.due(n)) due.push_back(n);
  CHECK(due == std::vector<std::int64_t>{2, 6, 10});
}

TEST_CASE("several windows at once are due where one of them is", "[run][fast]") {
  const Every every{.windows = 20};
  CHECK(every.due(Windows{19, 20, 100}));
  CHECK(every.due(Windows{15, 35, 100}));
  CHECK_FALSE(every.due(Windows{20, 39, 100}));
  CHECK_FALSE(every.due(Windows{20, 20, 100}));  // none was completed
}

TEST_CASE("an interval becomes whole windows, at least one; no interval is never due", "[run][fast]") {
  const coupling::Timeline timeline(0.1, 0.05, 10.0);
  CHECK(Every::count(0.5, timeline) == 5);
  CHECK(Every::count(0.01, timeline) == 1);
  CHECK(Every::count(0.0, timeline) == 0);
  CHECK_FALSE(Every{.windows = 0}.due(0));
}
