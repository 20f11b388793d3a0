// The error in time of a physical step, by Milne's device: what the step came to against what the states before it extrapolate
// to. And into how many steps a window is divided so that it stays below a tolerance. Owned by FlowSolver and
// src/run/flow_simulation.cpp; tested in tests/src/aero/flow/time_error_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "src/aero/flow/flow_residual.hpp"
#include "src/aero/flow/flow_setting.hpp"
#include "src/aero/flow/physical_time.hpp"
#include "src/aero/flow/tile_arrays.hpp"
#include "src/aero/flow/tile_sums.hpp"

namespace spindrift::aero {

/// Share of the difference between a step of order p and the extrapolation of the p + 1 levels before it that is the step's own
/// local error. With the leading term of both (Hairer, Norsett & Wanner, Solving ODE I, III.2 and III.5, for steps of any
/// length): 1 / (1 + a T), a the weight of the new level, T = (time from the oldest of those levels) / step. Of equal steps 2/11
/// by BDF2, 3/25 by BDF3.
constexpr double milne_share(double weight_now, double steps_to_oldest) { return 1.0 / (1.0 + weight_now * steps_to_oldest); }

class TimeError {
 public:
  /// All are to outlive it.
  TimeError(const FlowSetting& setting, TileArrays& arrays, const PhysicalTime& time, const FlowResidual& residual);

  /// Whether the setting asks for it.
  bool asked() const { return asked_; }
  /// A tile's part of `sums`. @pre the step has been made
  void measure(std::size_t owned);
  /// Of the step made last: norm of the error of the momentum that the air has beyond the undisturbed stream, over that
  /// of this momentum itself, at least 1e-4 of the stream's; both over cells weighted by volume. Nothing where the step's order
  /// had no level more to compare with.
  std::optional<double> estimate() const;

  TileSums sums;  ///< squares of both

 private:
  bool known() const { return asked_ && time_.steps > time_.order; }

  bool asked_;
  TileArrays& arrays_;
  const PhysicalTime& time_;
  const FlowResidual& residual_;
  gas::IdealGas gas_;
  double least_;  ///< momentum beyond the stream that counts at least [kg/(m2 s)]
};

/// Physical steps of a window: a power of two, so that where they end is exact.
class WindowSteps {
 public:
  static constexpr int most = 16;
  /// Begins with the most: the first steps have no past, and are of lower order.
  WindowSteps(double tolerance, int order) : tolerance_(tolerance), order_(order) {}

  int count() const { return count_; }
  void set_count(int count) { count_ = count; }
  bool too_large(double error) const { return error > tolerance_; }
  /// Whether a window of this largest error is to be made again, with twice as many steps.
  bool refine(double error);
  /// After a window that stands: half as many where its error is far below the tolerance.
  void end_window(double error);

 private:
  double tolerance_;
  int order_, count_ = most;
};

}  // namespace spindrift::aero
