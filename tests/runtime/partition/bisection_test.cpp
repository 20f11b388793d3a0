// The parts of the partition by themselves: arcs that balance two costs before any refinement, and refinement of a bad start.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/bisection.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "runtime/partition/partition.hpp"
#include "runtime/partition/refine.hpp"
#include "tests/runtime/partition/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

TEST_CASE("arcs of a closed walk halve two costs at once, to about one block", "[partition][fast]") {
  const int ranks = GENERATE(2, 3, 5, 8);
  const BlockGraph graph = air_over_sea(8, 24);  // all air before all sea on the walk: no single cut can balance both
  const auto quality = partition_quality(graph, partition_by_bisection(work_graph(graph, ranks)), ranks);
  // Costs per rank: 512 air blocks of mean 2, at most 3; 576 columns of mean 1, at most 1.5. A division misses by one block at an
  // end, and a rank goes through ceil(log2(ranks)) of them.
  const double divisions = std::ceil(std::log2(ranks));
  CHECK(quality.imbalance[0] <= 1.0 + divisions * 3.0 / (512 * 2.0 / ranks) + 0.01 * divisions);
  CHECK(quality.imbalance[1] <= 1.0 + divisions * 1.5 / (576 * 1.0 / ranks) + 0.01 * divisions);
}

TEST_CASE("a row of equal blocks is cut into runs", "[partition][fast]") {
  const BlockGraph graph = row(std::vector<double>(30, 1.0));
  const auto rank = partition_by_bisection(work_graph(graph, 5));
  const auto quality = partition_quality(graph, rank, 5);
  CHECK(quality.imbalance[0] == 1.0);
  CHECK(quality.cut == 4.0);
}

TEST_CASE("the walk begins at an end, wherever block 0 is", "[partition][fast]") {
  BlockGraph graph;  // the row 28 26 ... 2 0 1 3 ... 29
  graph.cost.assign(30, 1.0);
  graph.edges.push_back({0, 1, 1.0});
  for (int b = 2; b < 30; ++b) graph.edges.push_back({b - 2, b, 1.0});
  CHECK(partition_quality(graph, partition_by_bisection(work_graph(graph, 2)), 2).cut == 1.0);
}

TEST_CASE("refinement balances blocks that all start on one rank", "[partition][fast]") {
  const BlockGraph graph = air_over_sea(4, 12);
  std::vector<int> rank(graph.blocks(), 0);
  refine(work_graph(graph, 4), 0.05, rank);
  const auto quality = partition_quality(graph, rank, 4);
  CHECK(quality.imbalance[0] <= 1.05);
  CHECK(quality.imbalance[1] <= 1.05);
}

TEST_CASE("refinement swaps where no single move balances", "[partition][fast]") {
  // 9 against 11: moving the 2 gives 11 against 9; only exchanging a 3 for the 4 reaches 10 each.
  const BlockGraph graph = row({3, 3, 3, 5, 4, 2});
  std::vector<int> rank{0, 0, 0, 1, 1, 1};
  refine(work_graph(graph, 2), 0.0, rank);
  CHECK(partition_quality(graph, rank, 2).imbalance[0] == Approx(1.0));
}

TEST_CASE("refinement lessens the cut and keeps the balance", "[partition][fast]") {
  const BlockGraph graph = row(std::vector<double>(40, 1.0));
  std::vector<int> rank(40);
  for (int b = 0; b < 40; ++b) rank[b] = b < 16 ? 0 : b > 23 ? 1 : b % 2;  // mixed in the middle
  const auto before = partition_quality(graph, rank, 2);
  refine(work_graph(graph, 2), 0.1, rank);
  const auto after = partition_quality(graph, rank, 2);
  CHECK(after.cut < before.cut);
  CHECK(after.imbalance[0] <= 1.1 + 1e-12);
}
