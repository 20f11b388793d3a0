// Whether a file will fit, asked before it is begun: a clear refusal instead of an HDF5 file that can neither be finished nor
// closed. Called by shared_hdf5.cpp. Tested in tests/src/io/checkpoint_faults_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace spindrift::io {

/// For a file at `path` that has `written` bytes and shall have `size`: throws MachineFailure, with both figures, where the
/// process's limit of file sizes (ulimit -f) or the free space of the file system is smaller. A quota shows only when written to.
void require_room(const std::filesystem::path& path, std::int64_t size, std::int64_t written);

}  // namespace spindrift::io
