// Tiles of the air change ranks: weighed by the time that their tasks took, dealt out anew where ranks are out of balance, and
// sent with their state. Times touch no result, as no rank is known to one; where one is (FlowSolver::knows_ranks) tiles must
// stay. Used by src/coupling/air_march.cpp; tested in tests/src/aero/tile_balance_test.cpp and
// tests/coupled/air_balance_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "src/aero/flow/flow_restart.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// Ranks of all tiles by their cells: where nothing is measured yet.
std::vector<int> ranks_by_cells(const Tiling& tiling, int ranks);

/// Of each owned tile: what its tasks took in these executors so far, all threads together [s].
std::vector<double> seconds_of_tiles(const GridStore& store, std::span<const runtime::Executor* const> executors);

/// What this rank knows of a move.
struct MoveTerms {
  double move_s = 0.0;  ///< that it takes
  double ahead = 0.0;   ///< times what was measured is still to come
  int threads = 1;
};

/// Other ranks for the tiles of all ranks.
struct TileMove {
  std::vector<int> rank_of_tile;
  double before = 1.0, after = 1.0;  ///< measured cost of the most loaded rank over the mean: as it was, as it is to be
};

/// A move that is worth it: the imbalance is above `above`, falls by a tenth, and what is gained by it exceeds what it takes.
/// `seconds`: of the owned tiles. Collective, and the same on all ranks.
std::optional<TileMove> better_ranks(const GridStore& store, std::span<const double> seconds, const MoveTerms& terms,
                                     MPI_Comm comm, double above = 1.2);

/// A solver's snapshot on this rank, which has had the tiles `owned`, becomes that of the tiles which are its own from now on, to
/// be restored by another solver. Collective.
FlowSnapshot send_tiles(FlowSnapshot mine, std::span<const int> owned, std::span<const int> rank_of_tile, MPI_Comm comm);

}  // namespace spindrift::aero
