// Block ILU of each tile with a coarse correction over all of them: unknowns of a group of cells move together (five numbers per
// group, a group being a tile or a piece of one), the groups' matrix is the sum of the blocks between them, and
//   z = Q v + ILU^-1 (v - A Q v),   Q v = P (P^T A P)^-1 P^T v
// (Nicolaides 1987; multiplicative as A-DEF1 in Tang, Nabben, Vuik & Erlangga 2009). ILU by tile has no
// coupling across tiles; the groups carry it in one iteration. Their matrix is eliminated where there are few groups, on every
// process alike, so that bits do not depend on ranks; many are left to a cycle of multigrid, where they do. Turbulence unknowns
// stay with ILU. Called by make_preconditioner() and choice.cpp; tested in tests/src/aero/flow/coarse_correction_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "src/aero/flow/preconditioner.hpp"

namespace spindrift::aero {

std::unique_ptr<Preconditioner> make_coarse_correction(const PreconditionerOptions& options);

/// Groups of all tiles together, where a group has `group_cells` cells a side at most.
int coarse_groups(const Tiling& tiling, int group_cells);
/// The least longest side of a group, from `group_cells` on by doubling and then 0, with at most so many groups; nothing where
/// there are more tiles.
std::optional<int> side_of_groups(const Tiling& tiling, int group_cells, int most_groups);

}  // namespace spindrift::aero
