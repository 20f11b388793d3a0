// Three ranks, of which rank 1 stands still while the others are in a call of MPI that cannot return: before there is any graph
// ("start"), inside a task ("task") or between two graphs ("between"). Run by tests/runtime/stuck_rank.
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string_view>

#include "runtime/executor/executor.hpp"
#include "runtime/executor/watchdog.hpp"
#include "runtime/mpi/environment.hpp"

using namespace spindrift::runtime;

int main(int argc, char** argv) {
  const MpiEnvironment mpi(argc, argv);
  const std::string_view where = argc > 1 ? argv[1] : "";
  const Watchdog watchdog(Watchdog::Of::process);
  const auto meet = [&] {
    if (mpi.rank() == 1) std::raise(SIGSTOP);
    MPI_Barrier(MPI_COMM_WORLD);
  };
  if (where == "start") {
    Watchdog::set_limit(2);
    meet();
  }
  Graph g(MPI_COMM_WORLD);
  const Datum x = g.datum();
  g.task("output/write", {updates(x)}, [&] {
    if (where == "task") meet();
  });
  Executor executor(std::move(g), {.threads = 2, .watchdog_s = 2});
  executor.run();
  meet();
}
