// What a scene could do without: each smaller choice that it leaves open, run beside the scene itself, with its effect on the
// columns asked for and what it saves. The whole run of each where all of them together keep to a budget of processor time. Else,
// for bodies with engineering loads, as much of it as the budget carries, and what that cannot tell is left open; for fluids
// nothing. Called by `spindrift check --columns`; tested in tests/coupled/leave_out_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "src/app/smaller_choices.hpp"

namespace spindrift::app {

/// Mean and standard deviation of a column, or what a choice changes of them, in the column's unit.
struct Effect {
  std::optional<double> mean, deviation;  ///< nothing where the trial cannot tell
};

/// Share of the processor time of windows and rows, of fluids also of the start, and twice its standard error.
struct Saving {
  double share = 0.0;  ///< 0 ... 1; negative where it costs more
  double error = 0.0;
  bool shows() const { return std::abs(share) > error; }
};

struct Omission {
  SmallerChoice choice;
  std::vector<Effect> effects = {};  ///< by column asked for
  Saving saving = {};
  std::string refused = {};  ///< not empty: why it cannot be done
};

struct Trial {
  double length_s = 0.0, end_s = 0.0;       ///< simulated, and of the whole run
  double budget_s = 0.0, forecast_s = 0.0;  ///< processor time of all runs: allowed, and forecast of whole ones
  bool steady = false;                      ///< a march to a steady state: means are the values at its end
  std::string untried;                      ///< not empty: what all runs would take, which is too much
  std::vector<std::string> unlike;          ///< why a trial that is cut short tells nothing of effects
  std::vector<Effect> own;                  ///< mean and deviation of the columns themselves
  std::vector<Omission> omissions;          ///< largest saving first
  bool whole() const { return length_s >= end_s; }
};

/// Processor time of all runs of a trial together, where the user does not say [s].
inline constexpr double usual_trial_s = 120.0;

/// Of the scene in this file with these overrides. Says how far it is where it takes more than two seconds. Throws
/// scene::SceneError where a column does not exist, NumericalFailure where the scene itself comes to nothing.
Trial try_omissions(const std::string& path, const std::vector<std::string>& overrides, const std::vector<std::string>& columns,
                    double budget_s);

}  // namespace spindrift::app
