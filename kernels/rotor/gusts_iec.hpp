// The deterministic wind events of IEC 61400-1 ed. 3 (2005), 6.3.1.3 and 6.3.2: turbulence by the normal model, operating gust
// (EOG), coherent gust with change of direction (ECD), change of direction (EDC), wind shear (EWS). Time counts from the event's
// start; before and after it nothing is added, but for the ECD and EDC, which stay at their end. Used by src/aero/wind.cpp;
// tested in tests/kernels/rotor/gusts_iec_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::iec {

/// What the events need of site and turbine.
struct Site {
  double hub_wind = 10.0;             ///< mean wind at the hub [m/s]
  double hub_height = 90.0;           ///< [m]
  double diameter = 126.0;            ///< of the rotor [m]
  double reference_wind = 50.0;       ///< V_ref of the class: 50, 42.5, 37.5 [m/s]
  double reference_intensity = 0.16;  ///< I_ref of the class: .16, .14, .12 [-]
};

/// Normal turbulence model: standard deviation along the wind [m/s] (eq. 11).
inline double sigma_normal(double hub_wind, double intensity) { return intensity * (0.75 * hub_wind + 5.6); }
/// Extreme turbulence model, c = 2 m/s (eq. 19); `average_wind` of a year, .2 V_ref.
inline double sigma_extreme(double hub_wind, double intensity, double average_wind) {
  constexpr double c = 2.0;
  return c * intensity * (0.072 * (average_wind / c + 3.0) * (hub_wind / c - 4.0) + 10.0);
}
/// Longitudinal turbulence scale parameter at the hub [m] (eq. 5).
inline double scale_parameter(double hub_height) { return hub_height <= 60.0 ? 0.7 * hub_height : 42.0; }

/// sigma / (1 + 0.1 D / Lambda): the turbulence averaged over a rotor of this size [m/s].
inline double sigma_over_rotor(const Site& s) {
  return sigma_normal(s.hub_wind, s.reference_intensity) / (1.0 + 0.1 * s.diameter / scale_parameter(s.hub_height));
}

inline constexpr double eog_period = 10.5, ecd_period = 10.0, edc_period = 6.0, ews_period = 12.0;  // [s]

/// Height of the extreme operating gust [m/s] (eq. 17), with V_e1 = .8 * 1.4 V_ref at the hub (eqs. 14, 15).
inline double eog_height(const Site& s) {
  return std::min(1.35 * (0.8 * 1.4 * s.reference_wind - s.hub_wind), 3.3 * sigma_over_rotor(s));
}
/// Added to the wind [m/s] (eq. 18).
inline double eog(const Site& s, double t) {
  if (t <= 0.0 || t >= eog_period) return 0.0;
  return -0.37 * eog_height(s) * std::sin(3.0 * pi * t / eog_period) * (1.0 - std::cos(2.0 * pi * t / eog_period));
}

/// From 0 to 1 in half a cosine.
inline double half_cosine(double t, double period) {
  return t <= 0.0 ? 0.0 : t >= period ? 1.0 : 0.5 * (1.0 - std::cos(pi * t / period));
}

/// Extreme coherent gust: added speed [m/s] (eq. 23) and direction [rad] (eqs. 24, 25), V_cg = 15 m/s.
inline double ecd_speed(double t) { return 15.0 * half_cosine(t, ecd_period); }
inline double ecd_direction(const Site& s, double t) {
  return radians_per_degree * (s.hub_wind < 4.0 ? 180.0 : 720.0 / s.hub_wind) * half_cosine(t, ecd_period);
}

/// Extreme change of direction [rad] (eqs. 20, 21).
inline double edc_direction(const Site& s, double t) {
  return 4.0 * std::atan(sigma_over_rotor(s) / s.hub_wind) * half_cosine(t, edc_period);
}

/// Extreme shear: added to the wind at an offset from the hub, upwards or sideways [m/s] (eqs. 26, 27), beta = 6.4.
inline double ews(const Site& s, double offset, double t) {
  if (t <= 0.0 || t >= ews_period) return 0.0;
  const double scale = scale_parameter(s.hub_height);
  const double slope = 2.5 + 0.2 * 6.4 * sigma_normal(s.hub_wind, s.reference_intensity) * std::pow(s.diameter / scale, 0.25);
  return offset / s.diameter * slope * (1.0 - std::cos(2.0 * pi * t / ews_period));
}

}  // namespace spindrift::iec
