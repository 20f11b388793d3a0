// What the executor writes down for every task it runs: one record of 40 bytes into a buffer of the running thread, allocated
// before the run. Written by runtime/executor; read by the trace export, the efficiency table and perf/runtime.
// Tested in tests/runtime/record_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/trace/clock.hpp"

namespace spindrift::runtime {

/// What a thread (task, idle, poll) or the network (send, receive, reduce) did between the two times of a record.
enum class Activity : std::uint8_t { task, send, receive, reduce, idle, poll };

struct Record {
  std::int64_t begin_ns, end_ns;  ///< of Clock; for messages from posting to completion as seen by a poll
  std::uint32_t task;             ///< node of Graph::nodes(); no_task for idle and poll
  std::uint32_t replay;           ///< how often the whole graph had been replayed before
  std::uint32_t iteration;        ///< of the innermost loop round the task, from 0 at each entry of the loop
  std::uint32_t bytes;            ///< of a message; 0 for others
  std::uint16_t thread;           ///< that ran the task, or saw the message complete
  Activity activity;
  bool needed = true;  ///< false: a message, reduction or collective call whose `active` said no
};
inline constexpr std::uint32_t no_task = ~0u;

/// The first `capacity` records of one thread; what comes later is counted, not kept. Only its thread adds.
class RecordBuffer {
 public:
  explicit RecordBuffer(std::size_t capacity = 0) : records_(capacity) {}

  void add(const Record& record) {
    if (size_ < records_.size())
      records_[size_++] = record;
    else
      ++lost_;
  }
  void clear() { size_ = lost_ = 0; }
  std::span<const Record> records() const { return {records_.data(), size_}; }
  std::size_t lost() const { return lost_; }

 private:
  std::vector<Record> records_;
  std::size_t size_ = 0, lost_ = 0;
};

/// Where the wall time of one thread went, summed over all runs of an executor, whether or not records are kept.
/// wall = task + idle + poll + overhead.
struct ThreadTimes {
  std::int64_t wall_ns = 0;  ///< inside Executor::run
  std::int64_t task_ns = 0;  ///< inside tasks
  std::int64_t idle_ns = 0;  ///< waiting: nothing to do, polls in vain among it
  std::int64_t poll_ns = 0;  ///< starting and completing messages
  std::uint64_t tasks = 0, steals = 0;
  std::int64_t overhead_ns() const { return wall_ns - task_ns - idle_ns - poll_ns; }  ///< the runtime's own work
};

/// What one node of the graph cost so far, all threads and replays.
struct TaskCost {
  std::int64_t total_ns = 0;
  std::uint64_t count = 0;
  double mean_ns() const { return count == 0 ? 0.0 : double(total_ns) / double(count); }
};

}  // namespace spindrift::runtime
