// Tiles are weighed by the time of their own tasks, move only where that pays, and arrive with all that their solver had of them.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/tile_balance.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <optional>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/flow/tasks.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// Eight tiles alike, on ranks as given or by halves.
Case eight_tiles(int ranks = 1, int rank = 0) {
  const BoxOptions box{.ni = 16, .nj = 8, .nk = 8};
  return Case(cartesian_box(box), air(0.1), {}, {.across_j = 4, .across_k = 4, .normal = 8}, ranks, rank);
}

}  // namespace

TEST_CASE("every task of a tile counts for it, and what all tiles share for none", "[aero][fast]") {
  Case c = eight_tiles();
  c.prepare();
  c.run();
  const runtime::Executor* executors[]{c.executor.get(), c.executor.get()};
  const std::vector<double> once = seconds_of_tiles(*c.store, std::span(executors, 1)),
                            twice = seconds_of_tiles(*c.store, std::span(executors, 2));
  REQUIRE(once.size() == 8);
  double shared = 0.0, all = 0.0;
  const std::span<const runtime::Node> nodes = c.executor->graph().nodes();
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].kind != runtime::NodeKind::task) continue;
    const double s = 1e-9 * double(c.executor->cost(n).total_ns);
    const int tile = tile_of(nodes[n]);
    all += s;
    if (tile < 0) shared += s;
    CHECK((tile >= 0) == (nodes[n].label.find_first_of("01234567") != std::string::npos));
  }
  for (std::size_t t = 0; t < 8; ++t) {
    CHECK(once[t] > 0.0);
    CHECK(twice[t] == Approx(2.0 * once[t]));
  }
  CHECK(std::accumulate(once.begin(), once.end(), shared) == Approx(all));
  runtime::Node message{.label = "aero/ghosts/receive/1", .kind = runtime::NodeKind::receive};
  CHECK(tile_of(message) == -1);
  runtime::Node packing{.label = "aero/ghosts/pack/1"}, sea{.label = "sea/forces/1"};
  CHECK(tile_of(packing) == -1);
  CHECK(tile_of(sea) == -1);
}

TEST_CASE("tiles move where one rank has more than a fifth above the mean and the rest of the run pays for it", "[aero][mpi2]") {
  const int rank = runtime::rank_in(MPI_COMM_WORLD);
  const Case c = eight_tiles(2, rank);
  REQUIRE(c.store->owned().size() == 4);
  const auto better = [&](double first, double second, const MoveTerms& terms) {
    return better_ranks(*c.store, std::vector<double>(4, rank == 0 ? first : second), terms, MPI_COMM_WORLD);
  };
  const MoveTerms cheap{.move_s = 0.0, .ahead = 1.0, .threads = 1};
  CHECK_FALSE(better(1.0, 1.0, cheap));
  CHECK_FALSE(better(1.0, 1.4, cheap));  // 1.17 of the mean
  CHECK_FALSE(better(0.0, 0.0, cheap));  // nothing measured
  const std::optional<TileMove> move = better(1.0, 3.0, cheap);
  REQUIRE(move);
  CHECK(move->before == Approx(1.5));
  CHECK(move->after == Approx(1.0));  // two tiles of either kind each: no other way comes within the partition's tolerance
  REQUIRE(move->rank_of_tile.size() == 8);
  double first = 0.0;
  for (std::size_t t = 0; t < 8; ++t) first += move->rank_of_tile[t] == 0 ? (t < 4 ? 1.0 : 3.0) : 0.0;
  CHECK(first == Approx(8.0));
  const double gain = (1.5 - 1.0) * 8.0;  // of what was measured [s]
  CHECK(better(1.0, 3.0, {.move_s = 0.99 * gain, .ahead = 1.0, .threads = 1}));
  CHECK_FALSE(better(1.0, 3.0, {.move_s = 1.01 * gain, .ahead = 1.0, .threads = 1}));
  CHECK(better(1.0, 3.0, {.move_s = 1.01 * gain, .ahead = 1.1, .threads = 1}));
  CHECK_FALSE(better(1.0, 3.0, {.move_s = 0.99 * gain, .ahead = 1.0, .threads = 2}));
  // What one rank knows of the cost, all do.
  CHECK_FALSE(better(1.0, 3.0, {.move_s = rank == 0 ? 1.01 * gain : 0.0, .ahead = 1.0, .threads = 1}));
}

TEST_CASE("a snapshot's tiles arrive at their new ranks in order, with the notes of the set-up", "[aero][mpi2]") {
  const int rank = runtime::rank_in(MPI_COMM_WORLD);
  const bool notes = GENERATE(false, true);
  const std::vector<int> owned = rank == 0 ? std::vector{0, 1, 4} : std::vector{2, 3}, rank_of_tile{1, 0, 1, 0, 0};
  FlowSnapshot mine{.tiles = {}, .march = {7.0, 8.0}, .set_up = {}};
  for (const int t : owned) {
    mine.tiles.emplace_back(std::size_t(t + 1), double(t));
    if (notes) mine.set_up.tiles.push_back({10.0 * t});
  }
  mine.set_up.number = notes ? 3 : 0;
  const FlowSnapshot got = send_tiles(mine, owned, rank_of_tile, MPI_COMM_WORLD);
  const std::vector<int> expected = rank == 0 ? std::vector{1, 3, 4} : std::vector{0, 2};
  REQUIRE(got.tiles.size() == expected.size());
  CHECK(got.set_up.tiles.size() == (notes ? expected.size() : 0));
  CHECK(got.set_up.number == 0);  // of another solver
  CHECK(got.march == mine.march);
  for (std::size_t n = 0; n < expected.size(); ++n) {
    CHECK(got.tiles[n] == std::vector<double>(std::size_t(expected[n] + 1), double(expected[n])));
    if (notes) CHECK(got.set_up.tiles[n] == std::vector{10.0 * expected[n]});
  }
}
