// Which processors each rank may run on, said at the start of a run, and what is wrong with that: more threads than processors,
// or ranks that were bound to the same ones. Both leave cores idle and cost a factor that nothing else tells. Called by
// src/app/run.cpp; tested in tests/src/app/affinity_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"

namespace spindrift::runtime {

/// A rank of one node: its threads, and the processors that the system lets it use, ascending.
struct RankPlace {
  int rank = 0, threads = 1;
  std::vector<int> processors;
};

/// This process: the processors of its OpenMP places, or those that the system allows it; none where nothing tells.
RankPlace own_place(int rank, int threads);

/// "0-3,8".
std::string list_of(std::span<const int> ascending);

/// Sentences on ranks that have more threads than processors, and on ranks that share some while they could fill them alone.
/// Empty where each thread can have a processor. The ranks are those of one node, ascending.
std::vector<std::string> crowding(std::span<const RankPlace> node);

/// Of all ranks, on rank 0: where its node's ranks run, and the crowding of the first node that has any. Collective.
struct Affinity {
  std::string places;
  std::vector<std::string> crowding;
};
Affinity affinity(const World& world, int threads);

}  // namespace spindrift::runtime
