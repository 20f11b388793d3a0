// From a finished run to traces: one rank's own, and those of all ranks on rank 0, with their clocks brought together.
// Used by the program at the end of a run; tested in tests/runtime/trace/trace_of_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <vector>

#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

class Executor;
struct Team;

/// What an executor wrote down so far.
RankTrace trace_of(const Executor& executor, int rank = 0);
RankTrace trace_of(const Team& team, int rank = 0);

/// The same sums of a trace without records: a node per module and kind, no edges.
RankTrace by_module(const RankTrace& trace);
RankTrace by_module(const Team& team, int rank = 0);

/// All ranks' traces on rank 0 of `comm` (elsewhere nothing), times on the clock of its rank 0; those without records by_module.
/// Collective.
/// The clocks are compared by the fastest of 20 round trips: good to half of it, about 1 us within a computer.
std::vector<RankTrace> gather_traces(RankTrace mine, MPI_Comm comm);

}  // namespace spindrift::runtime
