// The convective part of a tile's residual: MUSCL states, the flux scheme, and what the turbulence model's unknowns are carried
// by the mass flux; rows of eight cells. Faces of walls are left out (FlowTile::open): boundary.cpp adds their pressure. Limiters
// and schemes are functions over a piece of a row, put together when the solver is made: their sum and not their product is
// compiled, and the states between them stay in the first cache. docs/theory/air.md, "Convection".
// Tested in tests/src/aero/flow/solver_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

inline constexpr int piece = 64;  ///< faces of a row that go through reconstruction and flux together

/// States on both sides of the faces of a piece: p u v w T, then what turbulence carries.
struct FacePiece {
  alignas(64) double left[mean_unknowns + 2][piece], right[mean_unknowns + 2][piece];
};

/// Fills `states` for `count` faces; the cell right of the first face is at `at`, left of it one `step` back; its volume is at
/// `volume`, in steps of `volume_step`.
using Reconstruction = void (*)(const gas::IdealGas& gas, const double* at, std::ptrdiff_t step, std::ptrdiff_t component,
                                const double* volume, std::ptrdiff_t volume_step, int turbulence, int count, FacePiece& states);
/// Flux through `count` faces from (k, j, i) on: component c of face n at out[c stride + n].
using RowFlux = void (*)(const gas::IdealGas& gas, const TileGeometry& geometry, int direction, int k, int j, int i, int count,
                         const FacePiece& states, double* out, std::ptrdiff_t stride);

/// Along a wall's surface the velocity of unlimited states goes by indices: cells are packed at edges and noses, where the flow
/// along the wall turns within few of them.
struct Reconstructions {
  Reconstruction plain = nullptr, along_wall = nullptr;
};

/// By the names of the scene's choices.
Reconstructions reconstructions(std::string_view limiter);
RowFlux row_flux(std::string_view flux);

struct ConvectiveSetting {
  gas::IdealGas gas;
  Reconstructions reconstruct;
  RowFlux flux = nullptr;
  bool first_order_model = false;  ///< what turbulence carries by its upwind cell, unreconstructed
  double law_slope =
      0.5;  ///< of a first cell at a wall with a wall function: what of the difference ahead is its state at the face
  double upwinding = 1.0;  ///< share of the jump between both states in the flux
};

/// residual = sum of fluxes out of each cell [in the units of conserved amounts per second].
void sweep_convective(FlowTile& tile, const double* state, double* residual, const ConvectiveSetting& setting);

}  // namespace spindrift::aero
