// The balance of the mass of the air: what comes in and goes out through open boundaries, what its cells gain, and what the march
// has left of the sum. Fluxes are those of the convective sweep itself, so that the four close to round-off. Called by
// judgement.cpp (partials of a tile, summed over all); tested in tests/src/aero/flow/mass_balance_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/state.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow/physical_time.hpp"

namespace spindrift::aero {

/// [kg/s]. growth + outflow - inflow = residual, but for round-off.
struct MassBalance {
  double inflow = 0.0, outflow = 0.0;  ///< through boundaries, relative to faces that may move; neither is negative
  double growth = 0.0;                 ///< by the time scheme; 0 in steady flow
  double residual = 0.0;               ///< of all cells: what the pseudo-steps left
};
inline constexpr int mass_components = 4;

/// Makes room for the mass fluxes through the sides of a tile that have boundaries other than walls.
void set_through_faces(FlowTile& tile);
/// Of one tile. @pre residual and `through` are those of its state
MassBalance mass_balance(const FlowTile& tile, const gas::IdealGas& gas, const PhysicalTime& time);

}  // namespace spindrift::aero
