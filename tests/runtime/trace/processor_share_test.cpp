// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/processor_share.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::runtime;

TEST_CASE("a run that others took cores from says so, one that had them does not", "[trace][fast]") {
  CHECK(told_share(processor_share(1.8, 10.0)) == "others used the computer: this run had 18 % of its cores; times tell little");
  CHECK_FALSE(told_share(processor_share(8.9, 10.0)).empty());
  CHECK(told_share(processor_share(9.1, 10.0)).empty());
  CHECK(told_share(processor_share(20.0, 10.0)).empty());  // threads that waited span
  CHECK(told_share(processor_share(0.0, 0.1)).empty());    // too short to tell
}

TEST_CASE("processor time passes where a thread works", "[trace][fast]") {
  const double before = processor_seconds();
  volatile double sum = 0.0;
  for (int n = 0; n < 20'000'000; ++n) sum = sum + 1.0;
  CHECK(processor_seconds() > before + 1e-3);
}
