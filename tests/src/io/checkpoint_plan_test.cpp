// When a run saves: checkpoint_plan.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/io/checkpoint_plan.hpp"

#include <catch2/catch.hpp>

using spindrift::io::CheckpointPlan;
using namespace std::chrono_literals;

TEST_CASE("saving takes less than a hundredth of the run, however long one save is", "[io][fast]") {
  const auto start = CheckpointPlan::Clock::now();
  for (const auto cost : {10ms, 500ms, 2000ms, 30000ms}) {
    CheckpointPlan plan(0.0, 0.1, 60.0);
    auto now = start;
    std::chrono::milliseconds spent = 0ms, longest_gap = 0ms, gap = 0ms;
    plan.saved(now, now + cost), now += cost;
    for (std::int64_t number = 1; number <= 10000; ++number) {
      now += 700ms, gap += 700ms;
      if (!plan.due(MPI_COMM_SELF, number - 1, number, now)) continue;
      longest_gap = std::max(longest_gap, gap), gap = 0ms;
      plan.saved(now, now + cost), now += cost, spent += cost;
    }
    CHECK(spent.count() <= 0.01 * double((now - start).count() / 1000000));
    CHECK(longest_gap <= std::max<std::chrono::milliseconds>(60s, 100 * cost) + 700ms);
    CHECK(spent > 0ms);
  }
}

TEST_CASE("saving by simulated time knows no clock, and steady marches pass several windows at once", "[io][fast]") {
  CHECK_FALSE(CheckpointPlan(0.0, 0.1, 0.0).at_start());
  CHECK_FALSE(CheckpointPlan(0.0, 0.1, 0.0).due(MPI_COMM_SELF, 0, 1000000));
  const CheckpointPlan plan(0.5, 0.1, 0.0);
  CHECK(plan.at_start());
  CHECK_FALSE(plan.due(MPI_COMM_SELF, 3, 4));
  CHECK(plan.due(MPI_COMM_SELF, 4, 5));
  CHECK(plan.due(MPI_COMM_SELF, 3, 23));
}
