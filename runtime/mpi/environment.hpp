// Start and end of MPI, owned by main for the life of the program.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <memory>
#include <optional>

#include "runtime/mpi/heartbeat.hpp"

namespace spindrift::runtime {

/// The ranks of a run, as handed to whoever needs them.
struct World {
  MPI_Comm comm = MPI_COMM_WORLD;
  int rank = 0, size = 1;
};

/// Initialises MPI with MPI_THREAD_MULTIPLE and finalises it. Throws std::runtime_error where the library gives less,
/// naming what it gave. One per process.
class MpiEnvironment {
 public:
  MpiEnvironment(int& argc, char**& argv);
  ~MpiEnvironment();
  MpiEnvironment(const MpiEnvironment&) = delete;
  MpiEnvironment& operator=(const MpiEnvironment&) = delete;

  const World& world() const { return world_; }
  /// The smallest of what all ranks bring; nothing where not all have come within this time [s], and `abort` is all that is left.
  std::optional<int> smallest_of_all(int mine, double most_s) const;
  /// Ends all ranks at once with this exit code.
  [[noreturn]] void abort(int code) const;
  int rank() const { return world_.rank; }
  int size() const { return world_.size; }

 private:
  World world_;
  MPI_Comm meeting_ = MPI_COMM_NULL;  ///< of smallest_of_all, so that it meets no other message
  std::unique_ptr<Heartbeat> heartbeat_;
};

}  // namespace spindrift::runtime
