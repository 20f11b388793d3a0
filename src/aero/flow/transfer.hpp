// The flow of a coarser grid as the state of a finer one of the same blocks: what grid sequencing needs.
// Called by src/coupling/flow_run.cpp and perf/air; tested in tests/src/aero/flow/transfer_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/flow/flow_solver.hpp"

namespace spindrift::aero {

/// Linear along each index of a block, by cells' middles in units of cells; beyond the outermost middles the line goes on (at a
/// wall a linear layer stays one), but no turbulence unknown falls below a quarter of its neighbour. `from` must be whole on this
/// process, `to` may be a part; blocks correspond by number. `to` forgets its past.
void transfer(FlowSolver& from, FlowSolver& to);

}  // namespace spindrift::aero
