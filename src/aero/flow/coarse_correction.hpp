// Block ILU of each tile with a coarse correction over all of them: unknowns of a group of cells move together (five numbers per group,
// a group being a tile or a piece of one), the groups' matrix is the sum of the blocks between them, and
//   z = Q v + ILU^-1 (v - A Q v),   Q v = P (P^T A P)^-1 P^T v
// (Nicolaides 1987; multiplicative as A-DEF1 in Tang, Nabben, Vuik & Erlangga 2009). What tiles cut from each other, ILU cannot see;
// this is what passes between them in one iteration. The groups' matrix is eliminated where there are few groups, on every process
// alike, so that bits do not depend on ranks; many are left to a cycle of multigrid, where they do.
// Turbulence unknowns stay with ILU. Made by make_preconditioner(); tested in tests/src/aero/flow/coarse_correction_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "src/aero/flow/preconditioner.hpp"

namespace spindrift::aero {

class CoarseCorrection final : public Preconditioner {
 public:
  explicit CoarseCorrection(const PreconditionerOptions& options);
  ~CoarseCorrection() override;
  void attach(GridStore& grid, std::span<FlowTile> tiles) override;
  void refresh(FlowTile& tile) override;
  void apply(const Piece& piece) override;
  bool has_common() const override { return true; }
  void gather(FlowTile& tile, const float* v) override;
  void refresh_common(MPI_Comm comm) override;
  void begin() override;
  void common(MPI_Comm comm) override;
  int groups() const;  ///< of all processes

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace spindrift::aero
