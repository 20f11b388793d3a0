// Second-order Stokes wave of finite depth as two harmonics: the Airy wave and the bound wave at twice its phase.
// Dean & Dalrymple (1991), eqs. 11.3-11.5, written with s = tanh kh:
//   eta_2 = (k a^2 / 4) (3 - s^2) / s^3 cos 2 psi,   phi_2 = (3/8) a^2 omega cosh 2k(z+h) / sinh^4 kh sin 2 psi,  a = H / 2.
// The mean level is zero, dispersion is linear. Called by src/sea/wave_stokes2.cpp; tested in
// tests/kernels/waves/wave_kernels_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/waves/components.hpp"

namespace spindrift::waves {

/// The bound second harmonic of a linear wave in water of the given depth [m].
inline Component stokes_second(const Component& first, double depth) {
  const double k = first.wave_number, a = first.amplitude, kh = k * depth, s = std::tanh(kh), sh = std::sinh(kh);
  Component second = first;
  second.wave_number = 2.0 * k;
  second.angular_frequency = 2.0 * first.angular_frequency;
  second.phase = 2.0 * first.phase;
  second.amplitude = 0.25 * k * a * a * (3.0 - s * s) / (s * s * s);
  // u_2 = (3/4) a^2 omega k cosh 2k(z+h) / sinh^4 kh, and sinh 2kh = 2 sinh cosh: beyond kh = 20 it is below 1e-15 of u_1.
  second.speed_amplitude = kh > 20.0 ? 0.0 : 1.5 * a * a * first.angular_frequency * k * std::cosh(kh) / (sh * sh * sh);
  return second;
}

/// Ratio of the two elevation amplitudes; above 1/4 the trough grows a second crest and the expansion has failed.
inline double stokes_ratio(double height, double wave_number, double depth) {
  const double s = std::tanh(wave_number * depth);
  return 0.125 * wave_number * height * (3.0 - s * s) / (s * s * s);
}

}  // namespace spindrift::waves
