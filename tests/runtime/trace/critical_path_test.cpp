// The longest chain against chains added up by hand.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/critical_path.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime/trace/synthetic.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {
CriticalPath path_of(const std::vector<RankTrace>& traces) { return critical_path(traces, occurrences_of(traces)); }
}  // namespace

TEST_CASE("the critical path is the longest chain of data, whatever the threads were busy with", "[trace][fast]") {
  SyntheticRank rank(0);  // one thread runs a 0-3, b 3-5, c 5-9 and d 9-10: data say a -> c -> d and b -> d
  const auto a = rank.node("m/a/0"), b = rank.node("m/b/0"), c = rank.node("m/c/0"), d = rank.node("m/a/1");
  rank.edge(a, c), rank.edge(c, d), rank.edge(b, d);
  rank.ran(a, 0, 3), rank.ran(b, 3, 5), rank.ran(c, 5, 9), rank.ran(d, 9, 10);
  const CriticalPath path = path_of({rank.trace(10)});
  CHECK(path.seconds == Approx(8e-6));
  REQUIRE(path.by_label.size() == 2);
  CHECK(path.by_label[0].label == "m/a");  // 3 + 1 and 4: equal, by name
  CHECK(path.by_label[0].seconds == Approx(4e-6));
  CHECK(path.by_label[1].label == "m/c");
  CHECK(path.by_label[1].seconds == Approx(4e-6));
}

TEST_CASE("the critical path goes through a message and counts it from when both ends were posted", "[trace][fast]") {
  const CriticalPath path = path_of(one_message());
  CHECK(path.seconds == Approx(12e-6));  // a 4, under way 3, b 5
  REQUIRE(path.by_label.size() == 3);
  CHECK(path.by_label[0].label == "sea/b");
  CHECK(path.by_label[2].label == "aero/receive");
  CHECK(path.by_label[2].seconds == Approx(3e-6));
}

TEST_CASE("the critical path goes through the longer branch of a loop in each iteration", "[trace][fast]") {
  SyntheticRank rank(0, 2);
  const auto before = rank.node("m/before"), loop = rank.node("m/loop", NodeKind::loop);
  const auto x = rank.node("m/x", NodeKind::task, loop), y = rank.node("m/y", NodeKind::task, loop), after = rank.node("m/after");
  rank.edge(before, loop), rank.edge(loop, after), rank.edge(x, y), rank.edge(y, x, 1);
  rank.ran(before, 0, 2);
  for (const unsigned n : {0u, 1u, 2u}) rank.ran(x, 2 + 5 * n, 3 + 5 * n, 0, 0, n), rank.ran(y, 4 + 5 * n, 7 + 5 * n, 1, 0, n);
  rank.ran(after, 20, 21);
  const CriticalPath path = path_of({rank.trace(21)});
  CHECK(path.seconds == Approx((2 + 3 * (1 + 3) + 1) * 1e-6));
  CHECK(path.by_label[0].label == "m/y");
  CHECK(path.by_label[0].seconds == Approx(9e-6));
}

TEST_CASE("a late poll on one rank does not lengthen the chain of another", "[trace][fast]") {
  auto traces = one_message();
  traces[0].records[1].end_ns = 12000;  // the send is seen complete only at the end
  CHECK(path_of(traces).seconds == Approx(12e-6));
}

TEST_CASE("paths within modules leave out other modules and other replays", "[trace][fast]") {
  SyntheticRank rank(0);
  const auto a = rank.node("aero/a"), s = rank.node("sea/s"), b = rank.node("aero/b");
  rank.edge(a, b), rank.edge(s, b), rank.edge(b, a, 1);
  for (const unsigned n : {0u, 1u})
    rank.ran(a, 10 * n, 10 * n + 1, 0, n), rank.ran(s, 10 * n + 1, 10 * n + 6, 0, n), rank.ran(b, 10 * n + 6, 10 * n + 8, 0, n);
  const std::vector traces{rank.trace(20)};
  const Occurrences all = occurrences_of(traces);
  const auto paths = paths_within_modules(traces, all);
  std::vector<std::int64_t> of_b;
  for (std::size_t n = 0; n < all.all.size(); ++n)
    if (all.all[n].node == b) of_b.push_back(paths[n]);
  CHECK(of_b == std::vector<std::int64_t>{3000, 3000});
}

TEST_CASE("nothing recorded has no path", "[trace][fast]") {
  CHECK(path_of({}).seconds == 0.0);
  CHECK(path_of({SyntheticRank(0).trace(1)}).by_label.empty());
}
