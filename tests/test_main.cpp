// Entry of every test executable: Catch2 inside an initialised MPI, so that a test may run on one rank or, by mpirun, on many.
// SPDX-License-Identifier: Apache-2.0
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "runtime/mpi/environment.hpp"

int main(int argc, char** argv) {
  Catch::Session session;
  if (const int wrong = session.applyCommandLine(argc, argv)) return wrong;
  const Catch::ConfigData& asked = session.configData();
  if (asked.listTests || asked.listTestNamesOnly || asked.listTags) return session.run() > 255 ? 255 : 0;
  const spindrift::runtime::MpiEnvironment mpi(argc, argv);
  const int failures = session.run();
  int worst = failures;
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return worst > 255 ? 255 : worst;
}
