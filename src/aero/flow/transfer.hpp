// The flow of a coarser grid as the state of a finer one of the same blocks: what grid sequencing needs.
// Called by src/aero/coarse_start.cpp, src/run/flow_case.cpp and perf/air; tested in tests/src/aero/flow/transfer_test.cpp
// and tests/src/aero/coarse_start_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/communicator.hpp"

#include <functional>

#include "src/aero/flow/flow_solver.hpp"

namespace spindrift::aero {

/// Where the middle of a fine cell stands along an index of its block, in coarse cells from the block's first node.
using CellPlace = std::function<double(int block, int direction, int cell)>;

/// Linear along each index of a block, by cells' middles in units of cells; beyond the outermost middles the line goes on (at a
/// wall a linear layer stays one), but no turbulence unknown falls below a quarter of its neighbour. Both may be
/// spread over the ranks of `comm`; blocks correspond by number, cells by `place` or, without it, by their share of the block.
/// `to` forgets its past. Collective.
void transfer(const FlowSolver& from, FlowSolver& to, const CellPlace& place = {}, MPI_Comm comm = MPI_COMM_SELF);

/// The same for a march on a coarser grid that is over; throws NumericalFailure where it has failed.
void begin_with(const FlowSolver& coarse, FlowSolver& fine, const CellPlace& place = {}, MPI_Comm comm = MPI_COMM_SELF);

}  // namespace spindrift::aero
