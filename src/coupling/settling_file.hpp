// The state of a steady march before the run, saved in the run's folder while it lasts: killed there, the run goes on settling
// where it was when it is started again, with the same bits. The folder goes once the run's first checkpoint is there. Used by
// air_march.cpp and air_settling.cpp; tested in
// tests/src/coupling/settling_file_test.cpp and tests/coupled/settling_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/coupling/saved_array.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/checkpoint_plan.hpp"
#include "src/io/run_directory.hpp"

namespace spindrift::coupling {

/// All members are collective over the ranks of `world`.
class SettlingFile {
 public:
  /// `wall_interval_s` of the scene's checkpoints; 0: nothing is saved.
  SettlingFile(const io::RunDirectory& directory, const runtime::World& world, double wall_interval_s);

  /// The newest state of this very scene; nothing where there is none.
  std::optional<io::CheckpointReader> newest();
  /// After so many steps, at the end of a piece of the march: saved where it is time.
  void offer(int steps, const std::vector<SavedArray>& state);
  /// The state with which the march failed, beside the last good one. Returns a sentence that names both.
  std::string save_failed(int steps, const std::vector<SavedArray>& state);

 private:
  std::filesystem::path folder_;
  std::string identity_;
  runtime::World world_;
  io::CheckpointSeries series_;
  io::CheckpointPlan plan_;
  int saved_ = 0;  ///< steps of the last one
};

}  // namespace spindrift::coupling
