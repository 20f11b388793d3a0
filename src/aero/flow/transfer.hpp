// The flow of a coarser grid as the state of a finer one of the same blocks: what grid sequencing needs.
// Called by src/aero/coarse_start.cpp, src/run/flow_case.cpp and perf/air; tested in tests/src/aero/flow/transfer_test.cpp
// and tests/src/aero/coarse_start_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/communicator.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/grid/index_map.hpp"

namespace spindrift::aero {

/// Where the middle of a fine cell stands along an index of its block, in coarse cells from the block's first node.
using CellPlace = std::function<double(int block, int direction, int cell)>;

/// Linear along each index of a block, by cells' middles in units of cells; beyond the outermost middles the line goes on (at a
/// wall a linear layer stays one), but no turbulence unknown falls below a quarter of its neighbour. Both may be
/// spread over the ranks of `comm`; blocks correspond by number, cells by `place` or, without it, by their share of the block.
/// `to` forgets its past. A rank asks for the coarse cells under its own fine tiles and holds no others; returns the bytes of
/// their states. Collective.
std::size_t transfer(const FlowSolver& from, FlowSolver& to, const CellPlace& place = {}, MPI_Comm comm = MPI_COMM_SELF);

struct WindowOfTile {
  int tile = 0;
  Box cells;  ///< in indices of the block
};
/// The coarse cells that the cells of these fine tiles lie between, by coarse tile, in order.
std::vector<WindowOfTile> cells_under(const Tiling& coarse, const Tiling& fine, std::span<const int> fine_tiles,
                                      const CellPlace& place = {});

/// The same for a march on a coarser grid that is over; throws NumericalFailure where it has failed.
void begin_with(const FlowSolver& coarse, FlowSolver& fine, const CellPlace& place = {}, MPI_Comm comm = MPI_COMM_SELF);

}  // namespace spindrift::aero
