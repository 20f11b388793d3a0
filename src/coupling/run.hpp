// A run: windows from the start (or a checkpoint) to the end, with history, checkpoints, progress, stop requests and failures.
// Called by src/app; tested in tests/src/coupling and tests/coupled.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "runtime/mpi/parts.hpp"
#include "src/coupling/machine.hpp"
#include "src/coupling/start.hpp"
#include "src/io/run_directory.hpp"
#include "src/io/summary.hpp"

namespace spindrift::coupling {

struct RunSettings {
  std::optional<double> until_s;  ///< stop there, with a checkpoint, to be continued by restart
  bool restart = false;           ///< from the newest checkpoint of the directory
  bool trace = false;
  bool quiet = false;           ///< no progress
  bool accept_history = false;  ///< a restart goes on with rows of history.csv missing or changed
};

/// By the clock on the wall.
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Runs the machine into the directory and writes everything but report and summary.json; returns the summary with the exit code
/// (0 done, 3 numerical failure with the state saved, 5 stopped on request with a checkpoint). `parts`: a world, on which all
/// ranks have both sides, or what place() made of it. The directory is one of parts.world(). Collective.
io::Summary run(Machine& machine, const Start& start, const io::RunDirectory& directory, const runtime::Parts& parts,
                const RunSettings& settings);

}  // namespace spindrift::coupling
