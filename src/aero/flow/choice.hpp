// preconditioner = "auto": one linear system of the flow as it starts is solved with each candidate, and that with the least cost
// by a stated model of iterations is taken. No clock decides, so that any number of threads, ranks and another day choose alike.
// Called by src/run and src/coupling (air_march.cpp); tested in tests/src/aero/flow/choice_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"

namespace spindrift::aero {

/// What a pseudo-step's solution costs beside residual and matrix, in microseconds of one core per cell: measured by perf/air_amg
/// on one core of 101 GFLOP/s (docs/developer/notes/air_linear.md); only ratios matter.
struct CostModel {
  double ilu_iteration = 0.36;
  double coarse_setup = 0.5, coarse_iteration = 0.45;
  double multigrid_setup = 160.0, multigrid_iteration = 5.0;  ///< more, per group, where groups are left to multigrid
};

struct Trial {
  std::string preconditioner;
  int iterations = 0;   ///< made
  double drop = 1.0;    ///< of the linear residual, reached
  double needed = 0.0;  ///< iterations for the drop asked for: beyond those made by their mean rate
  double cost = 0.0;    ///< by the model [us per cell]
};
double cost_of(const Trial& trial, const CostModel& model, long cells, int groups, bool eliminated);

struct Choice {
  std::string preconditioner, reason;
  std::vector<Trial> trials;
};
/// From the state of a solver that has started (on a moving grid: been placed) and whose ghost geometry is filled. Collective.
/// Each trial needs the memory of another solver while it lasts.
Choice choose_preconditioner(FlowSolver& solver, MPI_Comm comm, int threads = 0);

}  // namespace spindrift::aero
