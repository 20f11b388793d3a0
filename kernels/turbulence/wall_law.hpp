// The law of the wall as one formula from the wall through the logarithmic layer, and what it makes of a first cell that stands
// in it: Reichardt 1951, ZAMM 31, 208: u+ = ln(1 + .41 y+)/.41 + 7.8 (1 - exp(-y+/11) - y+/11 exp(-.33 y+)). Called by
// src/aero/flow/sweep_gradients.cpp for walls with a wall function; tested in tests/kernels/turbulence/wall_law_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace spindrift::turbulence {

/// Velocity along the wall over the friction velocity, from the distance in wall units.
inline double wall_law(double y_plus) {
  return std::log1p(0.41 * y_plus) / 0.41 + 7.8 * (1.0 - std::exp(-y_plus / 11.0) - y_plus / 11.0 * std::exp(-0.33 * y_plus));
}

/// Its slope, d u+ / d y+: 1 at the wall, 1 / (.41 y+) far from it.
inline double wall_law_slope(double y_plus) {
  const double fast = std::exp(-0.33 * y_plus);
  return 1.0 / (1.0 + 0.41 * y_plus) + 7.8 / 11.0 * (std::exp(-y_plus / 11.0) - (1.0 - 0.33 * y_plus) * fast);
}

/// Friction velocity [m/s] where the fluid moves with `speed` [m/s] along the wall at a distance [m]; nu [m2/s]. The root of
/// y+ wall_law(y+) = speed distance / nu by Newton steps in logarithms, where the slope lies between 1 and 2: any start
/// converges.
inline double friction_velocity(double speed, double distance, double nu) {
  if (!(speed > 0.0)) return 0.0;
  const double reynolds = speed * distance / nu;
  double y_plus = std::sqrt(reynolds);
  for (int n = 0; n < 30; ++n) {
    const double law = wall_law(y_plus), step = std::log(y_plus * law / reynolds) / (1.0 + y_plus * wall_law_slope(y_plus) / law);
    y_plus *= std::exp(-step);
    if (std::abs(step) < 1e-14) break;
  }
  return y_plus * nu / distance;
}

/// Velocity gradient [1/s] of the law at the distance where the fluid moves with `speed`.
inline double wall_law_rate(double speed, double distance, double nu) {
  const double u = friction_velocity(speed, distance, nu);
  return u * u / nu * wall_law_slope(u * distance / nu);
}

/// The viscosity [Pa s] with which speed over distance is the law's friction; that of the fluid where the cell lies in the
/// sublayer.
inline double wall_viscosity(double speed, double distance, double rho, double mu) {
  if (!(speed > 0.0)) return mu;
  const double u = friction_velocity(speed, distance, mu / rho);
  return rho * u * u * distance / speed;
}

}  // namespace spindrift::turbulence
