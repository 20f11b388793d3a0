// A recorded graph in the form that is replayed: per node one cache line with its counters, flat lists of successors.
//
// A node runs once per step of the body it is in; steps are counted through all entries of the loop, so that state at the end of
// one entry is the state at the start of the next and nothing is ever reset. `waiting[s % 2]` counts the tokens that step s still
// misses: one from each predecessor of the same step (distance 0) or the step before (distance 1), and for the first nodes of a
// body one from the gate, which says that the step exists. Two counters are needed because gate tokens of step s+1 are given
// while step s is still to run; two are enough because nodes that share written data alternate (graph/edges.hpp), and a node that
// shares none gets an edge to itself.
// Built by Executor; replayed by executor/worker; tested in tests/runtime/executor_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

/// What to do with a node that has all its tokens. message: send, receive, or reduction over several ranks. collective: first it
/// waits for its turn among several ranks.
enum class Action : std::uint8_t { work, until, loop, message, reduce_here, collective, collective_here, join };
inline constexpr std::uint16_t no_home = 0xffff;

struct alignas(64) Slot {
  std::atomic<std::int32_t> waiting[2];
  std::int32_t need = 0;              ///< tokens of one step
  std::uint32_t step = 0;             ///< next to run; so many are done
  std::uint32_t first = 0, last = 0;  ///< in Program::successors
  std::uint32_t loop = 0;             ///< body it is in, index in Program::loops
  std::uint32_t join = no_node;       ///< told at the end of the last iteration; no_node if a successor tells for it
  std::uint32_t payload = 0;          ///< by action: work, predicate, loop, message, reduction, collective
  std::uint16_t home = no_home;       ///< thread that should run it
  Action action = Action::work;
  std::uint8_t level = 0;  ///< of priority, highest first
  bool gated = false;
  bool placed = false;       ///< home is given, not where it ran last
  std::int64_t cost_ns = 0;  ///< of all runs
};
static_assert(sizeof(Slot) == 64);

struct alignas(64) Loop {
  std::uint32_t slot = no_node;       ///< of the loop itself; no_node: the whole graph
  std::uint32_t outermost = no_node;  ///< slot of the outermost loop round the body
  std::uint32_t base = 0;             ///< step at which this entry began
  std::uint32_t limit = 1;            ///< iterations of this entry that exist whatever `until` says
  std::uint32_t min = 1, max = 1;
  std::uint32_t until = no_node;
  std::uint32_t end = no_node;                  ///< join that completes an iteration
  std::uint32_t first_gate = 0, last_gate = 0;  ///< in Program::gates; `until`, if any, is the last
  /// Iteration from which sinks tell the joins: the last one, or where there is an `until` the one before its first answer.
  /// `until` waits for the joins of the iteration before: it opens a step only when every node has counted again for that step.
  std::uint32_t told_from = 0;
  bool stop = false;                          ///< `until` said so
  std::uint64_t entries = 0, iterations = 0;  ///< so far
};

/// Iterations of an entry whose gates are opened in advance, if `limit` of them are certain.
inline std::uint32_t opened_in_advance(const Slot& slot, std::uint32_t limit) {
  return slot.action == Action::until ? limit - 1 : limit;
}

struct Program {
  explicit Program(const Graph& graph);

  std::vector<Slot> slots;                ///< the nodes, then joins
  std::vector<Loop> loops;                ///< the whole graph, then the loops in the order of recording
  std::vector<std::uint32_t> successors;  ///< 2 * slot + distance
  std::vector<std::uint32_t> gates;
};

}  // namespace spindrift::runtime
