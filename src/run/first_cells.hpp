// The distance of first cells from walls in units of the layer (y+), judged after a run. Called by flow_simulation.cpp; tested in
// tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/environment.hpp"
#include "src/aero/flow/flow_solver.hpp"

namespace spindrift::run {

/// Says where first cells stand in another part of the layer than their wall is made for: nine tenths of the walls' area by y+ of
/// their centres. Resolved walls want about 1, the law of the wall the logarithmic layer. Collective.
void tell_first_cells(const aero::FlowSolver& solver, const runtime::World& world);

}  // namespace spindrift::run
