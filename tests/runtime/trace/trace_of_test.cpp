// From a real run of the executor to traces, the table and the Chrome file; on two ranks with clocks brought together.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/trace_of.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/executor/executor.hpp"
#include "runtime/trace/chrome.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/occurrences.hpp"

using namespace spindrift::runtime;

namespace {

void work_for(std::chrono::microseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {}
}

/// A task, a loop of three iterations of two tasks, a task: replayed `replays` times.
RankTrace trace_of_a_loop(std::uint32_t replays, std::size_t records) {
  Graph graph;
  const Datum x = graph.datum();
  const auto busy = [] { work_for(std::chrono::microseconds(200)); };
  graph.task("bodies/before", {updates(x)}, busy);
  graph.repeat("sea/substeps", 3, [&] {
    graph.task("sea/force/0", {updates(x)}, busy);
    graph.task("sea/move/0", {updates(x)}, busy);
  });
  graph.task("bodies/after", {updates(x)}, busy);
  Executor executor(std::move(graph), {.threads = 2, .records = records});
  executor.run(replays);
  return trace_of(executor);
}

}  // namespace

TEST_CASE("the trace of a run holds its nodes, its executions and what they cost", "[trace][fast]") {
  const RankTrace trace = trace_of_a_loop(2, 1000);
  REQUIRE(trace.nodes.size() == 5);
  CHECK(trace.nodes[1].kind == NodeKind::loop);
  CHECK(trace.nodes[2].loop == 1);
  CHECK(trace.nodes[2].cost.count == 6);
  CHECK(trace.threads.size() == 2);
  CHECK(trace.complete_until == RankTrace::always);
  const auto tasks = std::ranges::count_if(trace.records, [](const Record& r) { return r.activity == Activity::task; });
  CHECK(tasks == 2 * (1 + 6 + 1));
  std::int64_t of_threads = 0, of_nodes = 0;
  for (const ThreadTimes& times : trace.threads) of_threads += times.task_ns;
  for (const TraceNode& node : trace.nodes) of_nodes += node.cost.total_ns;
  CHECK(of_threads == of_nodes);
}

TEST_CASE("a chain of data is the critical path of its run, through loops and replays", "[trace][fast]") {
  const std::vector traces{trace_of_a_loop(3, 1000)};
  const Efficiency e = efficiency_of(traces);
  CHECK(e.critical_path_s == Approx(e.busy_s));  // every task waits for the one before
  CHECK(e.critical_path_s >= 3 * 8 * 200e-6);
  CHECK(e.recorded > 0.0);
  CHECK(e.modules.size() == 2);
  CHECK(e.parallel == Approx(e.busy_s / (2 * e.elapsed_s)));
  CHECK(e.parallel <= 0.5);  // a second thread has nothing to do, if it comes to look for work at all
}

TEST_CASE("each execution in a loop follows exactly the one before it in the chain", "[trace][fast]") {
  const std::vector traces{trace_of_a_loop(3, 1000)};
  const Occurrences all = occurrences_of(traces);
  int joined = 0, first = 0;
  for (const Occurrence& o : all.all) {
    if (o.record == nullptr) continue;
    std::int64_t last_end = -1;
    for (const std::uint32_t b : all.before_of(o)) last_end = std::max(last_end, all.all[b].end);
    if (last_end < 0) ++first;
    std::int64_t previous_end = -1;  // of all tasks that ended before this one began, the last
    for (const Occurrence& other : all.all)
      if (other.record != nullptr && other.end <= o.begin) previous_end = std::max(previous_end, other.end);
    CHECK(last_end == previous_end);
    ++joined;
  }
  CHECK(joined == 24);
  CHECK(first == 1);
}

TEST_CASE("a run with too few records says until when they are complete", "[trace][fast]") {
  const RankTrace trace = trace_of_a_loop(3, 6);
  CHECK(trace.complete_until < RankTrace::always);
  const Efficiency e = efficiency_of(std::vector{trace});
  CHECK(e.recorded < 1.0);
  CHECK(e.recorded > 0.0);
  CHECK(e.busy_s >= 3 * 8 * 200e-6);  // totals do not need records
}

TEST_CASE("traces of two ranks meet on rank 0 on one clock", "[trace][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::vector<double> mine(100, rank), other(100, -1.0);
  constexpr std::uint32_t steps = 20;
  Graph graph(MPI_COMM_WORLD);
  const Datum d_mine = graph.datum(), d_other = graph.datum();
  graph.repeat("aero/steps", steps, [&] {
    graph.task("aero/step", {updates(d_mine), reads(d_other)}, [] { work_for(std::chrono::microseconds(100)); });
    graph.send("aero/send", {reads(d_mine)}, {1 - rank, rank, buffer_of(std::span(mine))});
    graph.receive("aero/receive", {writes(d_other)}, {1 - rank, 1 - rank, buffer_of(std::span(other))});
  });
  Executor executor(std::move(graph), {.threads = 1, .records = 10000});
  executor.run();
  const auto traces = gather_traces(trace_of(executor, rank), MPI_COMM_WORLD);
  if (rank != 0) {
    CHECK(traces.empty());
    return;
  }
  REQUIRE(traces.size() == 2);
  CHECK(traces[1].rank == 1);
  CHECK(traces[1].nodes[0].label == "aero/steps");
  const Occurrences all = occurrences_of(traces);
  int received = 0;
  for (const Occurrence& o : all.all) {
    if (o.record == nullptr || o.record->activity != Activity::receive) continue;
    REQUIRE(all.partners_of(o).size() == 1);
    const Occurrence& sent = all.all[all.partners_of(o)[0]];
    CHECK(sent.trace == 1 - o.trace);
    CHECK(sent.record->iteration == o.record->iteration);
    CHECK(sent.begin < o.end + 20'000);  // nothing arrives before it was sent, but for the precision of the clocks
    ++received;
  }
  CHECK(received == 2 * steps);
  const Efficiency e = efficiency_of(traces);
  CHECK(e.ranks == 2);
  CHECK(e.critical_path_s >= steps * 100e-6);  // each step needs the other's step before it
  CHECK(e.load_balance * e.serialisation * e.transfer == Approx(e.parallel));

  const std::string path = std::string(SPINDRIFT_BINARY_DIR) + "/trace_of_test.json";
  write_chrome_trace(traces, path);
  const auto file = nlohmann::json::parse(std::ifstream(path));
  std::remove(path.c_str());
  const auto arrows = std::ranges::count_if(file["traceEvents"], [](const auto& event) { return event["ph"] == "s"; });
  CHECK(arrows == 2 * steps);
}
