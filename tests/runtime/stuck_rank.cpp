// Three ranks, of which rank 1 stands still while the others are in a call of MPI that cannot return: inside a task ("task") or
// between two graphs ("between"). Run by tests/runtime/stuck_rank.
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string_view>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/environment.hpp"

using namespace spindrift::runtime;

int main(int argc, char** argv) {
  const MpiEnvironment mpi(argc, argv);
  const bool inside = argc > 1 && std::string_view(argv[1]) == "task";
  const auto meet = [&] {
    if (mpi.rank() == 1) std::raise(SIGSTOP);
    MPI_Barrier(MPI_COMM_WORLD);
  };
  Graph g(MPI_COMM_WORLD);
  const Datum x = g.datum();
  g.task("output/write", {updates(x)}, [&] {
    if (inside) meet();
  });
  Executor executor(std::move(g), {.threads = 2, .watchdog_s = 2});
  executor.run();
  meet();
}
