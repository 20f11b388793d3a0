// Sends, receives, reductions and turns of collective calls as tasks: posted without blocking, completed by whoever polls. One
// thread at a time is inside MPI (try-lock): Open MPI progresses only inside its calls, and MPI_THREAD_MULTIPLE is free as long
// as callers do not meet. Also carries the notice that a rank has failed, so that the others stop within a poll instead of
// waiting for its messages. Used by executor/worker; tested in tests/runtime/messages_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "runtime/executor/ready_queue.hpp"
#include "runtime/graph/recorded.hpp"
#include "runtime/mpi/turns.hpp"

namespace spindrift::runtime {

/// Why a rank gave up.
struct Notice {
  int rank = 0;
  bool hang = false;
  std::string label, what;
};

class Messages {
 public:
  struct Completion {
    std::uint32_t node;
    std::uint32_t bytes;
    std::int64_t posted_ns;
    bool active = true;  ///< false: was not needed this time
  };

  /// Thrown by poll where a buffer could not be had.
  struct Failure {
    std::uint32_t node;
    std::string what;
  };

  explicit Messages(Graph::Recorded& graph);
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  std::size_t count() const { return operation_nodes_.size(); }  ///< message nodes of the graph
  bool need_polling() const { return outstanding_.load(std::memory_order_relaxed) > 0 || control_; }

  /// Any thread: the node's message may start. It does at the next poll.
  void post(std::uint32_t node);
  struct Polled {
    bool looked = false;        ///< false: another thread is at it
    std::int64_t until_ns = 0;  ///< when the last message was started or completed; 0: none was
  };
  /// Starts what was posted, adds what completed.
  Polled poll(std::vector<Completion>& done);
  /// Any thread: the collective call that completed last has been made; the next one may have its turn.
  void made_call() { turns_->made(); }
  /// Another rank's notice, once, after the poll that received it.
  std::optional<Notice> notice();

  /// After a failure: tells all other ranks (if `tell`) and gives up all messages under way.
  void abandon(const Notice* tell);

 private:
  bool active(std::uint32_t node) const;
  void start(std::uint32_t node, std::int64_t now);
  void retire(int request);
  Graph::Recorded& graph_;
  std::vector<std::uint32_t> operation_nodes_;
  std::optional<Turns> turns_;  ///< where there are collective calls of several ranks
  ReadyQueue posted_;
  std::atomic<int> outstanding_{0};
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;

  bool control_ = false;  ///< there are other ranks
  bool left_behind_ = false;
  std::vector<char> notice_bytes_;
  std::optional<Notice> notice_;
  std::atomic<bool> has_notice_{false};
  MPI_Request control_request_ = MPI_REQUEST_NULL;

  // Requests under way, without gaps; parallel arrays.
  int active_ = 0;
  std::vector<MPI_Request> requests_;
  std::vector<std::uint32_t> node_of_, bytes_of_;
  std::vector<std::int64_t> posted_ns_;
  std::vector<int> indices_;
  std::vector<MPI_Status> statuses_;
};

}  // namespace spindrift::runtime
