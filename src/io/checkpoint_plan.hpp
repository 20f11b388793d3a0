// When a run saves its state: at its start, then by simulated time where the scene asks for it, then by the clock on the wall,
// seldom enough that saving takes less than a hundredth of the run. When it saves changes no bit of what it computes. Used by
// src/run/outputs.cpp; tested in tests/src/io/checkpoint_plan_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace spindrift::io {

class CheckpointPlan {
 public:
  using Clock = std::chrono::steady_clock;

  /// Every so much simulated time, and every so much on the wall [s]; 0: not by it.
  CheckpointPlan(double interval_s, double window_s, double wall_interval_s)
      : every_(interval_s > 0.0 ? std::max<std::int64_t>(1, std::llround(interval_s / window_s)) : 0), wall_s_(wall_interval_s) {}

  /// Whether a state at the start is kept, so that a run that is killed before its first interval is over can go on at all.
  bool at_start() const { return every_ > 0 || wall_s_ > 0.0; }
  /// After windows `before` + 1 to `number`, alike on all ranks: the clock is rank 0's. Collective where it counts.
  bool due(MPI_Comm comm, std::int64_t before, std::int64_t number, Clock::time_point now = Clock::now()) const {
    if (every_ > 0 && number / every_ != before / every_) return true;
    if (!(wall_s_ > 0.0)) return false;
    int late = now >= next_;
    MPI_Bcast(&late, 1, MPI_INT, 0, comm);
    return late != 0;
  }
  /// After each save: from when to when it took.
  void saved(Clock::time_point begin, Clock::time_point end = Clock::now()) {
    constexpr double share = 100.0;
    cost_s_ = std::chrono::duration<double>(end - begin).count();
    next_ = end + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::max(wall_s_, share * cost_s_)));
  }
  double cost_s() const { return cost_s_; }  ///< of the last one

 private:
  std::int64_t every_;
  double wall_s_, cost_s_ = 0.0;
  Clock::time_point next_{};
};

}  // namespace spindrift::io
