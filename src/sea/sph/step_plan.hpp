// The steps of a window: how long they are, how many until the limits are checked again, when the particles are sorted, why a
// window ends before its time. All ranks have the same `Plan`: it is computed from global extremes and sums only. Called by
// tasks.cpp and sea_sph.cpp; tested in tests/src/sea/sph/step_plan_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kernels/base/failure.hpp"
#include "kernels/base/in_words.hpp"
#include "kernels/sph/time_step.hpp"
#include "src/sea/sph/parameters.hpp"

namespace spindrift::sph {

/// Counters of a run, for reports and benchmarks.
struct Work {
  long steps = 0, evaluations = 0, sorts = 0;
};

/// How the steps of a window are chosen.
struct StepControl {
  double dt = 0.0;  ///< a fixed step [s]; 0: as the limits allow
  /// Steps between two checks of the limits (and sorts). 1: before each, with a reduction over all ranks in each step.
  int steps_per_check = 1;
  /// Steps chosen by who counts time himself, and whether the window ends with them.
  struct Choice {
    double dt;
    bool last;
    int count = 1;
    double last_dt = dt;  ///< of the last of them [s]
  };
  /// Asked at each check for at most so many steps, none above the limit [s], on all ranks alike; may throw NumericalFailure.
  std::function<Choice(double limit, int most)> choose = {};
};

/// Part of the limit that steps between two checks keep to: the limits may tighten meanwhile.
inline constexpr double share_between_checks = 0.9;

/// Where the run stands.
struct Plan {
  double time = 0.0;
  long steps = 0;
  double left = 0.0;                                    ///< of the window [s]; with StepControl::choose above 0 until it ends
  double dt = 0.0, last_dt = 0.0;                       ///< of the steps planned, and of the last of them [s]
  int planned = 0;                                      ///< steps until the next check of the limits
  double speed = 0.0, acceleration = 0.0, limit = 0.0;  ///< largest at the last check of the limits, and what they allow [s]
  StepLimits limits{};
  double drift = 0.0, solid_drift = 0.0;    ///< bounds on the distance gone since the last sort [m]
  double travel = 0.0, solid_travel = 0.0;  ///< and since the last check of the limits
  double shifted = 0.0;                     ///< bound on the displacement by shifting since the last check of the limits [m]
  double solid_path = 0.0;                  ///< of bodies in all [m]
  bool sort = false;
  bool last = false;                        ///< the steps planned end the window (StepControl::choose)
  std::optional<NumericalFailure> failure;  ///< set where the numerics gave up; what is left of the window does nothing
  bool stopped = false;                     ///< the run was asked to stop: likewise

  bool ended() const { return failure || stopped; }
  /// Of the planned step n [s].
  double dt_of(int n) const { return n + 1 < planned ? dt : last_dt; }
  /// Whether to sort before the next steps: they may go twice as far as those before. drift: that particles may go between two
  /// sorts [m].
  bool sort_is_due(double drift) const;
  /// The particles have been sorted: what follows depends on them alone.
  void sorted();
  /// Takes in the extremes of the state at n (squares of speed and acceleration, shift [m]) and finds the largest
  /// stable step; body_limit [s] is that of light bodies. A step that no flow would need is a failure.
  void check_limits(const Parameters& p, double body_limit, double speed2, double acceleration2, double shifted);
  /// The next `count` steps are dt [s] long, the last of them last_dt.
  void start_steps(double dt, int count, double last_dt);
  void start_steps(double dt, int count) { start_steps(dt, count, dt); }
  /// How many steps at the limit, at most `most`, keep particles within `drift` [m] of where they were sorted; at least one.
  int steps_within(double drift, int most) const;
  /// Chooses the next steps of a window from `left` and `limit`; after it `planned` is 0 where the window has ended. A fixed step
  /// beyond the limit, and what StepControl::choose throws, become `failure`. drift: that particles may go between two sorts [m].
  void choose_steps(const StepControl& control, double drift);
  /// The steps planned were made: clocks and counters.
  void finish_steps(const StepControl& control, StepChoice step, Work& work);
  /// A body has gone `travel` [m].
  void count_travel_of_body(double travel) { solid_drift += travel, solid_travel += travel, solid_path += travel; }
};

}  // namespace spindrift::sph
