// Edges from accesses, and what recording refuses.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/graph/graph.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "runtime/graph/errors.hpp"

using namespace spindrift::runtime;
using Catch::Contains;

namespace {

const auto nothing = [] {};

bool has(const Graph& g, Edge e) { return std::find(g.edges().begin(), g.edges().end(), e) != g.edges().end(); }

}  // namespace

TEST_CASE("a reader waits for the last writer, a writer for the readers since, also of the iteration before", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum(), y = g.datum();
  const auto write = g.task("w", {writes(x)}, nothing);
  const auto first = g.task("r1", {reads(x)}, nothing);
  const auto second = g.task("r2", {reads(x), writes(y)}, nothing);
  const auto update = g.task("u", {updates(x)}, nothing);
  CHECK(has(g, {write, first, 0}));
  CHECK(has(g, {write, second, 0}));
  CHECK(has(g, {first, update, 0}));
  CHECK(has(g, {second, update, 0}));
  CHECK(has(g, {update, write, 1}));
  CHECK(has(g, {second, second, 1}));  // y: its own last writer
  CHECK(g.edges().size() == 6);
}

TEST_CASE("data that are only read order nothing, and reading twice is one edge", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum(), y = g.datum();
  g.task("a", {reads(x)}, nothing);
  g.task("b", {reads(x), reads(x)}, nothing);
  CHECK(g.edges().empty());
  const auto w = g.task("w", {writes(x), writes(y)}, nothing);
  const auto r = g.task("r", {reads(x), reads(y)}, nothing);
  CHECK(std::count(g.edges().begin(), g.edges().end(), Edge{w, r, 0}) == 1);
}

TEST_CASE("a loop touches what its tasks touch, and its tasks are ordered within it only", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum(), y = g.datum();
  const auto before = g.task("before", {writes(x)}, nothing);
  std::uint32_t inside = 0;
  const auto loop = g.repeat("loop", 3, [&] {
    g.repeat("loop/inner", 2, [&] { inside = g.task("loop/inner/t", {reads(x), writes(y)}, nothing); });
  });
  const auto after = g.task("after", {reads(y)}, nothing);
  CHECK(has(g, {before, loop, 0}));
  CHECK(has(g, {loop, after, 0}));
  CHECK(has(g, {loop, before, 1}));
  CHECK_FALSE(has(g, {before, inside, 0}));
  CHECK(g.nodes()[inside].loop == loop + 1);
  CHECK(g.nodes()[inside].module() == "loop");
}

TEST_CASE("a cycle is named", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum();
  const auto a = g.task("out/a", {writes(x)}, nothing);
  const auto b = g.task("out/b", {reads(x)}, nothing);
  const auto c = g.task("out/c", {}, nothing);
  g.order(b, c);
  CHECK_NOTHROW(g.edges());
  g.order(c, a);
  CHECK_THROWS_AS(g.edges(), CycleError);
  CHECK_THROWS_WITH(g.edges(), Contains("out/a -> out/b -> out/c -> out/a") || Contains("out/b -> out/c -> out/a -> out/b") ||
                                   Contains("out/c -> out/a -> out/b -> out/c"));
}

TEST_CASE("recording refuses what could not run", "[runtime][fast]") {
  Graph g;
  const Datum x = g.datum();
  CHECK_THROWS_WITH(g.repeat("empty", 2, [] {}), Contains("empty: the loop has no tasks"));
  Graph h;
  const Datum y = h.datum();
  CHECK_THROWS_WITH(h.loop("open", {1, 9}, [&] { h.task("t", {writes(y)}, nothing); }), Contains("open: between min and max"));
  CHECK_THROWS_WITH(h.loop("none", {0, 9}, [] {}), Contains("none: iterations 0 to 9"));
  Graph k;
  CHECK_THROWS_WITH(k.until("u", {}, [] { return true; }), Contains("u: until belongs inside a loop"));
  CHECK_THROWS_WITH(k.task("t", {reads(Datum{7})}, nothing), Contains("t: uses a datum that is not of this graph"));
  CHECK_THROWS_WITH(k.send("s", {}, {3, 1, {}}), Contains("s: peer 3 of 1 ranks"));
  CHECK_THROWS_WITH(k.send("s", {}, {0, 40000, {}}), Contains("s: tag 40000"));
  const std::vector<double> partials = {1, 2};
  std::array<double, 3> results{};
  CHECK_THROWS_WITH(k.reduce("r", {}, {.partials = partials, .result = results}), Contains("r: 2 partials for 3 components"));
  CHECK_THROWS_WITH(k.reduce("r", {}, {.partials = partials, .result = {}}), Contains("r: 2 partials for 0 components"));
  (void)x;
}
