// Placements of two sides side by side, on graphs whose answers can be worked out. SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/predict.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>

#include "runtime/replay/recut.hpp"
#include "tests/runtime/replay/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

Side side_of(std::string_view module) {
  return module == "exchange" ? Side::either : module == "aero" ? Side::second : Side::first;
}

/// `steps` tasks, one after the other, on each of `tiles` tiles that have nothing to do with each other.
void chains(Graph& g, const std::string& module, std::size_t tiles, std::uint32_t steps) {
  const auto a = g.data(tiles), b = g.data(tiles), c = g.data(tiles);
  g.repeat(module + "/steps", steps, [&] {
    for (std::size_t n = 0; n < tiles; ++n)
      g.task(module + "/t/" + std::to_string(n), {updates(a[n]), updates(b[n]), updates(c[n])}, [] {});
  });
}

/// Sea of three chains of 100 us and air of one of 90 us, as one graph or as two; 15 us of a window are outside of them. With an
/// exchange, which takes no time, each graph has its own, and the air runs first.
Recording two_sides(bool one_graph, bool exchange = false) {
  const auto cost = [](const std::string& label) {
    return label.starts_with("exchange") ? 0 : label.starts_with("aero") ? 9'000 : 10'000;
  };
  Graph sea, air;
  chains(sea, "sea", 3, 10);
  chains(one_graph ? sea : air, "aero", 1, 10);
  if (exchange)
    for (Graph* graph : {&sea, &air}) graph->task("exchange/give", {updates(graph->datum())}, [] {});
  Recording recording{.scene = "s", .program = "p", .windows = {{4, 405'000}, {5, 405'000}}};
  RankRecording& rank = recording.ranks.emplace_back();
  std::vector<RankRun> runs{worked_out(std::move(sea), cost)};
  if (!one_graph) runs.push_back(worked_out(std::move(air), cost));
  if (exchange) std::ranges::reverse(runs);
  for (const WindowRecord& window : recording.windows)
    for (std::uint32_t g = 0; g < runs.size(); ++g) {
      rank.runs.push_back(runs[g].run);
      rank.runs.back().graph = g, rank.runs.back().window = window.number;
    }
  for (RankRun& run : runs) rank.graphs.push_back(std::move(run.graph));
  return recording;
}

}  // namespace

TEST_CASE("placements of two sides: in turns, shared, split and in bulk", "[replay][fast]") {
  for (const auto& [one_graph, exchange] :
       {std::pair{false, false}, std::pair{true, false}, std::pair{false, true}, std::pair{true, true}}) {
    const Recording recording = two_sides(one_graph, exchange);
    const auto wall = [&](int ranks, int threads, Placement placement) {
      const Prediction p = predict(recording, ideal(ranks, threads), placement, side_of);
      CHECK(p.windows == 2);
      CHECK(p.outside_s == Approx(15 * us));
      CHECK(p.work_s == Approx(390 * us));
      CHECK(p.tasks.busy_s == Approx(390 * us));
      CHECK(p.efficiency == Approx(390 * us / (ranks * threads * p.wall_s)));
      const double cores = ranks * threads;
      CHECK(p.tasks.busy_s + p.tasks.waiting_s + p.tasks.overhead_s == Approx(cores * p.tasks.wall_s));
      return p.wall_s - p.outside_s;
    };
    for (const Placement placement : {Placement::in_turns, Placement::shared, Placement::bulk_synchronous})
      CHECK(wall(1, 1, placement) == Approx(390 * us));
    CHECK(wall(1, 4, Placement::in_turns) == Approx(190 * us).margin(2 * us));  // three chains, then one
    CHECK(wall(1, 4, Placement::shared) == Approx(100 * us).margin(2 * us));    // all four at once
    CHECK(wall(4, 1, Placement::split) == Approx(100 * us));                    // a rank has the air
    CHECK(wall(2, 1, Placement::split) == Approx(300 * us));                    // the sea's rank is the longer
    CHECK(wall(1, 4, Placement::bulk_synchronous) == Approx(190 * us));
  }
}

TEST_CASE("copies without anything between them take the time of one, however both sides are placed", "[replay][fast]") {
  for (const bool one_graph : {false, true}) {
    const Recording recording = two_sides(one_graph);
    for (const Placement placement : placements) {
      const Prediction one = predict(recording, ideal(4, 1), placement, side_of);
      Cluster many = ideal(64, 1);
      many.nodes = many.copies = 16;
      const Prediction all = predict(recording, many, placement, side_of);
      INFO(name_of(placement));
      CHECK(all.wall_s == Approx(one.wall_s).margin(2 * us));
      CHECK(all.work_s == Approx(16 * one.work_s));
      CHECK(all.tasks.busy_s == Approx(16 * one.tasks.busy_s));
      CHECK(all.tasks.tasks == 16 * one.tasks.tasks);
      CHECK(all.second_side_ranks == 16 * one.second_side_ranks);
      CHECK(all.simulated_copies == simulated_units);
    }
  }
}

TEST_CASE("what a recording can be replayed as", "[replay][fast]") {
  const Recording two = two_sides(false);
  CHECK(possible(two, 1, side_of) == std::vector{Placement::in_turns, Placement::shared, Placement::bulk_synchronous});
  CHECK(possible(two, 2, side_of).size() == 4);
  Recording one = two;
  one.ranks[0].graphs.resize(1);
  std::erase_if(one.ranks[0].runs, [](const RunRecord& run) { return run.graph > 0; });
  CHECK(possible(one, 8, side_of) == std::vector{Placement::shared, Placement::bulk_synchronous});
  Recording both_ranks = two;
  both_ranks.ranks.push_back(both_ranks.ranks[0]);
  CHECK_THROWS_WITH(predict(both_ranks, ideal(3, 1), Placement::shared, side_of), Catch::Contains("recorded on 2 ranks"));
  const Prediction both = predict(both_ranks, ideal(2, 1), Placement::shared, side_of);
  CHECK(both.wall_s == Approx(405 * us));
  CHECK(both.efficiency == Approx(390.0 / 405.0));
  Recording none = two;
  none.windows.clear();
  CHECK_THROWS_WITH(predict(none, ideal(1, 1), Placement::shared, side_of), Catch::Contains("no window"));
}

TEST_CASE("the runtime's own work per task is what runs had besides tasks and waiting", "[replay][fast]") {
  Recording recording = two_sides(false);
  for (RunRecord& run : recording.ranks[0].runs) run.overhead_ns = run.graph == 0 ? 30 * 200 : 10 * 200;
  CHECK(task_overhead_s(recording) == Approx(200e-9));
}

TEST_CASE("a typical window has the median of every execution", "[replay][fast]") {
  Recording recording = two_sides(false);
  recording.windows.push_back({6, 405'000});
  RankRecording& rank = recording.ranks[0];
  for (std::size_t r = 0; r < 2; ++r) {
    rank.runs.push_back(rank.runs[r]);
    rank.runs.back().window = 6;
  }
  for (RunRecord& run : rank.runs) run.overhead_ns = 100 * run.window;
  // In each window another task of the sea is held up; one window stands longer between its graphs.
  std::size_t node = 0;
  for (RunRecord& run : rank.runs)
    if (run.graph == 0) {
      do ++node;
      while (run.ns[node].empty());
      run.ns[node][3] += 5'000'000, run.task_ns += 5'000'000, run.wall_ns += 5'000'000;
    }
  for (WindowRecord& window : recording.windows) window.wall_ns += 5'000'000;
  recording.windows[1].wall_ns += 9'000'000;
  recording.windows[0].on_all_ns = 7, recording.windows[1].on_all_ns = 2, recording.windows[2].on_all_ns = 5;
  const Recording typical = spindrift::runtime::typical(recording);
  REQUIRE(typical.windows.size() == 1);
  CHECK(typical.windows[0].on_all_ns == 5);
  CHECK(typical.windows[0].wall_ns == 405'800);                // with 400 ns of the runtime in each of two runs
  CHECK(task_overhead_s(typical) == Approx(2 * 400e-9 / 40));  // of window 4, the least
  CHECK(predict(typical, ideal(1, 1), Placement::shared, side_of).wall_s == Approx(405 * us));
  CHECK(predict(recording, ideal(1, 1), Placement::shared, side_of).wall_s > 5000 * us);
}
