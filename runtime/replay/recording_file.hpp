// A recording as a file: JSON lines, one object a line (docs/developer/recording.md). Written by the driver of a run, read by
// `spindrift replay`; tested in tests/runtime/replay/recording_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <string>

#include "runtime/replay/recording.hpp"

namespace spindrift::runtime {

/// Version 1 did not say which executions were skipped: what it has are collective calls that took no time.
inline constexpr int recording_version = 2, oldest_recording_version = 1;

/// Rank 0 writes what all ranks have: `own.ranks` holds the rank's own part alone; title, threads and windows are those of rank
/// 0. One rank's text at a time is in memory. Collective; throws std::runtime_error on rank 0 where the file cannot be written.
void write_recording(const Recording& own, const std::string& path, MPI_Comm comm);

/// Throws std::runtime_error with file, line and what is wrong.
Recording read_recording(const std::string& path);

}  // namespace spindrift::runtime
