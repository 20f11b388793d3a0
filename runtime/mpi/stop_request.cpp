// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/stop_request.hpp"

#include <csignal>

namespace spindrift::runtime {

namespace {

volatile std::sig_atomic_t caught = 0;
constexpr int signals[] = {SIGTERM, SIGINT, SIGUSR1};
constexpr int wall_limit = 1000;  // beyond every signal number

extern "C" void note_signal(int signal) {
  if (caught == SIGINT && signal == SIGINT) {
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  caught = signal;
}

std::string reason(int cause) {
  switch (cause) {
    case 0:
      return "";
    case SIGTERM:
      return "stopped on request (SIGTERM)";
    case SIGINT:
      return "stopped on request (SIGINT)";
    case SIGUSR1:
      return "stopped on request (SIGUSR1)";
    default:
      return "the limit on wall time is reached (runtime.wall_limit_s)";
  }
}

}  // namespace

StopRequest::StopRequest(double wall_limit_s)
    : end_(std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(wall_limit_s))),
      limited_(wall_limit_s > 0.0) {
  caught = 0;
  for (int s : signals) std::signal(s, note_signal);
}

StopRequest::~StopRequest() {
  for (int s : signals) std::signal(s, SIG_DFL);
}

std::string StopRequest::agreed(MPI_Comm comm) const {
  int cause = caught != 0 ? int(caught) : limited_ && std::chrono::steady_clock::now() >= end_ ? wall_limit : 0;
  MPI_Allreduce(MPI_IN_PLACE, &cause, 1, MPI_INT, MPI_MAX, comm);
  return reason(cause);
}

}  // namespace spindrift::runtime
