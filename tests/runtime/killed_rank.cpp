// Three ranks in a loop of reductions; rank 1 dies as if killed by the system. Run by tests/runtime/killed_rank.
// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/environment.hpp"

using namespace spindrift::runtime;

int main(int argc, char** argv) {
  const MpiEnvironment mpi(argc, argv);
  std::vector<double> partial = {1.0};
  double result = 0;
  Graph g(MPI_COMM_WORLD);
  const Datum x = g.datum(), sum = g.datum();
  g.task("aero/step", {reads(sum), updates(x)}, [&](const Context& c) {
    if (mpi.rank() == 1 && c.iteration == 100) std::raise(SIGKILL);
  });
  g.reduce("aero/norm", {reads(x), writes(sum)}, {.partials = partial, .result = {&result, 1}});
  Executor(std::move(g), {.threads = 2}).run(1'000'000);
}
