// What first cells at the walls of a flow say that has been computed; the first rank alone has those of all ranks. Called by
// src/run/flow_simulation.cpp, and beside bodies by air_march.cpp; tested in tests/coupled/flow_run_test.py and
// coupled_system_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// Where the scene asks for more cells in the boundary layer of its walls.
std::string more_layers(const Scenario& scenario);

/// Why loads are wrong, whatever the residual: over most of the resolved walls one cell bridges the buffer layer (y+ above
/// 30), or, without a rotor, cells grow by more than aero::useless_growth from layer to layer. Empty where they may be right. The
/// same on all ranks. Collective.
std::string unresolved_walls(const aero::FlowSolver& solver, const Scenario& scenario, const runtime::World& world);

/// aero::doubts_of them, on the first rank; none on others. Collective.
std::vector<std::string> doubts_of_walls(const aero::FlowSolver& solver, const Scenario& scenario, const runtime::World& world);

}  // namespace spindrift::coupling
