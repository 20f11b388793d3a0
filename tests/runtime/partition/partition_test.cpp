// What partition_blocks promises: both fluids balanced, the same result every time, and sense at the edges of its domain.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/partition.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "runtime/partition/metis_partition.hpp"
#include "tests/runtime/partition/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;

TEST_CASE("every rank holds its share of the air and of the sea at once", "[partition][fast]") {
  const auto partitioner =
      GENERATE(Partitioner::best, Partitioner::metis_k_way, Partitioner::metis_recursive, Partitioner::bisection);
  const int ranks = GENERATE(2, 3, 4, 7, 16);
  CAPTURE(int(partitioner), ranks);
  const auto partition = partition_blocks(air_over_sea(8, 24), {ranks, 0.05, partitioner});
  CAPTURE(describe(partition));
  CHECK(partition.within_tolerance);
  CHECK(partition.quality.imbalance[0] <= 1.05);
  CHECK(partition.quality.imbalance[1] <= 1.05);
  CHECK(partition.quality.empty_ranks == 0);
  CHECK(partition.quality.cut < 0.5 * partition.quality.edges);
}

TEST_CASE("one summed cost balances the sum and neither fluid, which is why there are two constraints", "[partition][fast]") {
  const BlockGraph both = air_over_sea(8, 24);
  BlockGraph sum = both;
  sum.constraints = 1;
  sum.cost.clear();
  for (int b = 0; b < both.blocks(); ++b) sum.cost.push_back(both.cost[2 * b] + both.cost[2 * b + 1]);
  const auto partition = partition_blocks(sum, {.ranks = 4});
  CHECK(partition.within_tolerance);
  const auto of_each = partition_quality(both, partition.rank_of_block, 4);
  CHECK(std::max(of_each.imbalance[0], of_each.imbalance[1]) > 1.5);
}

TEST_CASE("`best` is no worse than any one partitioner", "[partition][fast]") {
  const BlockGraph graph = air_over_sea(6, 16);
  const auto best = partition_blocks(graph, {.ranks = 8});
  CAPTURE(describe(best));
  for (const auto one : {Partitioner::metis_k_way, Partitioner::metis_recursive, Partitioner::bisection}) {
    const auto other = partition_blocks(graph, {8, 0.05, one});
    if (other.within_tolerance) CHECK(best.quality.cut <= other.quality.cut);
  }
}

TEST_CASE("the same graph gives the same partition, whatever ran before", "[partition][fast]") {
  const auto partitioner = GENERATE(Partitioner::best, Partitioner::metis_k_way, Partitioner::bisection);
  const BlockGraph graph = air_over_sea(6, 16);
  const auto once = partition_blocks(graph, {8, 0.05, partitioner});
  std::srand(4711);
  partition_blocks(air_over_sea(3, 5), {.ranks = 3});
  CHECK(partition_blocks(graph, {8, 0.05, partitioner}).rank_of_block == once.rank_of_block);
}

TEST_CASE("the order in which edges are listed does not matter", "[partition][fast]") {
  BlockGraph graph = air_over_sea(4, 8);
  const auto once = partition_blocks(graph, {.ranks = 4});
  std::reverse(graph.edges.begin(), graph.edges.end());
  for (auto& edge : graph.edges) std::swap(edge.a, edge.b);
  CHECK(partition_blocks(graph, {.ranks = 4}).rank_of_block == once.rank_of_block);
}

TEST_CASE("quality of a partition made by hand", "[partition][fast]") {
  // Costs (2,0) (1,1) (1,3) in a row, the last alone: totals 4 and 4, means 2 and 2.
  const BlockGraph graph = row({2, 0, 1, 1, 1, 3}, 2);
  const auto quality = partition_quality(graph, {0, 0, 1}, 2);
  CHECK(quality.imbalance == std::vector{1.5, 1.5});
  CHECK(quality.unavoidable == std::vector{1.0, 1.5});
  CHECK(quality.cut == 1.0);
  CHECK(quality.edges == 2.0);
  CHECK(quality.empty_ranks == 0);
}

TEST_CASE("edges listed twice, in either direction, add up; a block is no neighbour of itself", "[partition][fast]") {
  BlockGraph graph = row({1, 1});
  graph.edges.push_back({1, 0, 2.0});
  graph.edges.push_back({0, 1, 4.0});
  graph.edges.push_back({1, 1, 8.0});
  CHECK(partition_quality(graph, {0, 1}, 2).cut == 7.0);
  CHECK(partition_quality(graph, {0, 0}, 2).edges == 7.0);
}

TEST_CASE("a graph METIS is not defined for goes to bisection", "[partition][fast]") {
  BlockGraph graph = row(std::vector<double>(12, 1.0));
  graph.edges.clear();
  const auto partition = partition_blocks(graph, {4, 0.05, Partitioner::metis_k_way});
  CHECK(partition.used == Partitioner::bisection);
  CHECK(partition.quality.imbalance[0] == Approx(1.0));
}

TEST_CASE("more ranks than blocks: one block each, the rest empty", "[partition][fast]") {
  const int ranks = GENERATE(3, 4, 5, 17);
  const auto partition = partition_blocks(row({1.0, 2.0, 3.0}), {.ranks = ranks});
  CHECK(partition.quality.empty_ranks == ranks - 3);
  CHECK(partition.quality.imbalance[0] == Approx(partition.quality.unavoidable[0]));
  CHECK(*std::max_element(partition.rank_of_block.begin(), partition.rank_of_block.end()) < ranks);
}

TEST_CASE("one heavy block leaves no rank empty and is named as unavoidable", "[partition][fast]") {
  const auto partitioner = GENERATE(Partitioner::best, Partitioner::bisection);
  const auto partition = partition_blocks(row({1, 1, 1, 97, 1, 1, 1, 1, 1}), {4, 0.05, partitioner});
  CHECK(partition.quality.empty_ranks == 0);
  CHECK_FALSE(partition.within_tolerance);
  CHECK(partition.quality.imbalance[0] == Approx(97.0 / 26.25));
  CHECK_THAT(describe(partition), Catch::Contains("largest block alone 3.695") && Catch::Contains("outside the tolerance"));
}

TEST_CASE("a block heavier than two ranks' shares is no task for METIS, which prints on stdout that it cannot",
          "[partition][fast]") {
  std::vector<double> cost(40, 1.0);
  cost[20] = 100.0;  // of 8 ranks' 139 / 8
  const BlockGraph graph = row(cost);
  const auto scheme = GENERATE(MetisScheme::k_way, MetisScheme::recursive);
  CHECK_FALSE(partition_by_metis(work_graph(graph, 8), scheme, 0.05));
  CHECK(partition_by_metis(work_graph(row(std::vector<double>(40, 1.0)), 8), scheme, 0.05));
  const auto partition = partition_blocks(graph, {.ranks = 8});
  CHECK(partition.used == Partitioner::bisection);
  CHECK(partition.quality.imbalance[0] == Approx(partition.quality.unavoidable[0]));
  CHECK(partition.quality.empty_ranks == 0);
}

TEST_CASE("degenerate graphs have an answer", "[partition][fast]") {
  CHECK(partition_blocks(BlockGraph{}, {.ranks = 3}).rank_of_block.empty());
  CHECK(partition_blocks(row({5.0}), {.ranks = 1}).rank_of_block == std::vector{0});
  const auto free = partition_blocks(row(std::vector<double>(8, 0.0)), {.ranks = 4});  // nothing costs: as many blocks each
  CHECK(free.quality.empty_ranks == 0);
  CHECK(free.quality.imbalance[0] == 1.0);
  std::vector<double> air_only;
  for (int b = 0; b < 40; ++b) air_only.insert(air_only.end(), {1.0, 0.0});
  const auto no_sea = partition_blocks(row(air_only, 2), {.ranks = 4});
  CHECK(no_sea.within_tolerance);
  CHECK(no_sea.quality.cut == 3.0);
}

TEST_CASE("costs and edges that make no sense are named", "[partition][fast]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(partition_blocks(row({1.0, -2.0}), {.ranks = 2}), Contains("block 1 has cost -2"));
  CHECK_THROWS_WITH(partition_blocks(row({1.0, std::nan("")}), {.ranks = 2}), Contains("block 1"));
  CHECK_THROWS_WITH(partition_blocks(row({1, 2, 3}, 2), {.ranks = 2}), Contains("3 costs"));
  CHECK_THROWS_WITH(partition_blocks(row({1.0}), {.ranks = 0}), Contains("0 ranks"));
  BlockGraph graph = row({1.0, 1.0});
  graph.edges.push_back({0, 2, 1.0});
  CHECK_THROWS_WITH(partition_blocks(graph, {.ranks = 2}), Contains("edge 0-2"));
}

TEST_CASE("all ranks hold the partition of rank 0", "[partition][mpi2]") {
  const BlockGraph graph = air_over_sea(4, 8);
  const auto partition = partition_blocks(graph, {.ranks = 2}, MPI_COMM_WORLD);
  CHECK(partition.within_tolerance);
  std::vector<int> of_root = partition.rank_of_block;
  MPI_Bcast(of_root.data(), int(of_root.size()), MPI_INT, 0, MPI_COMM_WORLD);
  CHECK(of_root == partition.rank_of_block);
  CHECK_THROWS(partition_blocks(row({-1.0}), {.ranks = 2}, MPI_COMM_WORLD));
}
