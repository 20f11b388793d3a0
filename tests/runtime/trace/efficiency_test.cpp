// The efficiency table against traces whose figures are worked out in the comments. Times in microseconds.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/efficiency.hpp"

#include <catch2/catch.hpp>

#include "runtime/trace/trace_of.hpp"
#include "tests/runtime/trace/synthetic.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

/// aero: a chain of two tasks of 10; sea: four independent tasks of 5. Together on two threads: 20, both busy throughout.
std::vector<RankTrace> two_modules() {
  SyntheticRank rank(0, 2);
  const auto a = rank.node("aero/a"), b = rank.node("aero/b");
  rank.edge(a, b);
  rank.ran(a, 0, 10), rank.ran(b, 10, 20);
  for (const int n : {0, 1, 2, 3}) rank.ran(rank.node("sea/s/" + std::to_string(n)), 5 * n, 5 * n + 5, 1);
  return {rank.trace(20)};
}

}  // namespace

TEST_CASE("overlap gained by two modules, as worked out by hand", "[trace][fast]") {
  // Alone on two threads aero takes 20 (its chain), sea 10 (20 of work on 2 threads): 30 one after the other, 20 together.
  const Efficiency e = efficiency_of(two_modules());
  CHECK(e.overlap_gain == Approx(1.5));
  CHECK(e.parallel == Approx(1.0));
  CHECK(e.idle_s == 0.0);
  CHECK(e.recorded == Approx(1.0));
  REQUIRE(e.modules.size() == 2);
  CHECK(e.modules[0].module == "aero");
  CHECK(e.modules[0].alone_s == Approx(20e-6));
  CHECK(e.modules[1].alone_s == Approx(10e-6));
  CHECK(e.modules[1].busy_s == Approx(20e-6));
}

TEST_CASE("modules that took turns gained nothing", "[trace][fast]") {
  SyntheticRank rank(0, 2);
  rank.ran(rank.node("aero/a/0"), 0, 10, 0), rank.ran(rank.node("aero/a/1"), 0, 10, 1);
  rank.ran(rank.node("sea/s/0"), 10, 14, 0), rank.ran(rank.node("sea/s/1"), 10, 14, 1);
  CHECK(efficiency_of(std::vector{rank.trace(14)}).overlap_gain == Approx(1.0));
}

TEST_CASE("alone, a module waits for its busiest rank in each window", "[trace][fast]") {
  // aero works 8 and 2 on the two ranks in the first window, 2 and 8 in the second: 8 + 8 alone, though 10 on each rank in sum.
  std::vector<RankTrace> traces;
  for (const int r : {0, 1}) {
    SyntheticRank rank(r);
    const auto a = rank.node("aero/a");
    const double first = r == 0 ? 8 : 2;
    rank.ran(a, 0, first, 0, 0), rank.ran(a, first, 10, 0, 1);
    traces.push_back(rank.trace(10));
  }
  const Efficiency e = efficiency_of(traces);
  CHECK(e.modules[0].alone_s == Approx(16e-6));
  CHECK(e.overlap_gain == Approx(1.6));
}

TEST_CASE("imbalance shows as load balance alone", "[trace][fast]") {
  SyntheticRank left(0), right(1);
  left.ran(left.node("aero/a"), 0, 10);
  right.ran(right.node("aero/a"), 0, 6), right.idle(6, 10);
  const Efficiency e = efficiency_of(std::vector{left.trace(10), right.trace(10)});
  CHECK(e.load_balance == Approx(0.8));  // mean 8 of at most 10
  CHECK(e.communication == Approx(1.0));
  CHECK(e.serialisation == Approx(1.0));
  CHECK(e.transfer == Approx(1.0));
  CHECK(e.parallel == Approx(0.8));
  CHECK(e.exposed_s == 0.0);
}

TEST_CASE("an exposed message: transfer, serialisation and load balance by hand", "[trace][fast]") {
  // Busy 4 and 5 of 12. Rank 1 waits 0-4 for rank 0 to post and 4-7 for the message; rank 0 is idle 4-12, of which its send
  // takes 1.
  const Efficiency e = efficiency_of(one_message());
  CHECK(e.elapsed_s == Approx(12e-6));
  CHECK(e.parallel == Approx(4.5 / 12));
  CHECK(e.load_balance == Approx(4.5 / 5));
  CHECK(e.communication == Approx(5.0 / 12));
  CHECK(e.transfer == Approx(1 - 3.0 / 12));
  CHECK(e.serialisation == Approx(5.0 / 9));
  CHECK(e.idle_s == Approx(15e-6));
  CHECK(e.exposed_s == Approx(4e-6));
  CHECK(e.partner_wait_s == Approx(4e-6));
  CHECK(e.critical_path_s == Approx(12e-6));
  for (const ModuleTimes& m : e.modules) {
    CHECK(m.exposed_s == Approx(m.module == "aero" ? 4e-6 : 0.0).margin(1e-15));  // the message's label says aero
    CHECK(m.idle_s == Approx(m.module == "sea" ? 7e-6 : 0.0).margin(1e-15));      // b ended an idle time; rank 0's had no end
  }
}

TEST_CASE("a message hidden behind work is not exposed", "[trace][fast]") {
  SyntheticRank left(0), right(1);
  const auto send = left.message("aero/send", NodeKind::send, 1, 0),
             receive = right.message("aero/receive", NodeKind::receive, 0, 0);
  left.ran(send, 0, 1), left.ran(left.node("aero/a"), 0, 10);
  right.ran(receive, 0, 8), right.ran(right.node("sea/s"), 0, 10);
  const Efficiency e = efficiency_of(std::vector{left.trace(10), right.trace(10)});
  CHECK(e.exposed_s == 0.0);
  CHECK(e.transfer == 1.0);
}

TEST_CASE("runtime overhead is what is neither work, waiting nor message", "[trace][fast]") {
  SyntheticRank rank(0);
  rank.ran(rank.node("m/x"), 0, 7), rank.idle(8, 9);
  const Efficiency e = efficiency_of(std::vector{rank.trace(10)});
  CHECK(e.overhead_s == Approx(2e-6));
  CHECK(e.communication == Approx(0.7));
}

TEST_CASE("without records the totals stand and the rest is unknown", "[trace][fast]") {
  auto traces = one_message();
  for (RankTrace& trace : traces) trace.records.clear();
  const Efficiency e = efficiency_of(traces);
  CHECK(e.parallel == Approx(4.5 / 12));
  CHECK(e.load_balance == Approx(0.9));
  CHECK(std::isnan(e.transfer));
  CHECK(std::isnan(e.overlap_gain));
  CHECK(e.recorded == 0.0);
  CHECK(efficiency_table(e) ==
        "2 threads on 2 ranks, busy for 37.5 % of the time: parallel efficiency = load balance 90.0 % x communication 41.7 %");

  // Ranks send no more than these totals are made of.
  std::vector<RankTrace> sums;
  for (const RankTrace& trace : traces) sums.push_back(by_module(trace));
  CHECK(by_module(two_modules()[0]).nodes.size() == 2);
  const Efficiency of_sums = efficiency_of(sums);
  REQUIRE(of_sums.modules.size() == e.modules.size());
  for (std::size_t m = 0; m < e.modules.size(); ++m) {
    CHECK(of_sums.modules[m].busy_s == Approx(e.modules[m].busy_s));
    CHECK(of_sums.modules[m].calls == e.modules[m].calls);
  }
  CHECK(of_sums.parallel == e.parallel);
}

TEST_CASE("a recorded part stands for the whole of waiting", "[trace][fast]") {
  auto traces = one_message();
  for (RankTrace& trace : traces)
    for (ThreadTimes& times : trace.threads) times.wall_ns *= 2, times.task_ns *= 2, times.idle_ns *= 2;
  const Efficiency e = efficiency_of(traces);
  CHECK(e.recorded == Approx(0.5));
  CHECK(e.exposed_s == Approx(8e-6));
  CHECK(e.transfer == Approx(0.75));
  CHECK_THAT(efficiency_table(e), Catch::Contains("records cover 50.0 % of the run"));
}

TEST_CASE("the product of the factors is the parallel efficiency", "[trace][fast]") {
  const Efficiency e = efficiency_of(one_message());
  CHECK(e.load_balance * e.serialisation * e.transfer == Approx(e.parallel));
}

TEST_CASE("the table names every figure and fits its width", "[trace][fast]") {
  const std::string table = efficiency_table(efficiency_of(one_message()));
  for (const char* name : {"parallel efficiency", "load balance", "communication efficiency", "serialisation", "transfer",
                           "waiting", "waiting for", "runtime overhead", "overlap gained", "critical path", "sea/b", "aero"})
    CHECK_THAT(table, Catch::Contains(name));
  CHECK_THAT(table, !Catch::Contains("idle"));
  CHECK_THAT(table, Catch::Contains("transfer                       75.0 %"));
  for (std::size_t at = 0; at < table.size();) {
    const std::size_t end = table.find('\n', at);
    CHECK(end - at <= 120);
    at = end + 1;
  }
  CHECK_FALSE(efficiency_table(efficiency_of({})).empty());
}
