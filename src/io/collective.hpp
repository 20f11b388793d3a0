// Errors that all ranks share: where one rank fails, every rank throws the same exception, so that none is left waiting in MPI.
// Used by every collective operation of src/io. Tested in tests/src/io/run_files_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <functional>
#include <string>

namespace spindrift::io {

int rank_of(MPI_Comm comm);
int size_of(MPI_Comm comm);

/// Collective. Runs `work` on every rank; where it throws on any, all ranks throw the lowest failing rank's exception
/// (MachineFailure, InputError, runtime::StopAsked; anything else as std::runtime_error). `work` itself must not wait for other
/// ranks after a throw.
void together(MPI_Comm comm, const std::function<void()>& work);

/// Collective. Runs `work` on rank 0 alone, with the same rule for failures.
void on_root(MPI_Comm comm, const std::function<void()>& work);

/// Collective. Rank 0's text, on every rank.
std::string from_root(MPI_Comm comm, std::string text);

}  // namespace spindrift::io
