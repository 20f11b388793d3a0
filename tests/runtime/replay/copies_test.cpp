// A recording several times side by side: against scenes that are really so many times as wide, against answers worked out by
// hand, and a part of the copies against all of them. SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/copies.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "runtime/graph/sizes.hpp"
#include "runtime/replay/predict.hpp"
#include "runtime/replay/recut.hpp"
#include "tests/runtime/replay/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

constexpr std::uint32_t steps = 5;
constexpr double chain_us = 30.0;  // of a step's serial task

std::string label(const char* family, std::size_t n) { return std::string("sea/") + family + "/" + std::to_string(n); }

Side all_first(std::string_view) { return Side::first; }

/// Tiles of 50 us a step in a row whose ends meet or do not, each with ghosts of its neighbours, 800 bytes of each; then a
/// reduction and a serial task, for which the next step waits.
RankRun row(std::size_t tiles, bool ring) {
  Graph g;
  const auto state = g.data(tiles), ghosts = g.data(tiles), sums = g.data(tiles);
  const Datum total = g.datum(), plan = g.datum();
  static double partials[1024], result[1];
  for (const Datum d : state) set_bytes(g, d, 800);
  g.repeat("sea/steps", steps, [&] {
    for (std::size_t n = 0; n < tiles; ++n) {
      Uses uses{reads(plan), reads(state[n]), writes(ghosts[n])};
      if (ring || n > 0) uses.push_back(reads(state[(n + tiles - 1) % tiles]));
      if (ring || n + 1 < tiles) uses.push_back(reads(state[(n + 1) % tiles]));
      g.task(label("ghosts", n), uses, [] {});
    }
    for (std::size_t n = 0; n < tiles; ++n)
      g.task(label("sweep", n), {reads(ghosts[n]), updates(state[n]), writes(sums[n])}, [] {});
    g.reduce("sea/total", {reads(sums), writes(total)}, {.partials = std::span(partials).first(tiles), .result = result});
    g.task("sea/judge", {reads(total), updates(plan)}, [] {});
  });
  return worked_out(std::move(g), [](const std::string& name) {
    return name.starts_with("sea/sweep")    ? 40'000
           : name.starts_with("sea/ghosts") ? 10'000
           : name == "sea/judge"            ? int(1000 * chain_us)
                                            : 0;
  });
}

/// Tiles of unlike cost, pairs of neighbours that are computed on both sides of a border.
RankRun pairs(std::size_t tiles) {
  Graph g;
  const auto state = g.data(tiles), force = g.data(tiles), other = g.data(tiles);
  for (const Datum d : state) set_bytes(g, d, 5000);
  g.repeat("sea/steps", steps, [&] {
    for (std::size_t n = 0; n + 1 < tiles; ++n)
      g.task(label("pairs", n), {reads(state[n]), reads(state[n + 1]), updates(force[n]), updates(force[n + 1])}, [] {});
    for (std::size_t n = 0; n < tiles; ++n)
      g.task(label("move", n), {updates(state[n]), updates(force[n]), updates(other[n])}, [] {});
  });
  return worked_out(std::move(g), [](const std::string& name) {
    return name.starts_with("sea/pairs") ? 20'000 + 1'000 * (name.back() - '0') : 30'000;
  });
}

Recording recording_of(const RankRun& run) {
  Recording recording{.scene = "s", .program = "p", .windows = {{1, run.run.wall_ns}}};
  RankRecording& rank = recording.ranks.emplace_back();
  rank.graphs.push_back(run.graph), rank.runs.push_back(run.run);
  rank.runs[0].window = 1;
  return recording;
}

/// So many nodes of one rank, each with a copy.
Cluster nodes(int count, int threads = 1, double latency_us = 0.0, double skew = 0.0) {
  Cluster cluster{.nodes = count, .ranks = count, .threads = threads, .between = {latency_us * us, 1e9}, .within = {}};
  cluster.skew = skew, cluster.copies = count;
  return cluster;
}

double wall(const Recording& recording, const Cluster& cluster, int units, Placement placement = Placement::shared) {
  return predict(recording, cluster, placement, all_first, units).wall_s;
}

}  // namespace

TEST_CASE("copies of a row are the row that is so many times as long", "[replay][fast]") {
  constexpr std::size_t tiles = 8;
  const RankRun one = row(tiles, false);
  for (const int count : {2, 4, 8}) {
    INFO(count << " nodes");
    const RankRun whole = row(tiles * std::size_t(count), true);
    const RankRun many = copies(one.graph, one.run, count);
    CHECK(sum_s(many) == Approx(count * steps * tiles * 50 * us + steps * chain_us * us));
    for (const double latency_us : {0.0, 2.0, 50.0}) {
      const Cluster cluster = nodes(count, 1, latency_us);
      const Simulated real = simulate(recut(whole.graph, whole.run, count).ranks, cluster);
      const Simulated made = simulate(recut(many.graph, many.run, count, 0, count).ranks, cluster);
      CHECK(made.wall_s == Approx(real.wall_s).epsilon(0.02));
      CHECK(made.bytes == real.bytes);
      CHECK(made.messages == real.messages);
      CHECK(made.reductions == real.reductions);
      CHECK(made.tasks == real.tasks);
    }
  }
}

TEST_CASE("weak scaling without messages loses nothing", "[replay][fast]") {
  Graph g;
  const auto a = g.data(6), b = g.data(6), c = g.data(6);
  g.repeat("sea/steps", steps, [&] {
    for (std::size_t n = 0; n < 6; ++n) g.task(label("t", n), {updates(a[n]), updates(b[n]), updates(c[n])}, [] {});
  });
  const Recording recording = recording_of(worked_out(std::move(g), [](const std::string&) { return 10'000; }));
  for (const Placement placement : {Placement::shared, Placement::bulk_synchronous}) {
    Cluster one = nodes(1, 2);
    const double alone = wall(recording, one, simulated_units, placement);
    for (const int count : {2, 16, 1024}) {
      const Prediction p = predict(recording, nodes(count, 2), placement, all_first);
      CHECK(p.wall_s == Approx(alone));
      CHECK(p.tasks.messages == 0);
      CHECK(p.work_s == Approx(count * 300 * us));
      CHECK(p.tasks.busy_s == Approx(count * 300 * us));
      CHECK(p.simulated_copies == std::min(count, simulated_units));
    }
  }
}

TEST_CASE("what all nodes wait for takes a step more with every doubling, beside a serial chain that stays", "[replay][fast]") {
  const Recording recording = recording_of(row(8, false));
  for (const auto& [count, doublings] : {std::pair{1, 0}, std::pair{2, 1}, std::pair{16, 4}, std::pair{1024, 10}}) {
    const Cluster cluster = nodes(count, 1, 3.0);
    const Prediction p = predict(recording, cluster, Placement::shared, all_first);
    // A step: eight tiles, the reduction, the serial task; messages come while the tiles inside are done.
    CHECK(p.wall_s == Approx(steps * (8 * 50 + doublings * 3 + chain_us) * us).epsilon(0.02));
    CHECK(p.tasks.reductions == (count > 1 ? steps : 0));
    const auto& chain = p.tasks.critical_path;
    const auto judge = std::ranges::find(chain, "sea/judge", &Link::label);
    REQUIRE(judge != chain.end());
    CHECK(judge->executions == steps);
    CHECK(judge->s == Approx(steps * chain_us * us));
  }
}

TEST_CASE("four of the copies foretell all of them within a tenth", "[replay][fast]") {
  for (const RankRun& run : {row(8, false), pairs(8)})
    for (const double skew : {0.0, 0.05})
      for (const double latency_us : {1.0, 60.0})
        for (const int count : {2, 4, 8, 32}) {
          INFO(count << " nodes, skew " << skew << ", latency " << latency_us);
          const Recording recording = recording_of(run);
          const Cluster cluster = nodes(count, 2, latency_us, skew);
          const double all = wall(recording, cluster, count);
          CHECK(wall(recording, cluster, simulated_units) == Approx(all).epsilon(0.1));
          CHECK(wall(recording, cluster, 2) == Approx(all).epsilon(0.1));
          CHECK(all >= wall(recording, nodes(1, 2), 1));
        }
}

TEST_CASE("the slowest of all nodes is among those that are simulated", "[replay][fast]") {
  const Recording recording = recording_of(row(8, false));
  Cluster cluster = nodes(1024, 1, 0.0, 0.03);
  double slowest = 0.0;
  for (int r = 0; r < 1024; ++r) slowest = std::max(slowest, speed_factor(cluster, r));
  REQUIRE(slowest > 1.08);
  CHECK(wall(recording, cluster, simulated_units) == Approx(slowest * steps * (8 * 50 + chain_us) * us).epsilon(0.005));
}

TEST_CASE("pairs across a border are one more on each side of it, what is of blocks everywhere is not", "[replay][fast]") {
  constexpr std::size_t tiles = 8;
  Graph g;
  const auto state = g.data(tiles), force = g.data(tiles), other = g.data(tiles), parts = g.data(4);
  const Datum order = g.datum();
  for (const Datum d : state) set_bytes(g, d, 5000);
  for (std::size_t n = 0; n < tiles; ++n)
    g.task(label("move", n), {updates(state[n]), updates(force[n]), updates(other[n])}, [] {});
  g.task("sea/sort", {updates(order), updates(parts)}, [] {});
  for (std::size_t n = 0; n + 1 < tiles; ++n)
    g.task(label("pairs", n), {reads(state[n]), reads(state[n + 1]), updates(force[n]), updates(force[n + 1])}, [] {});
  const RankRun one =
      worked_out(std::move(g), [](const std::string& name) { return name.starts_with("sea/move") ? 100'000 : 1'000; });
  const auto found = [](const RankRun& run) {
    std::map<std::string, std::pair<long, std::int64_t>> all;
    for (std::size_t n = 0; n < run.graph.nodes.size(); ++n) {
      auto& [count, ns] = all[run.graph.nodes[n].label];
      ++count, ns += run.run.ns[n][0];
    }
    return all;
  };
  auto three = found(copies(one.graph, one.run, 3));
  CHECK(three["sea/move/0"] == std::pair(3L, std::int64_t(300'000)));
  CHECK(three["sea/sort"] == std::pair(3L, std::int64_t(3'000)));
  long count = 0;
  for (std::size_t n = 0; n + 1 < tiles; ++n) count += three[label("pairs", n)].first;
  CHECK(count == 3 * (long(tiles) - 1) + 3);
  const RankRun many = copies(one.graph, one.run, 3);
  const Recut cut = recut(many.graph, many.run, 3, 0, 3);
  for (const RankRun& rank : cut.ranks) CHECK(sum_s(rank) == Approx((100 * tiles + 1 + tiles - 1 + 2) * us));
}

TEST_CASE("of work in parts that crosses a border only those parts are done once more", "[replay][fast]") {
  constexpr std::size_t tiles = 8;
  Graph g;
  const auto state = g.data(tiles), force = g.data(tiles), other = g.data(tiles);
  for (std::size_t n = 0; n < tiles; ++n)
    g.task(label("move", n), {updates(state[n]), updates(force[n]), updates(other[n])}, [] {});
  for (std::size_t n = 0; n + 2 < tiles; ++n)  // three parts, of which one or two cross
    set_in_parts(g, g.task(label("pairs", n), {updates(force[n]), updates(force[n + 1]), updates(force[n + 2])}, [] {}));
  const RankRun one =
      worked_out(std::move(g), [](const std::string& name) { return name.starts_with("sea/move") ? 100'000 : 3'000; });
  const RankRun three = copies(one.graph, one.run, 3);
  double pairs_ns = 0.0;
  for (std::size_t n = 0; n < three.graph.nodes.size(); ++n)
    if (three.graph.nodes[n].label.starts_with("sea/pairs"))
      pairs_ns += std::accumulate(three.run.ns[n].begin(), three.run.ns[n].end(), 0.0);
  CHECK(pairs_ns == Approx(3 * (double(tiles) - 2) * 3'000 + 3 * 2 * 1'000));
}

TEST_CASE("copies are cut into equal units of whole nodes", "[replay][fast]") {
  const auto units = [](int copies, int nodes, int ranks) {
    Cluster cluster{.nodes = nodes, .ranks = ranks};
    cluster.copies = copies;
    const Units u = units_of(cluster);
    return std::array{u.count, u.copies, u.ranks};
  };
  CHECK(units(1, 4, 8) == std::array{1, 1, 8});
  CHECK(units(32, 1, 8) == std::array{1, 32, 8});
  CHECK(units(32, 4, 32) == std::array{4, 8, 8});
  CHECK(units(32, 64, 512) == std::array{32, 1, 16});
  CHECK(units(1024, 1024, 8192) == std::array{1024, 1, 8});
  // Two copies on a node of two ranks, and on four: the time is the work of a rank.
  const Recording recording = recording_of(row(8, false));
  for (const auto& [copies, ranks] : {std::pair{2, 2}, std::pair{2, 4}, std::pair{8, 2}}) {
    Cluster cluster = ideal(ranks, 1);
    cluster.copies = copies;
    const double serial = std::max(1.0, double(copies) / ranks) * chain_us;
    CHECK(wall(recording, cluster, 1) == Approx(steps * (8.0 * copies / ranks * 50 + serial) * us).epsilon(0.02));
  }
}

TEST_CASE("what lies between the graphs is as recorded for each copy of a rank, work on all that a rank holds is shared out",
          "[replay][fast]") {
  Recording recording = recording_of(row(8, false));
  recording.windows[0].wall_ns += 100'000;
  const auto outside = [&](int copies, int ranks) {
    Cluster cluster = ideal(ranks, 1);
    cluster.copies = copies;
    return predict(recording, cluster, Placement::shared, all_first).outside_s;
  };
  CHECK(outside(1, 1) == Approx(100 * us));
  CHECK(outside(1, 4) == Approx(100 * us));
  CHECK(outside(4, 4) == Approx(100 * us));
  CHECK(outside(8, 4) == Approx(200 * us));
  recording.windows[0].on_all_ns = 60'000;
  CHECK(outside(1, 1) == Approx(100 * us));
  CHECK(outside(1, 4) == Approx((40 + 15) * us));
  CHECK(outside(4, 4) == Approx(100 * us));
  CHECK(outside(8, 4) == Approx(200 * us));
}

TEST_CASE("recordings of several ranks are not copied", "[replay][fast]") {
  RankRun run;
  run.graph.nodes.push_back({.label = "a/send", .kind = NodeKind::send, .peer = 1, .tag = 1});
  CHECK_THROWS_WITH(copies(run.graph, run.run, 2), Catch::Contains("a/send"));
  Recording two = recording_of(row(8, false));
  two.ranks.push_back(two.ranks[0]);
  CHECK_THROWS_WITH(wall(two, nodes(2), 2), Catch::Contains("recorded on 2 ranks"));
}
