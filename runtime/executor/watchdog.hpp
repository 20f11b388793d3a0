// A thread that watches: when nothing has completed for too long it writes down what every unfinished node waits for, and if no
// task is inside its work either, ends the run. A task that just takes long is named but left alone, unless another rank does not
// reply: that ends the run wherever it is, also where no graph runs. One for the process, made by main, from the moment a run
// says its time; where there is none each executor has its own.
// Used by Executor and src/app; tested in tests/runtime/failure_test.cpp, tests/runtime/stuck_rank and tests/faults/faults.py
// (stopped_rank, stopped_at_start). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/executor/worker.hpp"

namespace spindrift::runtime {

class Watchdog {
 public:
  enum class Of { executor, process };
  /// `limit_s`: nothing completes for so long; 0: it does not watch. After that of MPI, whose end is behind its own.
  explicit Watchdog(Of of, double limit_s = 0.0, std::FILE* file = stderr);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// That of the process, where it has one that watches.
  static Watchdog* current();
  /// Has that of the process, where there is one, watch from now on; 0: no longer.
  static void set_limit(double limit_s);

  void run_starts(Team& team);
  void run_ends(Team& team);

 private:
  void watch();
  void ask_others(double quiet_s);
  void look_at_graphs(double quiet_s);
  void end_without(const std::string& silent, double quiet_s);
  std::uint64_t progress() const;
  std::string sentence(double quiet_s, const std::string& silent) const;
  std::string report(double quiet_s, const std::string& silent) const;

  const Of of_;
  std::FILE* const file_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::vector<Team*> at_work_;
  double limit_s_;
  std::uint64_t changes_ = 0;  ///< runs that began or ended
  double said_s_ = 0.0;        ///< of the present quiet
  std::string named_;          ///< ranks
  bool leaving_ = false;
  std::thread thread_;
};

/// State of every node that is not done with the iteration its loop is in: what it waits for. At most `lines` lines.
std::string dump(const Team& team, int lines = 200);

}  // namespace spindrift::runtime
