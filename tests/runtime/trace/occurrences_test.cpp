// Which execution waited for which: replays, iterations, loops as a whole, messages in order; and the small tools beside it.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/occurrences.hpp"

#include <catch2/catch.hpp>

#include "runtime/trace/intervals.hpp"
#include "tests/runtime/trace/synthetic.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

namespace {

/// Begin times [us] of what the execution of `node` that begins at `begin_us` waited for, ends of loops looked through.
std::vector<double> waited_for(const Occurrences& all, std::uint32_t node, double begin_us) {
  std::vector<double> begins;
  const auto look = [&](auto&& self, const Occurrence& o) -> void {
    for (const std::uint32_t b : all.before_of(o)) {
      const Occurrence& before = all.all[b];
      if (before.record == nullptr)
        self(self, before);
      else
        begins.push_back(1e-3 * double(before.begin));
    }
  };
  for (const Occurrence& o : all.all)
    if (o.record != nullptr && o.node == node && o.begin == std::int64_t(begin_us * 1000)) look(look, o);
  std::sort(begins.begin(), begins.end());
  return begins;
}

}  // namespace

TEST_CASE("each execution is joined to the last execution of its predecessor", "[trace][fast]") {
  SyntheticRank rank(0);
  const auto x = rank.node("m/x"), y = rank.node("m/y");
  rank.edge(x, y), rank.edge(y, x, 1);
  for (const unsigned replay : {0u, 1u, 2u})
    rank.ran(x, 10 * replay, 10 * replay + 4, 0, replay), rank.ran(y, 10 * replay + 4, 10 * replay + 9, 0, replay);
  const std::vector traces{rank.trace(30)};
  const Occurrences all = occurrences_of(traces);
  CHECK(waited_for(all, x, 0).empty());
  CHECK(waited_for(all, y, 4) == std::vector<double>{0});
  CHECK(waited_for(all, x, 10) == std::vector<double>{4});
  CHECK(waited_for(all, y, 24) == std::vector<double>{20});
}

TEST_CASE("the first iteration waits for what its loop waits for, and what follows a loop for all of its nodes",
          "[trace][fast]") {
  SyntheticRank rank(0, 2);
  const auto before = rank.node("m/before"), outer = rank.node("m/outer", NodeKind::loop),
             inner = rank.node("m/inner", NodeKind::loop, outer);
  const auto x = rank.node("m/x", NodeKind::task, inner), y = rank.node("m/y", NodeKind::task, inner),
             after = rank.node("m/after");
  rank.edge(before, outer), rank.edge(outer, after);
  rank.ran(before, 0, 1);
  rank.ran(x, 1, 2, 0, 0, 0), rank.ran(y, 1, 3, 1, 0, 0);  // outer 0: inner 0, 1
  rank.ran(x, 3, 4, 0, 0, 1), rank.ran(y, 3, 5, 1, 0, 1);
  rank.ran(x, 5, 6, 0, 0, 0), rank.ran(y, 5, 7, 1, 0, 0);  // outer 1: inner 0
  rank.ran(after, 7, 8);
  const std::vector traces{rank.trace(8)};
  const Occurrences all = occurrences_of(traces);
  CHECK(waited_for(all, x, 1) == std::vector<double>{0});
  CHECK(waited_for(all, y, 1) == std::vector<double>{0});
  CHECK(waited_for(all, x, 3) == std::vector<double>{1});         // its own execution before
  CHECK(waited_for(all, after, 7) == std::vector<double>{5, 5});  // the last x and the last y
}

TEST_CASE("a loop that waits for its run before has one beginning a run, which is the end of that one", "[trace][fast]") {
  SyntheticRank rank(0);
  constexpr unsigned members = 50, replays = 4;
  const auto loop = rank.node("m/loop", NodeKind::loop);
  for (unsigned m = 0; m < members; ++m) rank.node("m/x", NodeKind::task, loop);
  rank.edge(loop, loop, 1);
  for (unsigned replay = 0; replay < replays; ++replay)
    for (unsigned m = 0; m < members; ++m)
      rank.ran(loop + 1 + m, 100 * replay + m, 100 * replay + m + 1, 0, replay),
          rank.ran(loop + 1 + m, 100 * replay + 50 + 0.5 * m, 100 * replay + 50 + 0.5 * m + 0.4, 0, replay, 1);
  const std::vector traces{rank.trace(100 * replays)};
  const Occurrences all = occurrences_of(traces);
  const auto of_run_before = waited_for(all, loop + members, 100 + members - 1);
  CHECK(of_run_before.size() == members);
  CHECK(of_run_before.back() < 100);
  CHECK(all.before.size() < 4 * members * replays);
}

TEST_CASE("a message is under way from the moment both ends are posted", "[trace][fast]") {
  const auto traces = one_message();
  const Occurrences all = occurrences_of(traces);
  int receives = 0;
  for (const Occurrence& o : all.all) {
    if (!o.is_message()) continue;
    const auto partners = all.partners_of(o);
    if (o.record->activity == Activity::send) CHECK(partners.empty());
    if (o.record->activity != Activity::receive) continue;
    ++receives;
    REQUIRE(partners.size() == 1);
    CHECK(all.all[partners[0]].record->activity == Activity::send);
    CHECK(o.ready == 4000);
    CHECK(o.duration() == 3000);
  }
  CHECK(receives == 1);
}

TEST_CASE("messages of an inner loop entered twice meet in order", "[trace][fast]") {
  SyntheticRank left(0), right(1);
  const auto send = left.message("m/send", NodeKind::send, 1, 0), receive = right.message("m/receive", NodeKind::receive, 0, 0);
  for (const int n : {0, 1, 2})
    left.ran(send, 10 * n + 2, 10 * n + 3), right.ran(receive, 10 * n, 10 * n + 5);  // all (replay 0, iteration 0)
  const std::vector traces{left.trace(30), right.trace(30)};
  for (const Occurrence& o : occurrences_of(traces).all)
    if (o.record->activity == Activity::receive) CHECK(o.duration() == 3000);
}

TEST_CASE("a reduction is under way from the moment the last rank has posted it", "[trace][fast]") {
  std::vector<RankTrace> traces;
  for (const int r : {0, 1, 2}) {
    SyntheticRank rank(r);
    rank.ran(rank.node("m/norm", NodeKind::reduce), 2 * r, 10);
    traces.push_back(rank.trace(10));
  }
  const Occurrences all = occurrences_of(traces);
  for (const Occurrence& o : all.all) {
    CHECK(all.partners_of(o).size() == 2);
    CHECK(o.duration() == 6000);
  }
}

TEST_CASE("records after the first loss are left out on all ranks", "[trace][fast]") {
  auto traces = one_message();
  traces[0].complete_until = 7000;
  CHECK(complete_until(traces) == 7000);
  CHECK(occurrences_of(traces).all.size() == 3);  // a, send, receive; b ended later
}

TEST_CASE("families are labels without block numbers", "[trace][fast]") {
  CHECK(family_of("aero/residual/12") == "aero/residual");
  CHECK(family_of("sea/force/3-7") == "sea/force");
  CHECK(family_of("aero/12/flux") == "aero/flux");
  CHECK(family_of("sea/rk4") == "sea/rk4");
  CHECK(module_of("aero/residual/12") == "aero");
  CHECK(module_of("coupling") == "coupling");
}

TEST_CASE("overlap with a union of intervals", "[trace][fast]") {
  const auto set = united({{5, 7}, {0, 2}, {1, 3}, {9, 9}, {7, 8}});
  REQUIRE(set.size() == 2);
  CHECK(overlap({0, 10}, set) == 6);
  CHECK(overlap({2, 6}, set) == 2);
  CHECK(overlap({3, 5}, set) == 0);
}
