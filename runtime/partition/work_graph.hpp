// The block graph as the partitioners read it: costs as multiples of one rank's fair share, neighbours in compressed rows.
// Internal to runtime/partition; tested through partition.hpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "runtime/partition/block_graph.hpp"

namespace spindrift::runtime {

struct WorkGraph {
  struct Neighbour {
    int block;
    double weight;
  };
  int blocks = 0, ranks = 0;
  int constraints = 0;                ///< those that cost anything at all
  std::vector<double> shares;         ///< [block * constraints + c]; one rank's fair share is 1
  std::vector<int> first_neighbour;   ///< [blocks + 1]
  std::vector<Neighbour> neighbours;  ///< by block, ascending, each pair once a side

  std::span<const double> share(int block) const {
    return std::span(shares).subspan(std::size_t(block) * constraints, constraints);
  }
  std::span<const Neighbour> around(int block) const {
    return std::span(neighbours).subspan(first_neighbour[block], first_neighbour[block + 1] - first_neighbour[block]);
  }
};

/// Throws std::invalid_argument naming the block or edge that makes no sense.
WorkGraph work_graph(const BlockGraph& graph, int ranks);

}  // namespace spindrift::runtime
