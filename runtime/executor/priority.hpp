// Priorities as cost-to-go: the measured cost of the longest chain of tasks from here to the end of the graph, so that what holds
// up most runs first. A loop's urgency goes before it: cost-to-go ignores that a loop with global reductions leaves threads
// idle which another loop could fill only if it still has tasks left (replayed on 64 nodes: efficiency 0.77 with such a loop
// first, 0.57 with the other first). Called by Executor between runs; tested in tests/runtime/priority_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/executor/program.hpp"

namespace spindrift::runtime {

/// Cost-to-go of each node [ns]: to the end of its body, of half the loop's iterations left, and of what follows the loop.
std::vector<double> cost_to_go(const Program& program, const Graph& graph);

/// Sets Slot::level from urgency and cost-to-go; returns the number of nodes by level.
std::vector<std::uint32_t> assign_levels(Program& program, const Graph& graph);

}  // namespace spindrift::runtime
