// Kaimal's spectra and the exponential coherence of IEC 61400-1 ed. 3 (2005), annex B.2, of the three components of turbulence.
// Used by src/aero/turbulence_kaimal.cpp; tested in tests/kernels/rotor/gusts_iec_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace spindrift::kaimal {

/// Of the components u along the wind, v across, w up.
inline constexpr std::array<double, 3> sigma_ratio{1.0, 0.8, 0.5};    ///< to sigma_1
inline constexpr std::array<double, 3> length_ratio{8.1, 2.7, 0.66};  ///< integral scale over the scale parameter Lambda_1

/// One-sided power spectral density [m2/s] at the frequency f [Hz] of turbulence of standard deviation sigma [m/s] and integral
/// scale length [m] in a wind [m/s]; its integral over all f is sigma^2.
inline double density(double f, double sigma, double length, double wind) {
  const double scale = length / wind;
  return 4.0 * sigma * sigma * scale / std::pow(1.0 + 6.0 * f * scale, 5.0 / 3.0);
}

/// Magnitude of the coherence [-] of one component at two points a distance [m] apart across the wind; `length`: 8.1 Lambda_1.
inline double coherence(double f, double distance, double length, double wind) {
  const double a = f * distance / wind, b = 0.12 * distance / length;
  return std::exp(-12.0 * std::sqrt(a * a + b * b));
}

}  // namespace spindrift::kaimal
