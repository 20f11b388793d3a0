// The one place that calls METIS. Internal to runtime/partition; tested in tests/runtime/partition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "runtime/partition/work_graph.hpp"

namespace spindrift::runtime {

enum class MetisScheme { k_way, recursive };

/// Multi-constraint METIS (Karypis & Kumar, SC 1998) with a fixed seed. Nothing where METIS is not defined (one rank, fewer
/// blocks than ranks, no edges, no cost), where one block is more than 1.5 ranks' share, or where it reports an error. METIS
/// draws from the C library's rand(): not while other threads do.
std::optional<std::vector<int>> partition_by_metis(const WorkGraph& graph, MetisScheme scheme, double tolerance);

}  // namespace spindrift::runtime
