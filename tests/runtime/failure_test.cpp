// How runs fail: a throwing task, on one rank or another; a hang. In each case every rank ends within seconds with the reason.
// A killed rank: tests/runtime/killed_rank.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "runtime/executor/executor.hpp"
#include "runtime/executor/watchdog.hpp"

using namespace spindrift::runtime;
using Catch::Contains;

TEST_CASE("a throwing task names its label, and the graph does not run again", "[runtime][fast]") {
  for (const int threads : {1, 2, 4}) {
    Graph g;
    const auto x = g.data(10);
    for (std::size_t i = 0; i < 10; ++i)
      g.task("aero/residual/" + std::to_string(i), {updates(x[i])}, [i](const Context& c) {
        if (i == 7 && c.iteration == 3) throw std::runtime_error("pressure -1.2e3 Pa");
      });
    Executor executor(std::move(g), {.threads = threads});
    CHECK_NOTHROW(executor.run(3));
    CHECK_THROWS_AS(executor.run(5), TaskError);
    CHECK_THROWS_WITH(executor.run(1), Contains("cannot run again") && Contains("aero/residual/7"));
  }
}

TEST_CASE("the message of a throwing task says where and what", "[runtime][fast]") {
  Graph g;
  g.repeat("sea", 2, [&] { g.task("sea/force/3-7", {}, [] { throw std::runtime_error("no neighbours"); }); });
  Executor executor(std::move(g), {.threads = 2});
  CHECK_THROWS_WITH(executor.run(), Contains("task sea/force/3-7 on rank 0: no neighbours"));
}

TEST_CASE("a predicate or a message's buffer may throw as well", "[runtime][fast]") {
  Graph g;
  g.loop("l", {1, 5}, [&] {
    g.task("l/t", {}, [] {});
    g.until("l/until", {}, []() -> bool { throw 3; });
  });
  Executor executor(std::move(g), {.threads = 2});
  CHECK_THROWS_WITH(executor.run(), Contains("task l/until on rank 0: an exception of unknown type"));
  Graph h;
  h.send("h/send", {}, {0, 1, []() -> std::span<std::byte> { throw std::runtime_error("no memory"); }});
  Executor sender(std::move(h), {.threads = 1});
  CHECK_THROWS_WITH(sender.run(), "task h/send on rank 0: no memory");
  Graph k;
  k.send("k/send", {}, {0, 1, []() -> std::span<std::byte> { throw 3; }});
  Executor thrower(std::move(k), {.threads = 1});
  CHECK_THROWS_WITH(thrower.run(), "task k/send on rank 0: an exception of unknown type");
}

TEST_CASE("what is told of a message's size may throw anything", "[runtime][fast]") {
  double out = 1, in = 0;
  Graph g;
  g.send("m/send", {}, {0, 1, buffer_of(std::span(&out, 1))});
  g.receive("m/receive", {}, {0, 1, buffer_of(std::span(&in, 1)), [](std::size_t) { throw 3; }});
  Executor executor(std::move(g), {.threads = 2});
  CHECK_THROWS_WITH(executor.run(), "task m/receive on rank 0: an exception of unknown type");
}

TEST_CASE("a hang is dumped with what waits for what, and ends the run", "[runtime][fast]") {
  std::FILE* log = std::tmpfile();
  Graph g;
  const Datum halo = g.datum(), x = g.datum();
  double value = 0;
  g.receive("sea/halo/receive", {writes(halo)}, {0, 7, buffer_of(std::span(&value, 1))});
  g.task("sea/force/1", {reads(halo), updates(x)}, [] {});
  g.task("sea/free", {}, [] {});
  Executor executor(std::move(g), {.threads = 2, .watchdog_s = 0.2, .watchdog_file = log});
  CHECK_THROWS_AS(executor.run(), HangError);
  std::rewind(log);
  char text[2000] = {};
  CHECK(std::fread(text, 1, sizeof text - 1, log) > 0);
  std::fclose(log);
  CHECK_THAT(text, Contains("sea/halo/receive (iteration 0) waits for rank 0, tag 7"));
  CHECK_THAT(text, Contains("sea/force/1 (iteration 0) waits for sea/halo/receive"));
  CHECK_THAT(text, !Contains("sea/free"));
}

TEST_CASE("where the process has a watchdog its time counts, not that of an executor", "[runtime][fast]") {
  std::FILE* log = std::tmpfile();
  const Watchdog watchdog(Watchdog::Of::process, 0.2, log);
  for (int n = 0; n < 2; ++n) {
    Graph g;
    double value = 0;
    g.receive("sea/halo/receive", {writes(g.datum())}, {0, 7, buffer_of(std::span(&value, 1))});
    Executor executor(std::move(g), {.threads = 2, .watchdog_s = 0});
    CHECK_THROWS_AS(executor.run(), HangError);
  }
  Watchdog::set_limit(0.0);
  CHECK(Watchdog::current() == nullptr);
  std::rewind(log);
  char text[2000] = {};
  CHECK(std::fread(text, 1, sizeof text - 1, log) > 0);
  std::fclose(log);
  CHECK_THAT(text, Contains("sea/halo/receive (iteration 0) waits for rank 0, tag 7"));
}

TEST_CASE("a task that only takes long is named by the watchdog and left to finish", "[runtime][fast]") {
  std::FILE* log = std::tmpfile();
  Graph g;
  bool done = false;
  g.task("library/setup", {}, [&] { std::this_thread::sleep_for(std::chrono::milliseconds(600)), done = true; });
  Executor(std::move(g), {.threads = 2, .watchdog_s = 0.2, .watchdog_file = log}).run();
  std::rewind(log);
  char text[2000] = {};
  CHECK(std::fread(text, 1, sizeof text - 1, log) > 0);
  std::fclose(log);
  CHECK(done);
  CHECK_THAT(text, Contains("thread 0 is inside library/setup") || Contains("thread 1 is inside library/setup"));
}

TEST_CASE("a task that throws on one rank stops the others within a second", "[runtime][mpi4]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Graph g(MPI_COMM_WORLD);
  const Datum x = g.datum(), sum = g.datum();
  std::vector<double> partial = {1.0};
  double result = 0;
  g.task("aero/residual/12", {updates(x)}, [rank](const Context& c) {
    if (rank == 2 && c.iteration == 5) throw std::runtime_error("negative density");
  });
  g.reduce("aero/norm", {reads(x), writes(sum)}, {.partials = partial, .result = {&result, 1}});
  Executor executor(std::move(g), {.threads = 2});
  const auto start = std::chrono::steady_clock::now();
  CHECK_THROWS_WITH(executor.run(1000), Contains("task aero/residual/12 on rank 2: negative density"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}
