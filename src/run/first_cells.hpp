// First cells at the walls of a flow that has been computed, of all ranks. Called by flow_simulation.cpp; tested in
// tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/mpi/environment.hpp"
#include "src/aero/first_cells.hpp"
#include "src/aero/flow/flow_solver.hpp"

namespace spindrift::run {

/// Of a flow with a turbulence model, as its last residual left it; else none. Collective.
aero::FirstCells first_cells(const aero::FlowSolver& solver, const runtime::World& world);

/// Why loads are wrong, whatever the residual: over most of the resolved walls one cell bridges the buffer layer (y+ above
/// 30), which leaves a fraction of the friction. Empty where they may be right.
std::string unresolved_walls(const aero::FirstCells& cells);

}  // namespace spindrift::run
