// One thread of the team and the algorithm of the replay: a node with all its tokens is fired; when it is done it hands a token
// to each successor; gates open the iterations of loops, joins close them. Used by executor.cpp; tested in
// tests/runtime/executor_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/executor/program.hpp"
#include "runtime/executor/ready_queue.hpp"
#include "runtime/executor/sleepers.hpp"
#include "runtime/graph/recorded.hpp"
#include "runtime/mpi/messages.hpp"

namespace spindrift::runtime {

class Worker;

/// What the threads of one executor share.
struct Team {
  Team(Graph graph, ExecutorOptions options);

  Graph graph;
  ExecutorOptions options;
  Program program;
  Messages messages;
  std::vector<std::unique_ptr<Worker>> workers;
  Sleepers sleepers;
  bool spins = true;                          ///< idle threads may spin: there is a processor for each
  int levels = 1;                             ///< of priority in use
  bool recording = false;                     ///< this run leaves records
  alignas(64) std::atomic<bool> ended{true};  ///< the run is over or cancelled
  alignas(64) std::atomic<std::int64_t> last_poll_ns{0};

  std::mutex failure_lock;
  std::optional<Notice> failure;

  void fail(Notice notice);  ///< any thread: cancels the run; the first failure counts
};

class alignas(64) Worker {
 public:
  Worker(Team& team, int id);

  /// Takes part in the run until it ends.
  void work();
  /// Opens the first iteration of a loop that has its tokens; `limit` iterations of it are certain.
  void enter(std::uint32_t loop, std::uint32_t limit);
  /// Lets messages progress and completes what is done; from inside a task `nested`.
  void poll(bool nested);
  void poll_if_due(std::int64_t now, bool nested);

  ReadyQueue queue;
  RecordBuffer records;
  ThreadTimes times;
  std::atomic<std::uint64_t> beats{0};         ///< nodes fired or completed, for the watchdog
  std::atomic<std::uint32_t> inside{no_node};  ///< task running now
  static Worker*& current();                   ///< of the calling thread, null outside of runs

 private:
  void token(std::uint32_t slot, std::uint32_t step);
  void ready(std::uint32_t slot, std::uint32_t step);
  void schedule(std::uint32_t slot);
  void rearm(Slot& slot);
  void fire(std::uint32_t slot);
  void skip(std::uint32_t slot);
  template <class Body>
  bool run(std::uint32_t slot, Body&& body);
  void ask(std::uint32_t slot);
  void complete(std::uint32_t slot);
  void close_iteration(Loop& loop, std::uint32_t step);
  void complete_message(const Messages::Completion& completion);

  std::uint32_t take();
  std::uint32_t steal(std::int64_t now, bool from_anyone);
  std::uint32_t wait();
  void back_off(std::int64_t waited_ns);
  Context context(const Slot& slot) const;
  void record(std::uint32_t slot, const Context& where, Activity activity, std::int64_t begin, std::int64_t end,
              std::uint32_t bytes, bool needed = true);
  std::uint32_t random();

  Team& team_;
  Program& program_;
  Slot* slots_;
  const int id_;
  const bool keeps_next_;         ///< not in a random schedule
  bool nested_ = false;           ///< polling inside a task
  bool waits_ = false;            ///< in wait(), which sums up its own time
  std::uint32_t next_ = no_node;  ///< ready and first in turn, without passing through the queue
  struct Progress {
    std::uint64_t beats = 0;
    std::int64_t since_ns = 0;
  };
  std::vector<Progress> progress_;  ///< by other thread: its beats when last looked at, and since when they are so
  int victim_;
  std::uint64_t random_state_;
  std::vector<Messages::Completion> completions_;
};

inline Worker*& Worker::current() {
  static thread_local Worker* worker = nullptr;
  return worker;
}

}  // namespace spindrift::runtime
