// Who is still there: where a rank has been quiet for long, its watchdog asks on a communicator of its own, and every rank's
// watchdog answers, whatever its tasks do. Rank 0 asks all others; these ask rank 0, which says whom it has not heard. Nothing is
// sent as long as work goes on. Owned by MpiEnvironment; called by executor/watchdog.cpp; tested in tests/faults/faults.py
// (stopped_rank). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <mutex>
#include <string>
#include <vector>

namespace spindrift::runtime {

class Heartbeat {
 public:
  /// Collective, as is its end.
  explicit Heartbeat(MPI_Comm world);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  /// That of the process; null where there is one rank.
  static Heartbeat* current();

  /// Answers who has asked, hears who has answered; to be called about once a second.
  void attend();
  /// Asks; who has answered since `forget` is not asked again.
  void ask();
  void forget();
  /// "rank 3 does not answer", empty where all have answered as far as this rank can tell.
  std::string silent();

 private:
  void send(int rank, int tag, const std::vector<int>& words);
  std::vector<int> unheard() const;

  std::mutex lock_;  // watchdogs of several executors
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  std::vector<char> heard_;        // by rank on rank 0, of rank 0 elsewhere
  int asked_ = 0;                  // times since `forget`
  std::vector<int> told_;          // elsewhere: whom rank 0 has not heard
  std::vector<MPI_Request> sent_;  // to ranks that may never receive
  std::vector<std::vector<int>> buffers_;
};

}  // namespace spindrift::runtime
