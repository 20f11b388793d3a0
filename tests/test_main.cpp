// Entry of every test executable: Catch2 inside an initialised MPI, so that a test may run on one rank or, by mpirun, on many.
// SPDX-License-Identifier: Apache-2.0
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "runtime/mpi/environment.hpp"

int main(int argc, char** argv) {
  const spindrift::runtime::MpiEnvironment mpi(argc, argv);
  const int failures = Catch::Session().run(argc, argv);
  int worst = failures;
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return worst > 255 ? 255 : worst;
}
