// A folder for the files of one test, removed at its end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace spindrift::test {

class Scratch {
 public:
  explicit Scratch(const std::string& name, MPI_Comm comm = MPI_COMM_SELF) : comm_(comm) {
    int number = ::getpid();
    MPI_Bcast(&number, 1, MPI_INT, 0, comm_);  // the ranks of a test share the folder of rank 0
    path_ = std::filesystem::path(SPINDRIFT_BINARY_DIR) / "test_scratch" / (name + "_" + std::to_string(number));
    on_root([this] {
      std::filesystem::remove_all(path_);
      std::filesystem::create_directories(path_);
    });
  }
  ~Scratch() {
    on_root([this] {
      std::error_code ignored;
      std::filesystem::remove_all(path_, ignored);
    });
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  template <class Work>
  void on_root(Work work) {
    int rank = 0;
    MPI_Comm_rank(comm_, &rank);
    MPI_Barrier(comm_);
    if (rank == 0) work();
    MPI_Barrier(comm_);
  }

  MPI_Comm comm_;
  std::filesystem::path path_;
};

}  // namespace spindrift::test
