// What the asynchronous runtime costs and gains: see docs/developer/runtime.md for the meaning of each figure.
// Run by perf/run runtime. Two threads whatever OMP_NUM_THREADS says: the bars are for two.
// SPDX-License-Identifier: Apache-2.0
#include "perf/runtime/groups.hpp"

int main(int argc, char** argv) {
  spindrift::perf::Group group("runtime", argc, argv);
  spindrift::perf::stencils(group);
  spindrift::perf::two_physics(group);
  spindrift::perf::recording(group);
}
