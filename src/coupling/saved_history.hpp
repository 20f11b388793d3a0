// What checkpoints keep of history.csv, so that a restart knows whether its rows are whole. Called by run.cpp and flow_run.cpp;
// tested in tests/coupled/restart_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "src/coupling/run.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/history.hpp"

namespace spindrift::coupling {

/// Of what rank 0 wrote, after a flush. Collective.
void write(io::CheckpointWriter& file, const io::History::Extent& extent);
std::optional<io::History::Extent> extent_in(const io::CheckpointReader& file);

/// A new file on rank 0, or that of the run that goes on at `time_s`. Collective; throws on all ranks alike.
void open_history(MPI_Comm comm, io::History& history, const io::RunDirectory& directory, const RunSettings& settings,
                  double time_s, const std::optional<io::History::Extent>& written);

}  // namespace spindrift::coupling
