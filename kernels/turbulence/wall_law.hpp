// The law of the wall as a table over the logarithm of the distance in wall units, and what it makes of a first cell that stands
// in it. Each closure has its own law, found by wall_layer.hpp: laws of other closures or of measurements stand up to 1 u_tau
// beside it, which is 8 % of the friction (docs/developer/notes/air.md). Called by src/aero/flow (sweep_gradients, sweep_viscous,
// sweep_model_of) for walls with a wall function; tested in tests/kernels/turbulence/wall_law_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace spindrift::turbulence {

/// In wall units: lengths over nu/u_tau, velocities over u_tau, k over u_tau^2, omega over u_tau^2/nu. Points at `lowest` exp(n
/// step).
struct WallLaw {
  static constexpr int points = 400;
  static constexpr double lowest = 0.05, highest = 1e4;
  std::array<double, points> velocity_at{}, rise_at{};  ///< u+ and y+ du+/dy+
  std::array<double, points> log_k{}, log_omega{};      ///< of two equations; else unused

  static double step() { return std::log(highest / lowest) / (points - 1); }
  static double place(int n) { return lowest * std::exp(n * step()); }

  /// Velocity along the wall: straight below the table, logarithmic above it.
  double velocity(double y) const {
    if (y <= lowest) return velocity_at[0] * y / lowest;
    const At a = at(y);
    if (a.n == points - 1) return velocity_at[points - 1] + rise_at[points - 1] * std::log(y / highest);
    const double s = a.share, h = step(), left = velocity_at[a.n], right = velocity_at[a.n + 1];
    return left + s * s * (3.0 - 2.0 * s) * (right - left) +
           s * (1.0 - s) * h * ((1.0 - s) * rise_at[a.n] - s * rise_at[a.n + 1]);
  }
  /// d u+ / d y+: that of velocity().
  double slope(double y) const {
    if (y <= lowest) return velocity_at[0] / lowest;
    const At a = at(y);
    if (a.n == points - 1) return rise_at[points - 1] / y;
    const double s = a.share, h = step();
    const double chord = (velocity_at[a.n + 1] - velocity_at[a.n]) / h;
    return (6.0 * s * (1.0 - s) * chord + (1.0 - s) * (1.0 - 3.0 * s) * rise_at[a.n] - s * (2.0 - 3.0 * s) * rise_at[a.n + 1]) /
           y;
  }
  /// k falls with the cube of the distance below the table, omega rises with its inverse square; above it k stays, omega goes as
  /// 1/y.
  double k(double y) const {
    if (y <= lowest) return std::exp(log_k[0]) * (y / lowest) * (y / lowest) * (y / lowest);
    return std::exp(between(log_k, at(y)));
  }
  double omega(double y) const {
    if (y <= lowest) return std::exp(log_omega[0]) * (lowest / y) * (lowest / y);
    return std::exp(between(log_omega, at(y))) * (y > highest ? highest / y : 1.0);
  }

 private:
  struct At {
    std::size_t n;
    double share;
  };
  static At at(double y) {
    if (y >= highest) return {points - 1, 0.0};
    const double t = std::log(y / lowest) / step();
    const auto n = std::size_t(t) < std::size_t(points - 2) ? std::size_t(t) : std::size_t(points - 2);
    return {n, t - double(n)};
  }
  static double between(const std::array<double, points>& of, const At& a) {
    return a.n == points - 1 ? of[a.n] : of[a.n] + a.share * (of[a.n + 1] - of[a.n]);
  }
};

/// Friction velocity [m/s] where the fluid moves with `speed` [m/s] along the wall at a distance [m]; nu [m2/s]. The root of
/// y+ u+(y+) = speed distance / nu by Newton steps in logarithms, where the slope lies between 1 and 2: any start
/// converges.
inline double friction_velocity(const WallLaw& law, double speed, double distance, double nu) {
  if (!(speed > 0.0)) return 0.0;
  const double reynolds = speed * distance / nu;
  double y_plus = std::sqrt(reynolds);
  for (int n = 0; n < 30; ++n) {
    const double u = law.velocity(y_plus), step = std::log(y_plus * u / reynolds) / (1.0 + y_plus * law.slope(y_plus) / u);
    y_plus *= std::exp(-step);
    if (std::abs(step) < 1e-14) break;
  }
  return y_plus * nu / distance;
}

/// Velocity gradient [1/s] of the law at the distance where the fluid moves with `speed`.
inline double wall_law_rate(const WallLaw& law, double speed, double distance, double nu) {
  const double u = friction_velocity(law, speed, distance, nu);
  return u * u / nu * law.slope(u * distance / nu);
}

/// The viscosity [Pa s] with which speed over distance is the law's friction; that of the fluid where the cell lies in the
/// sublayer.
inline double wall_viscosity(const WallLaw& law, double speed, double distance, double rho, double mu) {
  if (!(speed > 0.0)) return mu;
  const double u = friction_velocity(law, speed, distance, mu / rho);
  return rho * u * u * distance / speed;
}

}  // namespace spindrift::turbulence
