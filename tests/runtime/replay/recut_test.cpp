// A graph of one rank cut for several: what runs where, and what passes between. SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recut.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "runtime/graph/sizes.hpp"
#include "runtime/replay/copies.hpp"
#include "tests/runtime/replay/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

constexpr std::size_t tiles = 16;

/// Tiles in a row with ghosts of both neighbours; `steps` of ghosts and sweep, then one reduction a step. A tile's datum has 800
/// bytes.
RankRun row(std::uint32_t steps) {
  Graph g;
  const auto state = g.data(tiles), ghosts = g.data(tiles), sums = g.data(tiles);
  const Datum total = g.datum();
  static double partials[tiles], result[1];
  for (const Datum d : state) set_bytes(g, d, 800);
  g.repeat("sea/steps", steps, [&] {
    for (std::size_t n = 0; n < tiles; ++n) {
      Uses uses{reads(state[n]), writes(ghosts[n])};
      if (n > 0) uses.push_back(reads(state[n - 1]));
      if (n + 1 < tiles) uses.push_back(reads(state[n + 1]));
      g.task("sea/ghosts/" + std::to_string(n), uses, [] {});
    }
    for (std::size_t n = 0; n < tiles; ++n)
      g.task("sea/sweep/" + std::to_string(n), {reads(ghosts[n]), updates(state[n]), writes(sums[n])}, [] {});
    g.reduce("sea/total", {reads(sums), writes(total)}, {.partials = partials, .result = result});
    g.task("sea/judge", {reads(total)}, [] {});
  });
  return worked_out(std::move(g), [](const std::string& label) {
    return label.starts_with("sea/sweep") ? 40'000 : label.starts_with("sea/ghosts") ? 10'000 : 0;
  });
}

}  // namespace

TEST_CASE("one rank is left as it was", "[replay][fast]") {
  const RankRun whole = row(5);
  const Recut cut = recut(whole.graph, whole.run, 1);
  REQUIRE(cut.ranks.size() == 1);
  CHECK(cut.blocks == tiles);
  CHECK(cut.repeated == 0.0);
  for (const int threads : {1, 2, 4}) {
    const Simulated a = simulate({&whole, 1}, ideal(1, threads)), b = simulate(cut.ranks, ideal(1, threads));
    CHECK(a.wall_s == Approx(b.wall_s));
    CHECK(a.tasks == b.tasks);
    CHECK(b.messages == 0);
  }
}

TEST_CASE("every tile's tasks run on one rank, what is of no tile on all, and borders are messages", "[replay][fast]") {
  constexpr std::uint32_t steps = 5;
  const RankRun whole = row(steps);
  for (const int ranks : {2, 4}) {
    const Recut cut = recut(whole.graph, whole.run, ranks);
    REQUIRE(int(cut.ranks.size()) == ranks);
    CHECK(cut.repeated == 0.0);
    CHECK(cut.quality.imbalance.at(0) == Approx(1.0));
    std::map<std::string, int> on;
    for (const RankRun& rank : cut.ranks)
      for (const NodeRecord& node : rank.graph.nodes) ++on[node.label];
    for (std::size_t n = 0; n < tiles; ++n) {
      CHECK(on["sea/sweep/" + std::to_string(n)] == 1);
      CHECK(on["sea/ghosts/" + std::to_string(n)] == 1);
    }
    CHECK(on["sea/judge"] == ranks);
    CHECK(on["sea/steps"] == ranks);
    const Simulated s = simulate(cut.ranks, ideal(ranks, 1));
    // A row cut into so many pieces: two messages of one tile at each cut in each step.
    CHECK(s.messages == 2 * (ranks - 1) * long(steps));
    CHECK(s.bytes == 800.0 * double(s.messages));
    CHECK(s.reductions == long(steps));
    CHECK(s.busy_s == Approx(sum_s(whole)));
    CHECK(s.wall_s == Approx(sum_s(whole) / ranks));
  }
}

TEST_CASE("of work on all that a rank holds each rank does its share, of other work of no tile the whole", "[replay][fast]") {
  Graph g;
  const auto state = g.data(tiles), sums = g.data(tiles), ghosts = g.data(tiles);
  const Datum order = g.datum(), plan = g.datum();
  set_on_all(g, g.task("sea/sort", {updates(order)}, [] {}));
  set_on_all(g, g.collective("sea/migrate", {updates(order)}, [](MPI_Comm) {}));
  g.task("sea/plan", {updates(plan)}, [] {});
  for (std::size_t n = 0; n < tiles; ++n)
    g.task("sea/sweep/" + std::to_string(n), {reads(order), updates(state[n]), updates(sums[n]), updates(ghosts[n])}, [] {});
  const RankRun whole = worked_out(std::move(g), [](const std::string& label) {
    return label == "sea/sort" ? 80'000 : label == "sea/migrate" ? 40'000 : label == "sea/plan" ? 7'000 : 10'000;
  });
  for (const int ranks : {1, 2, 4}) {
    const Recut cut = recut(whole.graph, whole.run, ranks);
    CHECK(cut.repeated == Approx((ranks - 1) * 7.0 / (80.0 + 7.0 + 160.0)));
    for (const RankRun& rank : cut.ranks) CHECK(sum_s(rank) == Approx((7.0 + (80.0 + 40.0 + 160.0) / ranks) * us));
    // Three copies on so many ranks each: what is shared out is of a copy.
    const RankRun many = copies(whole.graph, whole.run, 3);
    for (const RankRun& rank : recut(many.graph, many.run, 3 * ranks, 0, 3).ranks)
      CHECK(sum_s(rank) == Approx((7.0 + (80.0 + 40.0 + 160.0) / ranks) * us));
  }
}

TEST_CASE("what was skipped stays so on every rank, in every part and copy", "[replay][fast]") {
  RankRun whole = row(5);
  const auto total =
      std::uint32_t(std::ranges::find(whole.graph.nodes, "sea/total", &NodeRecord::label) - whole.graph.nodes.begin());
  whole.run.skipped[total] = {0, 1, 2, 4};
  const Recut cut = recut(whole.graph, whole.run, 4);
  CHECK(simulate(cut.ranks, ideal(4, 1)).reductions == 1);
  const RankRun other = row(3);
  const RankRun both = joined(other, whole), part = part_of(both.graph, both.run, [](std::string_view) { return true; });
  CHECK(simulate(recut(part.graph, part.run, 2).ranks, ideal(2, 1)).reductions == 3 + 1);
  const RankRun three = copies(whole.graph, whole.run, 3, 1.0);
  CHECK(simulate(recut(three.graph, three.run, 3, 0, 3).ranks, ideal(3, 1)).reductions == 1);
}

TEST_CASE("latency is felt where nothing is left to hide it", "[replay][fast]") {
  const RankRun whole = row(5);
  const Recut cut = recut(whole.graph, whole.run, 2);
  Cluster cluster{.nodes = 2, .ranks = 2, .threads = 1, .between = {}, .within = {}};
  const double quick = simulate(cut.ranks, cluster).wall_s;
  cluster.between.latency_s = 5 * us;  // seven of a rank's eight ghost tasks need no message; the last reduction is felt
  CHECK(simulate(cut.ranks, cluster).wall_s >= quick + 4.999 * us);
  CHECK(simulate(cut.ranks, cluster).wall_s <= quick + 5 * 5.001 * us);
  cluster.between.latency_s = 1000 * us;  // a message in each of five steps, and the reduction
  CHECK(simulate(cut.ranks, cluster).wall_s >= 6 * 1000 * us);
}

namespace {

/// Four tiles in a row, and pairs of neighbours, which write both.
RankRun tiles_and_pairs(bool in_parts) {
  Graph g;
  const auto state = g.data(4), force = g.data(4), other = g.data(4);
  for (std::size_t n = 0; n < 4; ++n)
    g.task("sea/move/" + std::to_string(n), {updates(state[n]), updates(force[n]), updates(other[n])}, [] {});
  for (std::size_t n = 0; n + 1 < 4; ++n) {
    const std::uint32_t pairs = g.task("sea/pairs/" + std::to_string(n),
                                       {reads(state[n]), reads(state[n + 1]), updates(force[n]), updates(force[n + 1])}, [] {});
    if (in_parts) set_in_parts(g, pairs);
  }
  return worked_out(std::move(g), [](const std::string& label) { return label.starts_with("sea/pairs") ? 10'000 : 100'000; });
}

}  // namespace

TEST_CASE("work that writes tiles of two ranks is done on both", "[replay][fast]") {
  const RankRun whole = tiles_and_pairs(false);
  const Recut cut = recut(whole.graph, whole.run, 2);
  CHECK(cut.repeated == Approx(10.0 / 430.0));  // the pairs of the two tiles at the cut
  const Simulated s = simulate(cut.ranks, ideal(2, 1));
  CHECK(s.busy_s == Approx(440 * us));
  CHECK(s.messages == 2);
}

TEST_CASE("of work in parts the rank of the first does all, another one its own parts", "[replay][fast]") {
  const RankRun whole = tiles_and_pairs(true);
  const Recut cut = recut(whole.graph, whole.run, 2);
  CHECK(cut.repeated == Approx(5.0 / 430.0));  // one of the two parts of the pairs at the cut
  std::vector<double> s;
  for (const RankRun& rank : cut.ranks) s.push_back(sum_s(rank));
  std::ranges::sort(s);
  CHECK(s[0] == Approx(215 * us));
  CHECK(s[1] == Approx(220 * us));
}

TEST_CASE("sums at places of their own go with the tiles that they are made from", "[replay][fast]") {
  Graph g;
  const auto a = g.data(8), b = g.data(8), c = g.data(8), sums = g.data(3);        // of tiles 6, 7 and 0, 1
  for (std::size_t n = 0; n < 8; ++n) set_bytes(g, a[n], n == 3 ? 1 : 1'000'000);  // the row is cut in its middle
  for (std::size_t n = 0; n < 8; ++n) g.task("sea/t/" + std::to_string(n), {updates(a[n]), updates(b[n]), updates(c[n])}, [] {});
  for (std::size_t n = 0; n + 1 < 8; ++n) g.task("sea/near/" + std::to_string(n), {reads(a[n]), updates(b[n + 1])}, [] {});
  g.task("sea/load/6", {reads(a[6]), reads(a[7]), writes(sums[1])}, [] {});
  g.task("sea/load/0", {reads(a[0]), reads(a[1]), writes(sums[2])}, [] {});
  const RankRun whole = worked_out(std::move(g), [](const std::string&) { return 10'000; });
  const Recut cut = recut(whole.graph, whole.run, 2);
  CHECK(cut.blocks == 8);
  for (const RankRun& rank : cut.ranks) {
    std::set<std::string> on;
    for (const NodeRecord& node : rank.graph.nodes) on.insert(node.label);
    CHECK(on.count("sea/load/6") == on.count("sea/t/6"));
    CHECK(on.count("sea/load/0") == on.count("sea/t/0"));
  }
}

TEST_CASE("graphs of several ranks are not cut again", "[replay][fast]") {
  RankRun run;
  run.graph.nodes.push_back({.label = "a/send", .kind = NodeKind::send, .peer = 1, .tag = 1});
  CHECK_THROWS_WITH(recut(run.graph, run.run, 2), Catch::Contains("a/send"));
}
