// Entry of every test executable: Catch2 inside an initialised MPI, so that a test may run on one rank or, by mpirun, on many.
// Temporary files go to a folder of this run, which its ranks share: tests may run beside each other. SPDX-License-Identifier:
// Apache-2.0
#define CATCH_CONFIG_RUNNER
#include <stdlib.h>

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "runtime/mpi/environment.hpp"

namespace {

/// What std::filesystem::temp_directory_path() gives while this lives. Collective.
class OwnTemporaries {
 public:
  OwnTemporaries() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    std::array<char, 512> path{};
    if (rank_ == 0) {
      const std::string pattern = (std::filesystem::temp_directory_path() / "spindrift_test_XXXXXX").string();
      if (pattern.size() < path.size()) pattern.copy(path.data(), pattern.size());
      if (!mkdtemp(path.data())) path[0] = '\0';
    }
    MPI_Bcast(path.data(), int(path.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    path_ = path.data();
    if (!path_.empty()) setenv("TMPDIR", path_.c_str(), 1);
  }
  ~OwnTemporaries() {
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    if (rank_ == 0 && !path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  OwnTemporaries(const OwnTemporaries&) = delete;
  OwnTemporaries& operator=(const OwnTemporaries&) = delete;

 private:
  int rank_ = 0;
  std::string path_;
};

}  // namespace

int main(int argc, char** argv) {
  Catch::Session session;
  if (const int wrong = session.applyCommandLine(argc, argv)) return wrong;
  const Catch::ConfigData& asked = session.configData();
  if (asked.listTests || asked.listTestNamesOnly || asked.listTags) return session.run() > 255 ? 255 : 0;
  const spindrift::runtime::MpiEnvironment mpi(argc, argv);
  const OwnTemporaries temporaries;
  const int failures = session.run();
  int worst = failures;
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return worst > 255 ? 255 : worst;
}
