// "Finish the window, save, stop": SIGTERM, SIGINT or SIGUSR1 sent to any rank, or a limit on wall time, agreed on by all ranks.
// Used by src/coupling between windows; tested in tests/coupled/program_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <chrono>
#include <string>

namespace spindrift::runtime {

class StopRequest {
 public:
  /// Catches the signals from now on; a second SIGINT ends the program at once. wall_limit_s <= 0: none.
  explicit StopRequest(double wall_limit_s = 0.0);
  ~StopRequest();  ///< gives the signals back
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Why to stop, on all ranks alike; empty to go on. Collective over `comm`; a few microseconds.
  std::string agreed(MPI_Comm comm) const;

 private:
  std::chrono::steady_clock::time_point end_;
  bool limited_;
};

}  // namespace spindrift::runtime
