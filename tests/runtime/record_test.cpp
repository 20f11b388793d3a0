// Clock, records and the sums of times that the trace and the efficiency table are made of.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/record.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "runtime/executor/executor.hpp"

using namespace spindrift::runtime;

TEST_CASE("the clock counts nanoseconds", "[runtime][fast]") {
  using std::chrono::steady_clock;
  const auto before = steady_clock::now();
  const auto first = Clock::now_ns();
  const auto from = steady_clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto to = steady_clock::now();
  const auto last = Clock::now_ns();
  const auto after = steady_clock::now();
  // Readings that enclose each other: however long this thread waits for a processor between two of them.
  const auto ns = [](steady_clock::duration d) { return std::chrono::duration<double, std::nano>(d).count(); };
  CHECK(double(last - first) >= 0.98 * ns(to - from));
  CHECK(double(last - first) <= 1.02 * ns(after - before));
}

TEST_CASE("every run of every task leaves a record, costs and times agree with it", "[runtime][fast]") {
  Graph g;
  const auto x = g.data(4);
  for (std::size_t i = 0; i < 4; ++i)
    g.task("sea/t/" + std::to_string(i), {updates(x[i])}, [] { std::this_thread::sleep_for(std::chrono::microseconds(200)); });
  Executor executor(std::move(g), {.threads = 2, .records = 1000});
  executor.run(3), executor.run(2);
  std::vector<std::int64_t> ns(4, 0);
  std::vector<std::vector<std::uint32_t>> replays(4);
  for (int t = 0; t < 2; ++t) {
    std::int64_t in_tasks = 0, last_end = 0;
    for (const Record& r : executor.records(t)) {
      CHECK(r.begin_ns <= r.end_ns);
      CHECK(r.begin_ns >= last_end);
      last_end = r.end_ns;
      if (r.activity != Activity::task) continue;
      in_tasks += r.end_ns - r.begin_ns;
      ns.at(r.task) += r.end_ns - r.begin_ns;
      replays.at(r.task).push_back(r.replay);
      CHECK(r.thread == t);
    }
    const ThreadTimes& times = executor.times(t);
    CHECK(times.task_ns == in_tasks);
    CHECK(times.overhead_ns() >= 0);
    CHECK(times.wall_ns >= times.task_ns + times.idle_ns);
  }
  for (std::uint32_t n = 0; n < 4; ++n) {
    CHECK(executor.cost(n).total_ns == ns[n]);
    CHECK(executor.cost(n).count == 5);
    std::sort(replays[n].begin(), replays[n].end());
    CHECK(replays[n] == std::vector<std::uint32_t>{0, 1, 2, 3, 4});
  }
}

TEST_CASE("a full record buffer counts what it loses", "[runtime][fast]") {
  RecordBuffer buffer(2);
  for (int n = 0; n < 5; ++n) buffer.add({n, n, 0, 0, 0, 0, 0, Activity::task});
  CHECK(buffer.records().size() == 2);
  CHECK(buffer.records()[1].begin_ns == 1);
  CHECK(buffer.lost() == 3);
}
