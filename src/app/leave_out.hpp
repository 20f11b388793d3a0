// What a scene could do without: each smaller choice that it leaves open, tried for a moment beside the scene itself, with its
// effect on the columns asked for and what it saves. For scenes whose trial takes moments: bodies with engineering loads. Called
// by `spindrift check --columns`; tested in tests/coupled/leave_out_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace spindrift::app {

struct Effect {
  double mean = 0.0, deviation = 0.0;  ///< change of the column's mean and standard deviation, in its unit
};

struct Omission {
  std::string name;                    ///< "longer step"
  std::vector<std::string> overrides;  ///< what makes it: "time.step_s=0.1"
  std::vector<Effect> effects;         ///< by column asked for
  double saving = 0.0;                 ///< of the processor time of steps and rows, 0 ... 1; negative where it costs more
  std::string refused;                 ///< not empty: why it cannot be done
};

struct Trial {
  double length_s = 0.0;            ///< simulated
  std::vector<Effect> own;          ///< mean and deviation of the columns themselves
  std::vector<Omission> omissions;  ///< largest saving first
};

/// Of the scene in this file with these overrides. Throws scene::SceneError where a column does not exist.
Trial try_omissions(const std::string& path, const std::vector<std::string>& overrides, const std::vector<std::string>& columns);

}  // namespace spindrift::app
