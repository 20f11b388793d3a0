// A folder for the files of one test, removed at its end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace spindrift::test {

class Scratch {
 public:
  /// One folder per process; ranks of an MPI test share `name` and let rank 0 make it (shared = true: no process number in the name).
  explicit Scratch(const std::string& name, bool shared = false)
      : path_(std::filesystem::path(SPINDRIFT_BINARY_DIR) / "test_scratch" / (name + (shared ? "" : "_" + std::to_string(::getpid())))),
        shared_(shared) {
    if (!shared_) std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    if (!shared_) std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool shared_;
};

}  // namespace spindrift::test
