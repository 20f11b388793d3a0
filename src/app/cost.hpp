// What a run will cost before it is run, for `spindrift check`: memory and core-seconds by part, and from them wall times on so
// many cores. Called by check.cpp; tested in tests/coupled/program_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace spindrift::app {

/// A part of the floating system that has a solver of its own.
struct PartCost {
  std::string name;               ///< "air", "sea"
  double count = 0.0;             ///< of `things`
  std::string things;             ///< "cells"
  double bytes = 0.0;             ///< while it runs, on all ranks together
  double bytes_each = 0.0;        ///< besides on every rank, however many there are
  double checkpoint_bytes = 0.0;  ///< more of them while a checkpoint is written
  double work_per_second = 0.0;   ///< per simulated second
  std::string work;               ///< "pseudo-steps"
  double core_seconds_per_work = 0.0;
  std::string rate;          ///< where that comes from
  double work_before = 0.0;  ///< before t = 0, in the same unit
};

/// What every rank takes besides: the program with its libraries, scene and files [bytes]; what a run takes to start and to write
/// its files [s].
struct BaseCost {
  double bytes = 0.0, core_seconds = 0.0;
};

/// Where memory or time of so much is beyond this computer, or beyond a year of all its cores: a warning each.
std::vector<std::string> beyond_machine(double bytes, double core_seconds);

/// `simulated_s`: from t = 0 to the end. `ranks`: of this run.
void print_cost(std::span<const PartCost> parts, double simulated_s, int ranks, const BaseCost& base, bool pseudo_steps = false);

}  // namespace spindrift::app
