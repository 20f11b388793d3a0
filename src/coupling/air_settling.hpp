// How air settles before the first window (start.air_steps): a steady march, a piece of its steps at a time, saved in the run's
// folder meanwhile and made again from a smaller CFL number where it fails. Called by air_march.cpp; tested in
// tests/coupled/settling_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/settling_file.hpp"

namespace spindrift::coupling {

/// A steady march to settle by.
struct SteadyMarch {
  aero::FlowSolver& solver;
  std::function<void()> run;                             ///< makes a piece of it
  std::function<double(const aero::PseudoRow&)> thrust;  ///< [N] of a row
};

/// Until `steps` are made; a line of progress every few seconds. Throws NumericalFailure where it fails, runtime::StopAsked.
/// `file`: where it is saved between pieces, and goes on from; `retry`: those after the first are not saved, they begin anew.
void settle(const SteadyMarch& march, int steps, int retry, std::optional<SettlingFile> file, const runtime::World& world,
            std::vector<std::string>& log_lines);
/// Pseudo-steps of a piece, by the size of the grid alone, as the bits go by it.
int settling_piece(double cells, int steps);

/// What attempt(retry) comes to, tried again where it fails.
aero::TileStates settled(const std::function<aero::TileStates(int retry)>& attempt);

}  // namespace spindrift::coupling
