// What a scene says about time, surroundings, start, output and checkpoints: the sections that belong to the run as a whole.
// Declared in options.cpp, read by scenario.cpp, used by src/run. Tested in tests/src/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <string>

#include "kernels/base/constants.hpp"
#include "kernels/rigid/integrators.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::coupling {

struct TimeOptions {
  double end_s = 0.0;
  double window_s = 0.0;
  std::optional<double> step_s;  ///< the window where absent
  Integrator integrator = Integrator::rk4;

  double step() const { return step_s.value_or(window_s); }
};

struct EnvironmentOptions {
  double gravity_m_s2 = standard_gravity;
  double water_density_kg_m3 = 1025.0;
  double water_depth_m = 100.0;
  std::string bathymetry;  ///< path; empty: the bed is flat
  double air_density_kg_m3 = 1.225;

  Eigen::Vector3d gravity() const { return {0.0, 0.0, -gravity_m_s2}; }
};

struct StartOptions {
  bool equilibrium = false;
  double ramp_s = 0.0;
  std::string file;   ///< checkpoint of the same floating system; empty: none
  int air_steps = 0;  ///< resolved rotor on bodies: pseudo-steps of its air before t = 0
  std::string air;    ///< the same: a file of the run whose air it starts from
};

/// [[output.expected]]: what somebody else says of the mean of a column.
struct ExpectedOptions {
  std::string column;
  double mean = 0.0, within = 0.0;
  std::optional<double> from_s;  ///< stretch of the mean, to the end; that of output.means_over_s where absent
  std::string source;
};

struct OutputOptions {
  std::string title;
  std::vector<std::string> caveats, notes;  ///< what the scene has not of what it stands for
  std::string openfast = "none";
  int history_every = 1;
  double means_over_s = 0.0;  ///< 0: the last third of the run
  /// Length of the end of a run over which means are taken [s].
  double mean_length(double end_s) const { return means_over_s > 0.0 ? std::min(means_over_s, end_s) : end_s / 3.0; }
  std::optional<double> air_interval_s;  ///< between fields of the resolved air; 0: at the end alone
  std::vector<ExpectedOptions> expected;
};

struct CheckpointOptions {
  double interval_s = 0.0;         ///< simulated; 0: not by simulated time
  double wall_interval_s = 600.0;  ///< on the wall; 0: not by the clock
  int keep = 2;
};

struct RuntimeOptions {
  double wall_limit_s = 0.0;  ///< 0: none
  double watchdog_s = 600.0;  ///< nothing completes for so long: said, and ended where nothing works
};

const scene::Section<TimeOptions>& time_section();
const scene::Section<EnvironmentOptions>& environment_section();
const scene::Section<StartOptions>& start_section();
const scene::Section<OutputOptions>& output_section();
const scene::Section<CheckpointOptions>& checkpoint_section();
const scene::Section<RuntimeOptions>& runtime_section();

}  // namespace spindrift::coupling
