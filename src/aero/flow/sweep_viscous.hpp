// The diffusive part of a tile's residual: stresses and heat flux, diffusion and sources of the turbulence model.
// Full gradients (cell gradients, corrected along the line of centres) or thin layer. docs/theory/air.md, "Viscous terms".
// Called by the tasks of src/aero/flow; tested in tests/verification/air/manufactured_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

struct ViscousSetting {
  gas::IdealGas gas;
  bool active = false;  ///< viscous at all
  bool thin_layer = false;
};

/// residual += diffusive fluxes out of each cell; needs gradients with ghosts.
void sweep_viscous(FlowTile& tile, const double* state, double* residual, const ViscousSetting& setting);

/// Stress of the flow on a wall face times its area [N], `f` pointing out of the flow.
gas::Conserved<double> wall_friction(const FlowTile& tile, const double* state, const ViscousSetting& setting, Side side, int k,
                                     int j, int i);

}  // namespace spindrift::aero
