// Cost-to-go, and that a more urgent loop's tasks run first.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/priority.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "runtime/executor/executor.hpp"

using namespace spindrift::runtime;

TEST_CASE("cost-to-go is the longest chain of measured costs, through loops by their iterations", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum(), y = g.datum();
  const auto a = g.task("a", {writes(x)}, [] {});
  std::uint32_t b = 0, c = 0;
  const auto loop = g.repeat("loop", 5, [&] {
    b = g.task("loop/b", {updates(x)}, [] {});
    c = g.task("loop/c", {reads(x), writes(y)}, [] {});
  });
  const auto d = g.task("d", {reads(y)}, [] {});
  Program program(g);
  const auto measured = [&](std::uint32_t node, std::int64_t ns, std::uint32_t runs) {
    program.slots[node].cost_ns = ns * runs, program.slots[node].step = runs;
  };
  measured(a, 10, 1), measured(b, 20, 5), measured(c, 7, 5), measured(d, 100, 1);
  const auto to_go = cost_to_go(program, g);
  CHECK(to_go[d] == 100);
  CHECK(to_go[loop] == 5 * 27 + 100);
  CHECK(to_go[a] == 10 + 5 * 27 + 100);
  CHECK(to_go[c] == 7 + 2 * 27 + 100);  // half of the four iterations that follow
  CHECK(to_go[b] == 20 + to_go[c]);
}

TEST_CASE("ready tasks run by urgency, then by cost-to-go", "[runtime][fast]") {
  std::vector<char> ran;
  Graph g;
  const auto x = g.data(6);
  const auto note = [&](char c) { return [&ran, c] { ran.push_back(c); }; };
  g.task("start", {writes(x)}, [] {});
  g.task("short", {updates(x[0])}, note('s'));
  g.task("long/1", {updates(x[1])}, note('l'));
  g.task("long/2", {updates(x[1])}, note('l'));
  g.task("long/3", {updates(x[1])}, note('l'));
  g.loop("urgent", {.min = 1, .max = 1, .urgency = 1}, [&] { g.task("urgent/t", {updates(x[2])}, note('u')); });
  Executor(std::move(g), {.threads = 1}).run();
  REQUIRE(ran.size() == 5);
  CHECK(std::string(ran.begin(), ran.begin() + 3) == "ull");  // the last of the long ones goes as far as the short one
}

TEST_CASE("a task that a thread kept for itself can be taken by others once a more urgent one runs first", "[runtime][fast]") {
  // The first thread completes "hands on", keeps "kept" and gives out tokens for a while; meanwhile the other makes "urgent"
  // ready there.
  std::atomic<bool> there, hands_on, kept;
  int run = 0, missed = 0;
  Graph g;
  const Datum first = g.datum(0.0F), other = g.datum(0.5F), urgent = g.datum(0.0F);
  g.task("hands on", {writes(first)}, [&] {
    while (!there) {}
    hands_on = true;
  });
  g.task("kept", {reads(first), writes(g.datum(0.0F))}, [&] { kept = true; });
  g.task("makes ready", {writes(other)}, [&] {
    there = true;
    while (!hands_on) {}
    for (std::atomic<int> n = 0; n < 10 * (run % 50); ++n) {}
  });
  g.loop("urgent", {.min = 1, .max = 1, .urgency = 1}, [&] {
    g.task("urgent/waits", {reads(other), writes(urgent)}, [&] {
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
      while (!kept && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      if (!kept) ++missed;
    });
  });
  for (int n = 0; n < 400; ++n) g.task("later", {reads(first), reads(urgent)}, [] {});
  Executor executor(std::move(g), {.threads = 2});
  for (; run < 200 && missed == 0; ++run) {
    there = hands_on = kept = false;
    executor.run();
  }
  CHECK(missed == 0);
}
