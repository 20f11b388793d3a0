// How much of a run the trials of `spindrift check --columns` cover, where they can be cut short. Called by leave_out.cpp; tested
// in tests/src/app/trial_length_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace spindrift::app {

/// Simulated time [s]: what the budget of processor time carries of what all whole runs take, in windows, at least three. A trial
/// that is cut short tells less than a whole one, so the last twentieth is not worth leaving out.
inline double trial_length_s(double end_s, double window_s, double budget_s, double forecast_s) {
  constexpr double nearly_whole = 0.95;
  const double windows = std::ceil(end_s / window_s * std::min(1.0, budget_s / forecast_s));
  const double length_s = std::max(3.0, windows) * window_s;
  return length_s >= nearly_whole * end_s ? end_s : length_s;
}

}  // namespace spindrift::app
