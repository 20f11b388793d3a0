// Chooses among the partitioners by the quality of what they deliver.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/partition.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "runtime/partition/bisection.hpp"
#include "runtime/partition/metis_partition.hpp"
#include "runtime/partition/refine.hpp"
#include "runtime/partition/work_graph.hpp"

namespace spindrift::runtime {

namespace {

std::optional<std::vector<int>> assign(const WorkGraph& graph, Partitioner partitioner, double tolerance) {
  switch (partitioner) {
    case Partitioner::metis_k_way:
      return partition_by_metis(graph, MetisScheme::k_way, tolerance);
    case Partitioner::metis_recursive:
      return partition_by_metis(graph, MetisScheme::recursive, tolerance);
    case Partitioner::bisection:
    case Partitioner::best:
      break;
  }
  return partition_by_bisection(graph);
}

double worst(const PartitionQuality& quality) { return *std::max_element(quality.imbalance.begin(), quality.imbalance.end()); }

/// Within tolerance before outside it; then the smaller cut, or outside it the better balance.
bool better(const Partition& a, const Partition& b) {
  if (a.within_tolerance != b.within_tolerance) return a.within_tolerance;
  if (a.within_tolerance) return a.quality.cut < b.quality.cut;
  return worst(a.quality) < worst(b.quality);
}

}  // namespace

PartitionQuality partition_quality(const BlockGraph& graph, const std::vector<int>& rank_of_block, int ranks) {
  const WorkGraph work = work_graph(graph, ranks);
  PartitionQuality quality;
  for (int c = 0; c < graph.constraints; ++c) {
    std::vector<double> load(ranks, 0.0);
    double total = 0.0, largest = 0.0;
    for (int block = 0; block < graph.blocks(); ++block) {
      const double cost = graph.cost[std::size_t(block) * graph.constraints + c];
      load[rank_of_block[block]] += cost;
      total += cost;
      largest = std::max(largest, cost);
    }
    const double mean = total / ranks;
    quality.imbalance.push_back(mean > 0.0 ? *std::max_element(load.begin(), load.end()) / mean : 1.0);
    quality.unavoidable.push_back(mean > 0.0 ? std::max(1.0, largest / mean) : 1.0);
  }
  std::vector<char> used(ranks, false);
  for (int block = 0; block < graph.blocks(); ++block) {
    used[rank_of_block[block]] = true;
    for (const auto& neighbour : work.around(block)) {
      quality.edges += 0.5 * neighbour.weight;
      if (rank_of_block[neighbour.block] != rank_of_block[block]) quality.cut += 0.5 * neighbour.weight;
    }
  }
  quality.empty_ranks = int(std::count(used.begin(), used.end(), false));
  return quality;
}

Partition partition_blocks(const BlockGraph& graph, const PartitionOptions& options) {
  const WorkGraph work = work_graph(graph, options.ranks);
  std::vector<Partitioner> wanted{options.partitioner};
  if (options.partitioner == Partitioner::best)
    wanted = {Partitioner::metis_k_way, Partitioner::metis_recursive, Partitioner::bisection};
  std::optional<Partition> best;
  const auto consider = [&](Partitioner partitioner) {
    auto assigned = assign(work, partitioner, options.tolerance);
    if (!assigned) return;
    refine(work, options.tolerance, *assigned);
    Partition found{std::move(*assigned), {}, partitioner, false};
    found.quality = partition_quality(graph, found.rank_of_block, options.ranks);
    const bool filled = found.quality.empty_ranks == std::max(0, options.ranks - graph.blocks());
    found.within_tolerance = filled && worst(found.quality) <= 1.0 + options.tolerance + 1e-12;
    if (!best || better(found, *best)) best = std::move(found);
  };
  for (const Partitioner partitioner : wanted) consider(partitioner);
  if (!best) consider(Partitioner::bisection);  // METIS alone was asked for and cannot do this graph
  return *best;
}

Partition partition_blocks(const BlockGraph& graph, const PartitionOptions& options, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  work_graph(graph, options.ranks);  // a graph that makes no sense throws on every rank, not on one while the others wait
  Partition partition;
  partition.rank_of_block.resize(graph.blocks());
  if (rank == 0) partition = partition_blocks(graph, options);
  int about[2] = {int(partition.used), int(partition.within_tolerance)};
  MPI_Bcast(partition.rank_of_block.data(), graph.blocks(), MPI_INT, 0, comm);
  MPI_Bcast(about, 2, MPI_INT, 0, comm);
  partition.used = Partitioner(about[0]);
  partition.within_tolerance = about[1] != 0;
  partition.quality = partition_quality(graph, partition.rank_of_block, options.ranks);
  return partition;
}

std::string describe(const Partition& partition) {
  static constexpr const char* names[] = {"best", "METIS k-way", "METIS recursive", "recursive bisection"};
  const auto& quality = partition.quality;
  std::string text = std::string("partition by ") + names[int(partition.used)] + ": imbalance";
  char number[64];
  for (std::size_t c = 0; c < quality.imbalance.size(); ++c) {
    std::snprintf(number, sizeof number, "%s %.3f", c == 0 ? "" : " and", quality.imbalance[c]);
    text += number;
    if (quality.unavoidable[c] > 1.0) {
      std::snprintf(number, sizeof number, " (largest block alone %.3f)", quality.unavoidable[c]);
      text += number;
    }
  }
  std::snprintf(number, sizeof number, ", cut %.3g of %.3g (%.1f %%)", quality.cut, quality.edges,
                quality.edges > 0.0 ? 100.0 * quality.cut / quality.edges : 0.0);
  text += number;
  if (quality.empty_ranks > 0) text += ", " + std::to_string(quality.empty_ranks) + " ranks without blocks";
  return text + (partition.within_tolerance ? "" : "; outside the tolerance");
}

}  // namespace spindrift::runtime
