// Set-up of the log: spdlog's default logger writes to the console and, from rank 0, to log.txt; warnings are counted.
// Modules just say spdlog::info("..."), spdlog::warn("..."). Called by src/app. Tested in tests/src/io/run_files_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace spindrift::io {

/// Before the run directory is known: console only. Rank 0 prints everything, other ranks only errors, with their rank in front.
/// `quiet` leaves warnings and errors.
void start_log(int rank, bool quiet);

/// As start_log() was told last.
int log_rank();

/// From now on also to `path` (rank 0; appended to, so that a restart's lines follow the first run's). Throws MachineFailure.
void log_to_file(int rank, const std::filesystem::path& path);

/// Warnings and errors logged by this process since start_log().
std::int64_t warnings_logged();

}  // namespace spindrift::io
