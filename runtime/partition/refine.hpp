// Improves a given assignment of blocks to ranks by moves and swaps: first balance, then the edge cut within that balance.
// Internal to runtime/partition; tested in tests/runtime/partition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/partition/work_graph.hpp"

namespace spindrift::runtime {

/// Gives every rank a block where there are enough, moves and swaps blocks off overloaded ranks until none holds more than
/// 1 + tolerance fair shares of any constraint (or no move helps), then moves blocks that lessen the cut and keep that.
void refine(const WorkGraph& graph, double tolerance, std::vector<int>& rank_of_block);

}  // namespace spindrift::runtime
