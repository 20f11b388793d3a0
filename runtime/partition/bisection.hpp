// Recursive bisection that balances two costs at once by construction; the fallback of METIS.
// Internal to runtime/partition; tested in tests/runtime/partition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/partition/work_graph.hpp"

namespace spindrift::runtime {

/// Rank of every block. Needs no edges and no minimum of blocks; each division misses the ideal by about one block.
std::vector<int> partition_by_bisection(const WorkGraph& graph);

}  // namespace spindrift::runtime
