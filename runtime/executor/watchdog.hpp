// A thread that watches: when nothing has completed for too long it writes down what every unfinished node waits for, and if no
// task is inside its work either, ends the run. A task that just takes long is named but left alone, unless another rank does not
// reply: that ends the run wherever it is, also between two graphs.
// Used by Executor; tested in tests/runtime/failure_test.cpp and tests/faults/faults.py (stopped_rank).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/executor/worker.hpp"

namespace spindrift::runtime {

class Watchdog {
 public:
  explicit Watchdog(Team& team);
  ~Watchdog();
  void run_starts();
  void run_ends();

 private:
  void watch();
  void ends_or_says(double quiet_s, const std::string& silent);
  Team& team_;
  std::mutex lock_;
  std::condition_variable changed_;
  bool running_ = false, leaving_ = false;
  std::thread thread_;
};

/// State of every node that is not done with the iteration its loop is in: what it waits for. At most `lines` lines.
std::string dump(const Team& team, int lines = 200);

}  // namespace spindrift::runtime
