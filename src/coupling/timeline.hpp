// Time counted in whole windows and steps: no floating-point time is ever accumulated (101 substeps instead of 100 otherwise
// appear in most windows). Used by the coupling; tested in tests/src/coupling/timeline_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace spindrift::coupling {

/// long / short where that is a whole number to one part in 1e9, else nothing.
inline std::optional<std::int64_t> whole_ratio(double whole, double part) {
  const double ratio = whole / part, rounded = std::round(ratio);
  if (!(rounded >= 1.0) || rounded > 9e15 || std::abs(ratio - rounded) > 1e-9 * rounded) return std::nullopt;
  return std::int64_t(rounded);
}

/// The part nearest to `part` that divides `whole` a whole number of times.
inline double nearest_divisor(double whole, double part) { return whole / std::max(1.0, std::round(whole / part)); }

/// The whole number of times `part` that is nearest to `whole`.
inline double nearest_multiple(double whole, double part) { return std::round(whole / part) * part; }

/// Windows of equal length, each of the same number of steps (ticks).
class Timeline {
 public:
  /// The ratios are whole (see whole_ratio). `held_s` before t = 0 the bodies are held.
  Timeline(double window_s, double step_s, double end_s, double held_s = 0.0)
      : window_s_(window_s),
        steps_(whole_ratio(window_s, step_s).value()),
        windows_(whole_ratio(end_s, window_s).value()),
        held_(std::llround(held_s / window_s)) {}

  std::int64_t steps_per_window() const { return steps_; }
  std::int64_t windows() const { return windows_; }
  double tick_s() const { return window_s_ / double(steps_); }
  double window_s() const { return window_s_; }
  /// End of the n-th window, exactly the same number however it was reached.
  double window_end_s(std::int64_t window) const { return double(window) * window_s_; }
  std::int64_t tick_of_window(std::int64_t window) const { return window * steps_; }
  /// Windows before t = 0, and the tick (not above zero) with which the run begins.
  std::int64_t held_windows() const { return held_; }
  std::int64_t first_tick() const { return -tick_of_window(held_); }

 private:
  double window_s_;
  std::int64_t steps_, windows_, held_;
};

}  // namespace spindrift::coupling
