// What a round tower does to the wind round it: potential flow about a cylinder and the wake behind it, as AeroDyn's baseline
// (Moriarty & Hansen 2005, NREL/EL-500-36881, section on tower influence). Used by src/aero/tower.cpp; tested in
// tests/src/aero/tower_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"

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

/// The wake behind it, of a tower with this drag coefficient: wind lost over the undisturbed (Powles 1983, as AeroDyn has it).
/// Its loss of momentum is the tower's drag, but for what is left out because it takes half of the wind at most, as in AeroDyn
/// since 2022: near a tower of much drag more would flow backwards. Where the blades are before the tower it is nothing.
inline double tower_wake(double x, double y, double drag) {
  const double width = std::sqrt(std::sqrt(std::max(x * x + y * y, 1.0)));
  if (x <= 0.0 || std::abs(y) >= width) return 0.0;
  const double cosine = std::cos(0.5 * pi * y / width);
  constexpr double most = 0.5;
  return -std::min(drag / width * cosine * cosine, most);
}

}  // namespace spindrift
