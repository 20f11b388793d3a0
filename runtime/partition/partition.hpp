// Shares blocks out among ranks so that each rank holds its part of the air's and of the sea's cost at the same time.
// With the summed cost METIS puts the two fluids on disjoint ranks, where one waits for the other; two constraints keep both on
// every rank (docs/developer/partition.md). Called where a run is set up; tested in tests/runtime/partition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "runtime/partition/block_graph.hpp"

namespace spindrift::runtime {

enum class Partitioner { best, metis_k_way, metis_recursive, bisection };

struct PartitionOptions {
  int ranks = 1;
  double tolerance = 0.05;  ///< a rank may hold this much more than its fair share of each cost
  Partitioner partitioner = Partitioner::best;
};

/// How good an assignment is.
struct PartitionQuality {
  std::vector<double> imbalance;    ///< per constraint: most loaded rank over the mean of all; 1 where nothing costs
  std::vector<double> unavoidable;  ///< per constraint: what the largest single block alone makes of it
  double cut = 0.0;                 ///< weight of the edges between blocks on different ranks
  double edges = 0.0;               ///< weight of all edges
  int empty_ranks = 0;
};

struct Partition {
  std::vector<int> rank_of_block;
  PartitionQuality quality;
  Partitioner used = Partitioner::bisection;
  bool within_tolerance = false;
};

PartitionQuality partition_quality(const BlockGraph& graph, const std::vector<int>& rank_of_block, int ranks);

/// `best` tries METIS (both schemes) and recursive bisection, refines each, and keeps the smallest cut within tolerance, or,
/// where no one is within it, the best balance. Same input, same result. Ranks beyond the number of blocks stay empty. Throws
/// std::invalid_argument for costs or edges that make no sense.
Partition partition_blocks(const BlockGraph& graph, const PartitionOptions& options);

/// The same on every rank of `comm`, computed once on its rank 0: processors of different types must not come to different
/// results. Collective; only rank 0's graph is partitioned, all need the same one for the quality.
Partition partition_blocks(const BlockGraph& graph, const PartitionOptions& options, MPI_Comm comm);

/// One line for the log: who did it, imbalances, cut, empty ranks.
std::string describe(const Partition& partition);

}  // namespace spindrift::runtime
