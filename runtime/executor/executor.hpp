// Replays a recorded graph on an OpenMP thread team, with messages of other ranks completing in between.
// Used by src/coupling; tested in tests/runtime/executor_test.cpp and beside it; its speed in perf/runtime.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>

#include "runtime/graph/errors.hpp"
#include "runtime/graph/graph.hpp"
#include "runtime/trace/record.hpp"

namespace spindrift::runtime {

struct ExecutorOptions {
  int threads = 0;             ///< 0: as OMP_NUM_THREADS says
  std::size_t records = 0;     ///< per thread, kept for the trace; 0: none
  bool priorities = true;      ///< longest measured cost-to-go first; without: first come first served
  bool flush_to_zero = false;  ///< denormal numbers as zero inside tasks (changes bits)
  /// Nothing completes for so long: dump the graph, and end the run if no task is inside its work. Where the process has a
  /// watchdog, that one's time counts.
  double watchdog_s = 600;
  std::FILE* watchdog_file = stderr;
  std::optional<std::uint64_t> random_schedule = {};  ///< tests: run ready tasks in an order drawn from this seed
};

struct Team;

class Executor {
 public:
  Executor(Graph graph, ExecutorOptions options = {});
  ~Executor();
  Executor(Executor&&) noexcept;

  /// Replays the whole graph n times; replays overlap through data. Ends when all tasks have. Throws TaskError where a task of
  /// any rank threw, HangError where the watchdog ended it; the executor cannot run again after that.
  void run(std::uint32_t n = 1);

  int threads() const;
  const Graph& graph() const;

  std::span<const Record> records(int thread) const;
  void clear_records();
  const ThreadTimes& times(int thread) const;
  TaskCost cost(std::uint32_t node) const;        ///< messages: from posting to completion
  std::uint64_t bytes(std::uint32_t node) const;  ///< sent or received by a message node in all, 8 per value for reductions

  struct State;
  const Team& team() const;  ///< for the trace

 private:
  std::unique_ptr<State> state_;
};

/// Lets messages progress; for use inside tasks longer than some 20 us, every 5 to 20 us. Cheap when there is nothing to do, and
/// does nothing outside of tasks.
void poll_messages();

}  // namespace spindrift::runtime
