// Gradients in the cells of a tile by Green-Gauss over its faces, the value on a face being the mean of both sides: of velocity,
// temperature and what the turbulence model carries. Ghost gradients: mirror images behind walls and planes of symmetry (so that
// on a no-slip wall nothing varies along it, on a plane of symmetry no shear remains), those of the cell inside behind open
// boundaries. Called by the tasks of src/aero/flow; tested in tests/verification/air/manufactured_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/state.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

/// Of u, v, w, T and the turbulence unknowns, component 3 n + direction; then the closures of the model (sweep_model.hpp).
constexpr int gradient_components(int turbulence, bool eddies) { return 3 * (4 + turbulence) + (eddies ? 2 + turbulence : 0); }

/// Distance of the cell's centre from the wall that its face on this side is part of [m]: that of the nearest wall, but in a
/// corner, where several faces of the cell stick, that of the face's plane.
double distance_to_wall(const FlowTile& tile, Side side, int k, int j, int i);

/// The first cell of a wall with a wall function: velocity along the wall relative to it, distance, density and viscosity.
struct WallCell {
  double u, v, w, speed, distance, rho, mu;
};
WallCell wall_cell(const FlowTile& tile, const double* state, const gas::IdealGas& gas, Side side, int k, int j, int i);

void sweep_gradients(FlowTile& tile, const double* state);
/// In the first cells of walls with a wall function: how fast the velocity along the wall rises is what the law of the wall says
/// of the cell's own velocity. A difference over the cell would be three to four times that, and as much production of
/// turbulence.
void set_wall_law_gradients(FlowTile& tile, const double* state, const gas::IdealGas& gas);
/// `wall_spread`: diffusivity of the turbulence unknowns on a no-slip wall over the laminar viscosity.
void fill_boundary_gradients(FlowTile& tile, const double* state, const gas::IdealGas& gas,
                             const std::array<double, 2>& wall_spread);

}  // namespace spindrift::aero
