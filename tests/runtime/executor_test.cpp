// The replay gives what the sequential algorithm gives: random nested programs, any number of threads, any order of ready tasks.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/executor.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <set>

#include "tests/runtime/random_program.hpp"

using namespace spindrift::runtime;
using spindrift::runtime::testing::RandomProgram;

namespace {

std::vector<std::uint64_t> in_order(std::uint64_t seed, int replays) {
  RandomProgram program(seed, 8, 8, 3);
  program.run_in_order(replays);
  return program.values;
}

std::vector<std::uint64_t> as_graph(std::uint64_t seed, std::vector<std::uint32_t> runs, ExecutorOptions options) {
  RandomProgram program(seed, 8, 8, 3);
  Graph graph;
  program.record(graph);
  Executor executor(std::move(graph), options);
  for (const auto n : runs) executor.run(n);
  return program.values;
}

}  // namespace

TEST_CASE("random nested programs give the numbers of the sequential order on any number of threads", "[runtime][fast]") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto expected = in_order(seed, 7);
    for (const int threads : {1, 2, 4, 8}) {
      INFO("seed " << seed << ", threads " << threads);
      REQUIRE(as_graph(seed, {7}, {.threads = threads}) == expected);
    }
    INFO("seed " << seed);
    REQUIRE(as_graph(seed, {1, 2, 1, 3}, {.threads = 2, .priorities = false}) == expected);
  }
}

TEST_CASE("100 seeded random schedules give the same numbers", "[runtime][fast]") {
  const auto expected = in_order(7, 5);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    INFO("schedule " << seed);
    REQUIRE(as_graph(7, {5}, {.threads = int(1 + seed % 4), .random_schedule = seed}) == expected);
  }
}

TEST_CASE("a random schedule on one thread is reproduced by its seed and differs from another's", "[runtime][fast]") {
  const auto order = [](std::uint64_t seed) {
    std::vector<int> ran;
    Graph graph;
    const auto data = graph.data(20);
    for (int i = 0; i < 20; ++i)
      graph.task("t/" + std::to_string(i), {writes(data[std::size_t(i)])}, [&ran, i] { ran.push_back(i); });
    Executor(std::move(graph), {.threads = 1, .random_schedule = seed}).run();
    return ran;
  };
  CHECK(order(1) == order(1));
  CHECK(order(1) != order(2));
}

TEST_CASE("more random programs than the fast tier has time for", "[runtime][nightly]") {
  for (std::uint64_t seed = 1000; seed < 4000; ++seed) {
    const auto expected = in_order(seed, 5);
    INFO("seed " << seed);
    REQUIRE(as_graph(seed, {5}, {.threads = int(1 + seed % 8)}) == expected);
    REQUIRE(as_graph(seed, {2, 3}, {.threads = int(1 + seed % 3), .random_schedule = seed}) == expected);
  }
}

TEST_CASE("a task learns the replay, the iteration of its loop and its thread", "[runtime][fast]") {
  std::set<std::pair<std::uint32_t, std::uint32_t>> inner, outer;
  bool thread_in_range = true;
  Graph graph;
  const Datum x = graph.datum();
  graph.task("a", {updates(x)}, [&](const Context& c) { outer.emplace(c.replay, c.iteration); });
  graph.repeat("loop", 2, [&] {
    graph.task("loop/b", {updates(x)}, [&](const Context& c) {
      inner.emplace(c.replay, c.iteration);
      thread_in_range = thread_in_range && c.thread >= 0 && c.thread < 3;
    });
  });
  Executor executor(std::move(graph), {.threads = 3});
  executor.run(2);
  executor.run(1);
  CHECK(outer == std::set<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {1, 1}, {2, 0}});
  CHECK(inner == std::set<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}});
  CHECK(thread_in_range);
}

namespace {

void run_short_graphs(int graphs) {
  long sum = 0;
  for (int n = 0; n < graphs; ++n) {
    Graph graph;
    const auto x = graph.data(2);
    graph.task("a", {writes(x[0])}, [&] { ++sum; });
    graph.task("b", {reads(x[0]), writes(x[1])}, [&] { ++sum; });
    graph.task("c", {reads(x[1]), updates(x[0])}, [&] { ++sum; });
    Executor(std::move(graph), {.threads = 2}).run();
  }
  CHECK(sum == 3L * graphs);
}

}  // namespace

TEST_CASE("1000 short graphs end", "[runtime][fast]") { run_short_graphs(1000); }
TEST_CASE("10000 short graphs end", "[runtime][nightly]") { run_short_graphs(10000); }

TEST_CASE("10000 runs of one short graph end", "[runtime][fast]") {
  long sum = 0;
  Graph graph;
  const auto x = graph.data(4);
  for (const Datum d : x) graph.task("a", {updates(d)}, [] {});
  graph.task("b", {reads(x)}, [&] { ++sum; });
  Executor executor(std::move(graph), {.threads = 2});
  for (int n = 0; n < 10000; ++n) executor.run(1 + n % 2);
  CHECK(sum == 15000);
}

TEST_CASE("worker threads flush denormal numbers to zero only if asked", "[runtime][fast]") {
  const auto halved = [](bool flush) {
    volatile double x = std::numeric_limits<double>::min();
    double result = -1;
    Graph graph;
    graph.task("half", {writes(graph.datum())}, [&] { result = x / 2; });
    Executor(std::move(graph), {.threads = 2, .flush_to_zero = flush}).run();
    return result;
  };
  CHECK(halved(false) > 0);
  CHECK(halved(true) == 0);
  volatile double x = std::numeric_limits<double>::min();
  CHECK(x / 2 > 0);  // the caller's own mode is as it was
}

TEST_CASE("a thread that is late in one entry of a loop does not disturb the next", "[runtime][fast]") {
  // More threads than processors: some are put to sleep between the tokens they give. Each inner task checks its own order.
  constexpr std::uint32_t outer = 3000, inner = 3;
  std::vector<std::uint32_t> ran(6, 0);
  bool in_order = true;
  Graph graph;
  const auto x = graph.data(ran.size());
  const Datum all = graph.datum();
  graph.repeat("outer", outer, [&] {
    graph.repeat("inner", inner, [&] {
      for (std::size_t i = 0; i < ran.size(); ++i)
        graph.task("inner/" + std::to_string(i), {updates(x[i])}, [&ran, i] { ++ran[i]; });
    });
    graph.task("check", {reads(x), updates(all)}, [&, n = 0u]() mutable {
      ++n;
      for (const std::uint32_t r : ran) in_order = in_order && r == n * inner;
    });
  });
  Executor executor(std::move(graph), {.threads = 8, .watchdog_s = 20});
  executor.run(1);
  CHECK(in_order);
  CHECK(ran == std::vector<std::uint32_t>(ran.size(), outer * inner));
}
