// What approximates the inverse of a pseudo-step's matrix, behind one interface: by tile (block ILU, block-Jacobi, none), from
// each tile's own tasks; or for all tiles of a process at once, from tasks that all ranks run together (a multigrid library, a
// coarse correction). The Krylov cycle knows nothing else of it. Called by the tasks of src/aero/flow; tested in
// tests/src/aero/flow/linear_solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "runtime/graph/graph.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

class Preconditioner {
 public:
  /// z = M^-1 v in one tile, both [cell][5] then [cell][turbulence], scaled as rows and unknowns are (sweep_jacobian.hpp).
  struct Piece {
    FlowTile* tile;
    const float* v;
    float* z;  ///< may be v
  };

  virtual ~Preconditioner() = default;
  /// True: refresh() and apply() get one tile at a time, tiles in any order and beside each other, without a communicator.
  /// False: all tiles of the process in the order of the tiling, in one task at a time that every rank runs as often, with a
  /// communicator.
  virtual bool by_tile() const { return true; }
  /// The blocks of these tiles were filled anew. A singular pivot throws, naming tile and cell.
  virtual void refresh(std::span<FlowTile* const> tiles, MPI_Comm comm) = 0;
  virtual void apply(std::span<const Piece> pieces, MPI_Comm comm) = 0;
};

/// By the name in the scene: block_ilu, block_jacobi, identity.
std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name);

}  // namespace spindrift::aero
