// The ledger accounts for all time of all threads: executors that are gone, spans inside spans, and what nobody named.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/ledger.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <numeric>

#include "runtime/executor/executor.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/trace_of.hpp"

using namespace spindrift::runtime;

namespace {

constexpr std::int64_t ms = 1000000;

void work_for(std::int64_t ns) {
  const std::int64_t end = Clock::now_ns() + ns;
  while (Clock::now_ns() < end) {}
}

Executor busy_executor(std::size_t records = 0) {
  Graph graph;
  const Datum x = graph.datum();
  graph.task("sea/force/0", {updates(x)}, [] { work_for(2 * ms); });
  graph.task("aero/residual/0", {updates(x)}, [] { work_for(ms); });
  return Executor(std::move(graph), {.threads = 2, .records = records});
}

TaskCost cost_of(const RankTrace& trace, const std::string& label) {
  TaskCost cost;
  for (const TraceNode& node : trace.nodes)
    if (node.label == label) cost.total_ns += node.cost.total_ns, cost.count += node.cost.count;
  return cost;
}

}  // namespace

TEST_CASE("tasks of executors that are gone and of live ones are one sum", "[trace][fast]") {
  const Ledger ledger;
  busy_executor().run(3);
  Executor live = busy_executor();
  live.run(2);
  const RankTrace trace = ledger.trace(0);
  CHECK(cost_of(trace, "sea/force/0").count == 5);
  CHECK(cost_of(trace, "sea/force/0").total_ns >= 10 * ms);
  // The same task recorded twice is one node.
  CHECK(std::ranges::count(trace.nodes, "sea/force/0", &TraceNode::label) == 1);
}

TEST_CASE("sums are those of the trace, without its records, and end where the run does", "[trace][fast]") {
  Ledger ledger(100);
  busy_executor(1000).run(3);
  Executor live = busy_executor(1000);
  live.run(2);
  {
    const Span span("output/history");
    work_for(ms);
  }
  ledger.move("sea", "bodies/substeps", ms, 7);
  ledger.close();
  work_for(5 * ms);
  const RankTrace trace = ledger.trace(0), sums = ledger.sums(0);
  CHECK(ledger.records() == trace.records.size());
  CHECK(sums.records.empty());
  CHECK(sums.edges.empty());
  CHECK(cost_of(sums, "sea").count == 5);
  const RankTrace same = by_module(trace);
  REQUIRE(sums.nodes.size() == same.nodes.size());
  for (std::size_t n = 0; n < sums.nodes.size(); ++n) {
    CHECK(sums.nodes[n].label == same.nodes[n].label);
    CHECK(sums.nodes[n].cost.total_ns == same.nodes[n].cost.total_ns);
    CHECK(sums.nodes[n].cost.count == same.nodes[n].cost.count);
  }
  REQUIRE(sums.threads.size() == trace.threads.size());
  for (std::size_t t = 0; t < sums.threads.size(); ++t) CHECK(sums.threads[t].wall_ns == trace.threads[t].wall_ns);
}

TEST_CASE("a run on one thread is not charged for the others of OpenMP", "[trace][fast]") {
  const Ledger ledger(0, 1);
  {
    const Span start("sea/start");
    work_for(ms);
  }
  const RankTrace trace = ledger.trace(0);
  REQUIRE(trace.threads.size() == 1);
  CHECK(trace.threads[0].task_ns >= ms);
}

TEST_CASE("for each thread work, waiting, messages and overhead make up the ledger's time", "[trace][fast]") {
  const std::int64_t begin = Clock::now_ns();
  const Ledger ledger;
  {
    const Span start("sea/start");
    work_for(2 * ms);
    busy_executor().run();
  }
  work_for(ms);
  const RankTrace trace = ledger.trace(0);
  const std::int64_t wall = Clock::now_ns() - begin;
  REQUIRE(trace.threads.size() >= 2);
  std::int64_t tasks = 0, nodes = 0;
  for (const ThreadTimes& thread : trace.threads) {
    CHECK(thread.wall_ns == trace.threads[0].wall_ns);
    CHECK(thread.overhead_ns() >= 0);
    tasks += thread.task_ns;
  }
  CHECK(trace.threads[0].wall_ns <= wall);
  CHECK(trace.threads[0].wall_ns >= 6 * ms);
  for (const TraceNode& node : trace.nodes) nodes += node.cost.total_ns;
  CHECK(double(nodes) == Approx(double(tasks)).epsilon(0.01));
  const Efficiency e = efficiency_of(std::span(&trace, 1));
  CHECK(e.busy_s + e.idle_s + e.poll_s + e.overhead_s == Approx(e.wall_s));
}

TEST_CASE("a span has neither the time of spans nor of executors inside it", "[trace][fast]") {
  const Ledger ledger;
  {
    const Span outer("output/history");
    work_for(ms);
    {
      const Span inner("output/checkpoint");
      work_for(20 * ms);
    }
    {
      const Span wait("run/other part", Span::Kind::wait);
      work_for(20 * ms);
    }
    busy_executor().run(10);
  }
  const RankTrace trace = ledger.trace(0);
  CHECK(cost_of(trace, "output/checkpoint").total_ns >= 20 * ms);
  CHECK(cost_of(trace, "output/history").total_ns >= ms);
  // All of the others are at least 70 ms: had it any of them it would be above its own by their size.
  const std::int64_t all = trace.threads[0].wall_ns;
  CHECK(cost_of(trace, "output/history").total_ns <= all - 70 * ms);
  CHECK(cost_of(trace, "run/other part").count == 0);  // no work
  CHECK(trace.threads[0].idle_ns >= 20 * ms);
}

TEST_CASE("time that a task spent for others moves to their label and no module goes below zero", "[trace][fast]") {
  Ledger ledger;
  busy_executor().run(4);
  const std::int64_t before = cost_of(ledger.trace(0), "sea/force/0").total_ns;
  ledger.move("sea", "bodies/substeps", 3 * ms, 7);
  const RankTrace trace = ledger.trace(0);
  CHECK(cost_of(trace, "bodies/substeps").total_ns == 3 * ms);
  CHECK(cost_of(trace, "bodies/substeps").count == 7);
  CHECK(cost_of(trace, "sea/force/0").total_ns == before - 3 * ms);
  ledger.move("aero", "rotor/loads", 1000000 * ms, 1);  // more than there is
  for (const TraceNode& node : ledger.trace(0).nodes) CHECK(node.cost.total_ns >= 0);
}

TEST_CASE("records of executors and of spans are in one trace, each run a replay of its own", "[trace][fast]") {
  const Ledger ledger(100);
  busy_executor(1000).run(2);
  {
    const Span span("output/history");
    work_for(ms);
  }
  busy_executor(1000).run(2);
  const RankTrace trace = ledger.trace(0);
  std::vector<std::uint32_t> replays;
  bool output = false;
  for (const Record& record : trace.records) {
    if (record.activity != Activity::task) continue;
    REQUIRE(record.task < trace.nodes.size());
    const std::string& label = trace.nodes[record.task].label;
    if (label == "sea/force/0") replays.push_back(record.replay);
    output = output || label == "output/history";
  }
  std::ranges::sort(replays);
  CHECK(replays == std::vector<std::uint32_t>{0, 1, 2, 3});
  CHECK(output);
}
