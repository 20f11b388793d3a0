// Start and end of MPI, owned by main for the life of the program.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

namespace spindrift::runtime {

/// Initialises MPI with MPI_THREAD_MULTIPLE and finalises it. Throws std::runtime_error where the library gives less,
/// naming what it gave. One per process.
class MpiEnvironment {
 public:
  MpiEnvironment(int& argc, char**& argv);
  ~MpiEnvironment();
  MpiEnvironment(const MpiEnvironment&) = delete;
  MpiEnvironment& operator=(const MpiEnvironment&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace spindrift::runtime
