// What approximates the inverse of a pseudo-step's matrix, behind one interface: by tile (block ILU, block-Jacobi, none), from
// each tile's own tasks; and, where it has one, a coarse level of all tiles and processes (coarse correction, multigrid) between
// two tasks of each tile. The Krylov cycle knows nothing else of it. Called by the tasks of src/aero/flow; tested in
// tests/src/aero/flow/linear_solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "runtime/graph/graph.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

/// Of the preconditioners with a coarse level.
struct PreconditionerOptions {
  int group_cells = 8;      ///< coarse correction: longest side of a group of cells; 0: a group is a tile
  int direct_groups = 512;  ///< up to so many groups are solved by elimination, more by multigrid
  int common_every = 1;  ///< refreshes of the matrix within a physical step (or march) that one set-up of the coarse level serves
  int common_steps = 1;  ///< physical steps whose first matrices one set-up serves: made anew at steps 0, n, 2n, ...
};

class Preconditioner {
 public:
  /// z = M^-1 v in one tile, both [cell][5] then [cell][turbulence], scaled as rows and unknowns are (sweep_jacobian.hpp).
  struct Piece {
    FlowTile* tile;
    const float* v;
    float* z;  ///< may be v
  };

  virtual ~Preconditioner() = default;
  /// Once, before all else: the grid and the tiles of this process.
  virtual void attach(GridStore&, std::span<FlowTile>) {}
  /// The blocks of this tile were filled anew. Returns the cell whose pivot is singular, or -1. Tiles come in any order and
  /// beside each other, here as in gather() and apply().
  virtual std::ptrdiff_t refresh(FlowTile& tile) = 0;
  virtual void apply(const Piece& piece) = 0;

  /// Whether there is a coarse level. If so: refresh() of all tiles, then refresh_coarse_level(); gather() of all,
  /// solve_coarse_level(), apply() of all.
  virtual bool has_coarse_level() const { return false; }
  /// What the coarse level needs of v.
  virtual void gather(FlowTile&, const float*) {}
  /// A march begins, or this physical step: of what came before nothing may be used but what save_kept() saves, so that a restart
  /// has the same bits.
  virtual void begin(std::int64_t /*step*/) {}
  /// Tasks that all ranks run together, as often, one at a time in a process.
  virtual void refresh_coarse_level(MPI_Comm) {}
  virtual void solve_coarse_level(MPI_Comm) {}
  /// Whether the last bits depend on which rank has which tile; once attached.
  virtual bool knows_ranks() const { return false; }
  /// Whether the coarse level had no solution since it was last made anew: what apply() gives is of no use then.
  virtual bool singular() const { return false; }

  // A set-up that outlives a physical step: what it was made of in each tile goes into snapshots and checkpoints; the same set-up
  // is made of it again when it is next needed.
  virtual std::size_t kept_size(const FlowTile&) const { return 0; }
  virtual void save_kept(const FlowTile&, std::span<double>) const {}
  /// Of all tiles, one after the other.
  virtual void load_kept(FlowTile&, std::span<const double>) {}
  /// Of the set-up that would be saved now; no other of this object has had it.
  virtual std::uint64_t kept_number() const { return 0; }
  /// What was loaded is that one; 0: of another object.
  virtual void set_kept_number(std::uint64_t) {}
};

/// By the name in the scene: block_ilu, block_jacobi, identity, coarse.
std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name, const PreconditionerOptions& options = {});
/// The parts by tile alone: block_ilu, block_jacobi, identity.
std::unique_ptr<Preconditioner> make_tile_preconditioner(std::string_view name);

}  // namespace spindrift::aero
