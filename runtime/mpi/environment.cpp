// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/environment.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "runtime/trace/clock.hpp"

#ifdef SPINDRIFT_SANITIZED
/// Open MPI unloads its modules before the leak checker looks, which then cannot tell whose leaks it found (ci/lsan.supp).
extern "C" int dlclose(void*) { return 0; }
#endif

namespace spindrift::runtime {

namespace {

std::string own_folder;  ///< of Open MPI's files; empty where a launcher gave one

/// hwloc, which Open MPI asks about the computer, asks every X display for its GPUs, and ends the process where one closes
/// meanwhile. A run needs no GPU. What the user has set stands.
void without_displays() { setenv("HWLOC_COMPONENTS", "-gl", 0); }

/// A process that no launcher started talks to nobody: Open MPI need neither start a daemon beside it nor open a network, which
/// takes .5 s. What the user has set stands. Other libraries do not read these names.
void alone_without_network() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK") || std::getenv("PMI_RANK")) return;
  constexpr int keep = 0;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", keep);
  setenv("OMPI_MCA_pml", "ob1", keep);
  setenv("OMPI_MCA_btl", "self,vader", keep);
  // Isolated processes share one folder of Open MPI's and, started side by side, fail now and then: 6 of 400, 0 with one each.
  const char* given = std::getenv("TMPDIR");
  std::string folder = std::string(given ? given : "/tmp") + "/spindrift_mpi_XXXXXX";
  if (!mkdtemp(folder.data())) return;
  setenv("OMPI_MCA_orte_tmpdir_base", folder.c_str(), keep);
  own_folder = folder;
}

}  // namespace

MpiEnvironment::MpiEnvironment(int& argc, char**& argv) {
  without_displays();
  alone_without_network();
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
  if (provided < MPI_THREAD_MULTIPLE) {
    MPI_Finalize();
    throw std::runtime_error("MPI offers thread level " + std::to_string(provided) + ", Spindrift needs MPI_THREAD_MULTIPLE (" +
                             std::to_string(MPI_THREAD_MULTIPLE) + "): use an MPI library built with thread support");
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &world_.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &world_.size);
  if (world_.size > 1) MPI_Comm_dup(MPI_COMM_WORLD, &meeting_);
  if (world_.size > 1) heartbeat_ = std::make_unique<Heartbeat>(MPI_COMM_WORLD);
}

MpiEnvironment::~MpiEnvironment() {
  heartbeat_.reset();
  if (meeting_ != MPI_COMM_NULL) MPI_Comm_free(&meeting_);
  MPI_Finalize();
  std::error_code ignored;
  if (!own_folder.empty()) std::filesystem::remove_all(own_folder, ignored);
}

std::optional<int> MpiEnvironment::smallest_of_all(int mine, double most_s) const {
  if (world_.size == 1) return mine;
  int smallest = mine, done = 0;
  MPI_Request request;
  MPI_Iallreduce(&mine, &smallest, 1, MPI_INT, MPI_MIN, meeting_, &request);
  const double end = 1e-9 * double(Clock::now_ns()) + most_s;
  while (done == 0 && 1e-9 * double(Clock::now_ns()) < end) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done != 0 ? std::optional(smallest) : std::nullopt;
}

void MpiEnvironment::abort(int code) const {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::abort();
}

}  // namespace spindrift::runtime
