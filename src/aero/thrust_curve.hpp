// Thrust and torque from the wind that the hub meets: the analytic law (area times relative wind squared), a turbine's operating
// table against wind, or coefficients against tip-speed ratio and blade pitch.
// Used by rotor_loads.cpp; tested in tests/src/aero/thrust_curve_test.cpp. Equations: docs/theory/rotor_engineering.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/options.hpp"
#include "src/aero/prescribed.hpp"

namespace spindrift::aero {

/// C_T = T / (rho A U^2 / 2), C_Q = Q / (rho A R U^2 / 2), of the wind U along the axis relative to the hub.
struct Coefficients {
  double thrust = 0.0, torque = 0.0;
};

class ThrustCurve {
 public:
  /// Throws scene::SceneError where the curve cannot be read. The rotor's diameter must be given.
  ThrustCurve(const AeroOptions& aero, const RotorOptions& rotor, double air_density_kg_m3);

  /// Of relative wind U [m/s] (negative: from behind), rotor speed [rad/s], blade pitch [rad]. Odd in U at given coefficients.
  AxialLoad operator()(double wind, double speed, double blade_pitch) const;
  /// Beyond the table its edge holds, so that loads go on as U^2.
  Coefficients coefficients(double wind, double speed, double blade_pitch) const;

 private:
  void read_against_wind(const AeroOptions& aero);
  void read_against_tip_speed(const AeroOptions& aero);

  double radius_, pressure_area_;  ///< R [m], rho A / 2 [kg/m]
  Coefficients constant_;
  // One of two tables; the wind's where tip_speed_ratio_ is empty. Slopes are empty for linear interpolation.
  std::vector<double> wind_, ct_, cq_, ct_slope_, cq_slope_;
  std::vector<double> tip_speed_ratio_, pitch_;  ///< nodes of a grid of ct_, cq_, tip-speed ratio fastest; pitch [rad]
};

/// Blade pitches of a curve over tip-speed ratio [rad], zero where it says none; empty for one against wind.
std::vector<double> pitches_of(const std::string& curve);

}  // namespace spindrift::aero
