// What a round tower does to the wind round it: potential flow about a cylinder, as AeroDyn's baseline (Moriarty & Hansen 2005,
// NREL/EL-500-36881, section on tower influence). Used by src/aero/tower.cpp; tested in tests/src/aero/tower_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace spindrift {

/// Added wind over the undisturbed, along it and across it.
struct TowerFlow {
  double along = 0.0, across = 0.0;
};

/// At (x, y) from the tower's axis in its radii, x downwind. Within the tower as on its surface.
inline TowerFlow tower_flow(double x, double y) {
  const double r2 = std::max(x * x + y * y, 1.0);
  return {(y * y - x * x) / (r2 * r2), -2.0 * x * y / (r2 * r2)};
}

}  // namespace spindrift
