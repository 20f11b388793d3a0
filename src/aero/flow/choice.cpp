// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/executor/executor.hpp"
#include "src/aero/flow/coarse_correction.hpp"

namespace spindrift::aero {

namespace {

/// CFL number of trials: what a steady march reaches after some ten steps; unsteady ones have the rate of their step besides.
constexpr double trial_cfl = 200.0;

std::string one_line(const char* format, const char* name, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, name, a, b);
  return text;
}

}  // namespace

double cost_of(const Trial& t, const CostModel& m, long cells, int groups, bool eliminated) {
  if (t.preconditioner == "block_ilu") return m.ilu_iteration * t.needed;
  const double per_group = eliminated ? 0.0 : m.multigrid_setup + m.multigrid_iteration * t.needed;
  return m.coarse_setup + m.coarse_iteration * t.needed + per_group * double(groups) / double(cells);
}

Choice choose_preconditioner(FlowSolver& solver, MPI_Comm comm, int threads) {
  Choice choice;
  // A grid that is about to move: faces sweep what they swept on the way to where they were put. The first step overwrites this.
  for (FlowTile& tile : solver.tiles())
    if (tile.geometry->moving() && solver.setting().time_order > 0)
      update_speeds(*tile.geometry, bdf1, solver.setting().dt, solver.grid().tiling().planar);
  for (const char* name : {"block_ilu", "coarse"}) {
    FlowSetting s = solver.setting();
    s.preconditioner = name;
    if (s.time_order > 0) s.held_rate = backward_difference(s.time_order).now / s.dt;
    s.time_order = 0, s.time_tolerance.reset();
    s.march.cfl_start = s.march.cfl_max = std::min(s.march.cfl_max, trial_cfl);
    s.march.max_steps = 1, s.march.drop = 0.0, s.march.absolute = 0.0, s.march.matrix_free_below = 0.0;
    FlowSolver trial(solver.grid(), s, solver.judgement().conditions());
    const int groups = s.preconditioner == "coarse" ? coarse_groups(solver.grid().tiling(), s.coarse.group_cells) : 0;
    trial.start_from(solver);
    runtime::Graph graph(comm);
    trial.record(graph);
    runtime::Executor(std::move(graph), {.threads = threads}).run();
    Trial t{.preconditioner = name, .iterations = trial.march().last.krylov, .drop = trial.march().last.linear_drop};
    const double wanted = s.march.krylov_drop;
    t.needed = t.drop <= wanted ? t.iterations : t.drop < 1.0 ? t.iterations * std::log(wanted) / std::log(t.drop) : 1e6;
    t.cost = cost_of(t, {}, solver.cells(), groups, groups <= s.coarse.direct_groups);
    choice.trials.push_back(t);
  }
  const auto best = std::ranges::min_element(choice.trials, {}, &Trial::cost);  // equal ones: the first
  choice.preconditioner = best->preconditioner;
  for (const Trial& t : choice.trials)
    choice.reason += (choice.reason.empty() ? "" : "; ") +
                     one_line("%s: %.0f iterations, %.2f us per cell by the model", t.preconditioner.c_str(), t.needed, t.cost);
  return choice;
}

}  // namespace spindrift::aero
