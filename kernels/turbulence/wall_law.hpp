// The law of the wall as one formula from the wall through the logarithmic layer, and what it makes of a first cell that stands
// in it: Reichardt 1951, ZAMM 31, 208: u+ = ln(1 + .41 y+)/.41 + 7.8 (1 - exp(-y+/11) - y+/11 exp(-.33 y+)). Called by
// src/aero/flow (sweep_gradients, sweep_model_of) for walls with a wall function; tested in tests/kernels/turbulence/wall_law_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

/// Rate at which the law's shear makes turbulence per mass [m2/s3]: turbulent stress u^2 (1 - du+/dy+) times the velocity gradient.
inline double wall_law_production(double friction_velocity, double distance, double nu) {
  const double slope = wall_law_slope(friction_velocity * distance / nu), u2 = friction_velocity * friction_velocity;
  return u2 * u2 / nu * slope * std::max(1.0 - slope, 0.0);
}

/// omega [1/s] of k-omega models at a distance from the wall: 6 nu / (beta d^2) of the sublayer (Wilcox 1988) and
/// u / (sqrt(beta*) kappa d) of the logarithmic layer, the root of the sum of their squares between (Menter & Esch 2001).
inline double wall_omega(double friction_velocity, double distance, double nu, double beta) {
  const double sublayer = 6.0 * nu / (beta * distance * distance), log_layer = friction_velocity / (0.3 * 0.41 * distance);
  return std::sqrt(sublayer * sublayer + log_layer * log_layer);
}

/// The viscosity [Pa s] with which speed over distance is the law's friction; that of the fluid where the cell lies in the
/// sublayer.
inline double wall_viscosity(double speed, double distance, double rho, double mu) {
  if (!(speed > 0.0)) return mu;
  const double u = friction_velocity(speed, distance, mu / rho);
  return rho * u * u * distance / speed;
}

}  // namespace spindrift::turbulence
