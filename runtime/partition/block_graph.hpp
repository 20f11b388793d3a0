// Blocks to be shared out among ranks: what each costs in every fluid, and what passes between neighbours.
// Built by whoever knows the blocks (src/aero, src/sea, src/coupling); read by partition.hpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace spindrift::runtime {

/// Weighted graph of blocks. A block may cost air time, sea time or both; costs need only be in proportion to each other.
struct BlockGraph {
  /// Something sent between the blocks a and b every step, `weight` in any unit of message size; both directions may be listed.
  struct Edge {
    int a, b;
    double weight;
  };
  int constraints = 1;       ///< costs per block, each to be balanced by itself (air, sea)
  std::vector<double> cost;  ///< cost[block * constraints + c] >= 0
  std::vector<Edge> edges;

  int blocks() const { return int(cost.size()) / constraints; }
};

}  // namespace spindrift::runtime
