// A graph recorded on one rank, several times side by side: a scene so many times as wide. The copies stand in a ring. Each
// borders the next by what its own two halves border each other by, the halves being those of the smallest cut: tasks that write
// blocks of both are done once more across the border (of a task in parts, those that cross it), tasks that only read the other
// half read the next copy's as well. Tasks that write blocks everywhere are each copy's own; loops, reductions and tasks of no
// block are one of all. Used by predict.cpp; tested in tests/runtime/replay/copies_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/replay/simulate.hpp"

namespace spindrift::runtime {

/// Without edges, which recut() derives. Tasks of no block take `serial` times as long as recorded; those that work on all that a
/// rank holds `count` times as long, which recut() shares out. Throws std::invalid_argument
/// for a graph with messages.
RankRun copies(const GraphRecord& graph, const RunRecord& run, int count, double serial = 1.0);

}  // namespace spindrift::runtime
