// The parts of the benchmark group `runtime`. Called by main.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "perf/harness.hpp"

namespace spindrift::perf {

void stencils(Group& group);     ///< overhead per task, METG and loss of our runtime; its peers: omp.cpp, tbb.cpp, mpi.cpp
void two_physics(Group& group);  ///< coupled window against each part alone
void recording(Group& group);    ///< recording, a million tasks

}  // namespace spindrift::perf
