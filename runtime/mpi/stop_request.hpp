// "Finish the window, save, stop": a signal sent to any rank, a file, or a limit on wall time, agreed on by all ranks. Checked
// between windows; through a reduction in every pseudo-step of the air, substep of particles and hundred steps of bodies; and by
// each rank alone while grids are made. Used by src; tested in tests/runtime/stop_request_test.cpp and tests/faults.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

namespace spindrift::runtime {

/// Work was given up since all ranks know that the run is to stop; its state is of no use.
struct StopAsked : std::runtime_error {
  StopAsked();  ///< says why, where this rank knows
};

class StopRequest {
 public:
  /// Catches TERM, INT, USR1, USR2, HUP and XCPU from now on; a second signal, a second later or more, ends the program at once.
  StopRequest();
  /// Catches them for the one that is to come, which then knows of a signal that came before it.
  static void catch_signals();
  /// As with `watch`.
  explicit StopRequest(double wall_limit_s, std::filesystem::path file = {});
  ~StopRequest();  ///< gives the signals back, unless it is over
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// From now on wall time is limited; wall_limit_s <= 0: it is not. `file`: whose appearance is a request (it is then removed);
  /// empty: none.
  void watch(double wall_limit_s, std::filesystem::path file = {});
  /// There is nothing left to stop: the signals do nothing from now on, also when this is gone ...
  void over();
  /// ... until they end the program again, for work that may be broken off.
  static void give_signals_back();
  /// What saving takes: so much before the limit on wall time the run is to stop.
  void keep_margin(double seconds);

  /// Whether this process knows of a request, to be summed over the ranks by who acts on it. Cheap; from any thread.
  static bool asked();
  /// While one lives asked() is false: work that has nothing to go back to is done to its end.
  struct Later {
    Later();
    ~Later();
    Later(const Later&) = delete;
    Later& operator=(const Later&) = delete;
  };
  /// For work in which ranks do not meet: throws StopAsked where this process knows of a request. See give_up_together.
  static void give_up_if_asked();
  /// The signal that this process was sent, or has heard of from another rank; 0 where there is none.
  static int signal_caught();
  static void hear(int signal);
  /// Why to stop, on all ranks alike; empty to go on. Collective over `comm`; a few microseconds.
  std::string agreed(MPI_Comm comm) const;

 private:
  std::filesystem::path file_;
  bool over_ = false;
};

/// Does work in which ranks do not meet and which each gives up by itself (StopAsked). Where one has, all throw StopAsked.
/// Collective.
void give_up_together(MPI_Comm comm, const std::function<void()>& work);

}  // namespace spindrift::runtime
