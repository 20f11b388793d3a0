// The simulated executor against answers worked out by hand, and against laws that every schedule obeys, on random programs.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/simulate.hpp"

#include <catch2/catch.hpp>

#include "runtime/trace/ledger.hpp"
#include "tests/runtime/random_program.hpp"
#include "tests/runtime/replay/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

/// A random program that ran, every execution with a cost drawn from its seed.
RankRun random_run(std::uint64_t seed) {
  Ledger ledger;
  RandomProgram program(seed, 10, 8, 2);
  Graph g;
  program.record(g);
  Executor executor(std::move(g), {.threads = 1, .records = 1 << 18, .watchdog_s = 0});
  ledger.begin_window(1, Ledger::Keep::runs);
  executor.run();
  ledger.end_window();
  RankRecording rank = ledger.recording(0);
  REQUIRE(rank.runs.size() == 1);
  std::mt19937_64 draw(seed);
  for (auto& of_node : rank.runs[0].ns)
    for (std::int64_t& ns : of_node) ns = 1000 + std::int64_t(draw() % 99000);
  return {rank.graphs[0], rank.runs[0]};
}

long executions(const RankRun& rank) {
  long all = 0;
  for (const auto& of_node : rank.run.ns) all += long(of_node.size());
  return all;
}

}  // namespace

TEST_CASE("a chain takes the sum of its tasks on any number of threads", "[replay][fast]") {
  Graph g;
  const Datum x = g.datum();
  g.repeat("a/loop", 7, [&] {
    g.task("a/one", {updates(x)}, [] {});
    g.task("a/two", {updates(x)}, [] {});
  });
  const RankRun chain = worked_out(std::move(g), [](const std::string& label) { return label == "a/one" ? 10'000 : 20'000; });
  for (const int threads : {1, 2, 5}) {
    const Simulated s = simulate({&chain, 1}, ideal(1, threads));
    CHECK(s.wall_s == Approx(210 * us));
    CHECK(s.critical_path_s == Approx(210 * us));
    REQUIRE(s.critical_path.size() == 2);
    CHECK(s.critical_path[0].label == "a/two");
    CHECK(s.critical_path[0].s == Approx(140 * us));
    CHECK(s.critical_path[1].executions == 7);
    CHECK(s.busy_s == Approx(210 * us));
    CHECK(s.waiting_s == Approx((threads - 1) * 210 * us).margin(1e-15));
    CHECK(s.tasks == 14);
  }
}

TEST_CASE("a fan takes as many rounds as tasks by threads", "[replay][fast]") {
  constexpr int width = 12;
  Graph g;
  const auto x = g.data(width);
  for (int n = 0; n < width; ++n) g.task("a/t/" + std::to_string(n), {updates(x[std::size_t(n)])}, [] {});
  const RankRun fan = worked_out(std::move(g), [](const std::string&) { return 50'000; });
  CHECK(simulate({&fan, 1}, ideal(1, 1)).wall_s == Approx(600 * us));
  CHECK(simulate({&fan, 1}, ideal(1, 3)).wall_s == Approx(200 * us));
  // Five threads have homes for 3, 2, 3, 2, 2: stealing lags by a microsecond at most.
  CHECK(simulate({&fan, 1}, ideal(1, 5)).wall_s == Approx(150 * us).margin(1.1 * us));
  CHECK(simulate({&fan, 1}, ideal(1, 12)).wall_s == Approx(50 * us));
  CHECK(simulate({&fan, 1}, ideal(1, 12)).critical_path_s == Approx(50 * us));
}

TEST_CASE("the overhead of a task is paid once for each", "[replay][fast]") {
  Graph g;
  const Datum x = g.datum();
  for (int n = 0; n < 4; ++n) g.task("a/t", {updates(x)}, [] {});
  const RankRun chain = worked_out(std::move(g), [](const std::string&) { return 1000; });
  Cluster cluster = ideal(1, 1);
  cluster.task_overhead_s = 0.25 * us;
  const Simulated s = simulate({&chain, 1}, cluster);
  CHECK(s.wall_s == Approx(5 * us));
  CHECK(s.overhead_s == Approx(1 * us));
  CHECK(s.waiting_s == Approx(0.0).margin(1e-12));
}

TEST_CASE("of two loops that are ready the more urgent one runs first", "[replay][fast]") {
  Graph g;
  const Datum x = g.datum(), y = g.datum();
  g.loop("calm/loop", {.min = 3, .max = 3}, [&] { g.task("calm/t", {updates(x)}, [] {}); });
  g.loop("urgent/loop", {.min = 3, .max = 3, .urgency = 1}, [&] { g.task("urgent/t", {updates(y)}, [] {}); });
  const RankRun both = worked_out(std::move(g), [](const std::string&) { return 10'000; });
  const Simulated s = simulate({&both, 1}, ideal(1, 1));
  double urgent_ends = 0.0;
  for (const Slice& slice : s.slices)
    if (slice.module == "urgent") urgent_ends = std::max(urgent_ends, slice.end_s);
  CHECK(s.wall_s == Approx(60 * us));
  CHECK(urgent_ends < 45 * us);  // behind at most one task of the other, which was ready before it
}

TEST_CASE("on one thread the recorded costs add up, on more nothing beats the critical path or perfect sharing",
          "[replay][fast]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const RankRun run = random_run(seed);
    const double sum = sum_s(run);
    const Simulated one = simulate({&run, 1}, ideal(1, 1));
    INFO("seed " << seed);
    CHECK(one.wall_s == Approx(sum));
    CHECK(one.tasks == executions(run));
    for (const int threads : {2, 3, 8}) {
      const Simulated s = simulate({&run, 1}, ideal(1, threads));
      CHECK(s.tasks == executions(run));
      CHECK(s.busy_s == Approx(sum));
      CHECK(s.critical_path_s == Approx(one.critical_path_s));
      CHECK(s.wall_s >= std::max(s.critical_path_s, sum / threads) * (1 - 1e-9));
      // Graham (1969): no list schedule is longer than this; a thief comes a microsecond late to each task.
      CHECK(s.wall_s <= (sum + (threads - 1) * s.critical_path_s) / threads + us * double(s.tasks));
    }
  }
}

TEST_CASE("a bulk-synchronous schedule is never quicker", "[replay][fast]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const RankRun run = random_run(seed);
    INFO("seed " << seed);
    CHECK(simulate_bulk_synchronous({&run, 1}, ideal(1, 1)).wall_s == Approx(sum_s(run)));
    for (const int threads : {2, 4}) {
      const Simulated bulk = simulate_bulk_synchronous({&run, 1}, ideal(1, threads)), s = simulate({&run, 1}, ideal(1, threads));
      CHECK(bulk.busy_s == Approx(s.busy_s));
      CHECK(bulk.wall_s >= s.wall_s - us * double(s.tasks));
    }
  }
}

TEST_CASE("a message takes its latency and its bytes over the bandwidth", "[replay][fast]") {
  const auto rank = [](NodeKind kind, int peer) {
    RankRun run;
    run.graph.data.resize(1);
    run.graph.nodes.push_back({.label = "a/work", .uses = {{0, Access::update}}});
    run.graph.nodes.push_back(
        {.label = "a/message", .kind = kind, .peer = peer, .tag = 1, .bytes = 4000, .uses = {{0, Access::update}}});
    run.graph.nodes.push_back({.label = "a/after", .uses = {{0, Access::update}}});
    run.graph.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 1}};
    run.run.ns = {{kind == NodeKind::send ? 30'000 : 5'000}, {}, {10'000}};
    run.run.iterations.resize(3);
    return run;
  };
  const std::vector<RankRun> both{rank(NodeKind::send, 1), rank(NodeKind::receive, 0)};
  Cluster cluster{.nodes = 2, .ranks = 2, .threads = 1, .between = {2e-6, 1e9}, .within = {}};
  Simulated s = simulate(both, cluster);
  CHECK(s.wall_s == Approx(30 * us + 2 * us + 4 * us + 10 * us));
  CHECK(s.critical_path_s == Approx(46 * us));
  CHECK(s.bytes == 4000);
  CHECK(s.messages == 1);
  cluster.nodes = 1;  // the other wire, which takes no time
  CHECK(simulate(both, cluster).wall_s == Approx(40 * us));
}

TEST_CASE("a reduction and a collective call wait for the last rank", "[replay][fast]") {
  for (const NodeKind kind : {NodeKind::reduce, NodeKind::collective}) {
    std::vector<RankRun> ranks;
    for (int r = 0; r < 4; ++r) {
      RankRun run;
      run.graph.data.resize(1);
      run.graph.nodes.push_back({.label = "a/work", .uses = {{0, Access::update}}});
      run.graph.nodes.push_back({.label = "a/all", .kind = kind, .bytes = 1000, .uses = {{0, Access::update}}});
      run.graph.edges = {{0, 1, 0}, {1, 0, 1}};
      run.run.ns = {{10'000 * (r + 1)}, {7'000}};
      run.run.iterations.resize(2);
      ranks.push_back(std::move(run));
    }
    const Cluster cluster{.nodes = 4, .ranks = 4, .threads = 1, .between = {3e-6, 1e9}, .within = {}};
    // Two doublings of 3 us; the reduction's 1000 bytes take another 1 us each. A collective call takes its 7 us, and before it
    // the ranks agree that it is its turn.
    const double expected = kind == NodeKind::reduce ? 40 * us + 2 * 4 * us : 40 * us + (2 + 1) * 2 * 3 * us + 7 * us;
    CHECK(simulate(ranks, cluster).wall_s == Approx(expected));
    if (kind == NodeKind::reduce) continue;
    // Recorded on several ranks a call contains the wait for the others; the rank that came last did not wait.
    for (std::size_t r = 0; r < 4; ++r) ranks[r].run.ns[1][0] = 37'000 - 10'000 * std::int64_t(r);
    CHECK(simulate(ranks, cluster).wall_s == Approx(expected));
    CHECK(simulate_bulk_synchronous(ranks, cluster).wall_s ==
          Approx(expected - 2 * 3 * us));  // a barrier after the work, no agreement
  }
}

TEST_CASE("a reduction, call or message that was skipped sends nothing and waits for nobody", "[replay][fast]") {
  for (const NodeKind kind : {NodeKind::reduce, NodeKind::collective, NodeKind::send}) {
    std::vector<RankRun> ranks;
    for (int r = 0; r < 2; ++r) {  // five times: work, then what all wait for
      RankRun run;
      run.graph.data.resize(1);
      run.graph.nodes.push_back({.label = "a/loop", .kind = NodeKind::loop, .limits = {5, 5}, .uses = {{0, Access::update}}});
      run.graph.nodes.push_back({.label = "a/work", .loop = 0, .uses = {{0, Access::update}}});
      NodeRecord all{.label = "a/all", .kind = kind, .loop = 0, .bytes = 1000, .uses = {{0, Access::update}}};
      if (kind == NodeKind::send) all.kind = r == 0 ? NodeKind::send : NodeKind::receive, all.peer = 1 - r, all.tag = 1;
      run.graph.nodes.push_back(all);
      run.graph.edges = {{1, 2, 0}, {2, 1, 1}, {0, 0, 1}};
      run.run.ns = {{}, std::vector<std::int64_t>(5, 10'000), std::vector<std::int64_t>(5, 7'000)};
      run.run.iterations = {{5}, {}, {}};
      ranks.push_back(std::move(run));
    }
    const Cluster cluster{.nodes = 2, .ranks = 2, .threads = 1, .between = {3e-6, 1e9}, .within = {}};
    const auto check = [&](double made) {
      const Simulated s = simulate(ranks, cluster), bulk = simulate_bulk_synchronous(ranks, cluster);
      // 3 us and 1000 bytes; a call: twice for its turn, its 7 us, once until all have done it. Of messages, for which the sender
      // does not wait, the last one is felt.
      const double felt = kind == NodeKind::collective ? made * (3 * 3 + 7)
                          : kind == NodeKind::reduce   ? made * 4
                          : made > 0                   ? 4
                                                       : 0;
      CHECK(s.wall_s == Approx((5 * 10 + felt) * us));
      CHECK(s.reductions == (kind == NodeKind::reduce ? long(made) : 0));
      CHECK(s.messages == (kind == NodeKind::send ? long(made) : 0));
      CHECK(bulk.reductions == s.reductions);
      CHECK(bulk.messages == s.messages);
      const double barrier = 3 * us, of_bulk = kind == NodeKind::collective ? 10 * us : 4 * us;  // a barrier after each work
      CHECK(bulk.wall_s == Approx(5 * (10 * us + barrier) + made * of_bulk));
    };
    INFO("kind " << int(kind));
    check(5);
    for (RankRun& rank : ranks) rank.run.skipped[2] = {0, 1, 2};
    check(2);
    for (RankRun& rank : ranks) rank.run.skipped[2] = {0, 1, 2, 3, 4};
    check(0);
  }
}

TEST_CASE("skew slows some ranks and quickens others, the same in every simulation", "[replay][fast]") {
  Cluster cluster{.ranks = 400};
  CHECK(speed_factor(cluster, 3) == 1.0);
  cluster.skew = 0.1;
  double mean = 0, squares = 0;
  for (int r = 0; r < cluster.ranks; ++r) {
    const double f = speed_factor(cluster, r);
    CHECK(f == speed_factor(cluster, r));
    mean += f / cluster.ranks, squares += (f - 1) * (f - 1) / cluster.ranks;
  }
  CHECK(mean == Approx(1.0).margin(0.02));
  CHECK(std::sqrt(squares) == Approx(0.1).margin(0.02));
}

TEST_CASE("ranks that wait for each other are an error, not a hang", "[replay][fast]") {
  RankRun run;
  run.graph.data.resize(1);
  run.graph.nodes.push_back(
      {.label = "a/receive", .kind = NodeKind::receive, .peer = 1, .tag = 1, .uses = {{0, Access::update}}});
  run.run.ns.resize(1), run.run.iterations.resize(1);
  CHECK_THROWS_WITH(simulate({&run, 1}, ideal(1, 1)), Catch::Contains("waits for ever"));
}
