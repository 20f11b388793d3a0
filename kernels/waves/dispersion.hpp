// The linear dispersion relation of gravity waves, omega^2 = g k tanh(k h), and what follows from it (Dean & Dalrymple 1991, ch.
// 3). Called wherever a wave is built from its period; tested in tests/kernels/waves/wave_kernels_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

/// Wave number k [rad/m] to round-off: Newton on x tanh x = y, x = k h, from the guess of Eckart (1952), which is within 5 %.
inline double wave_number(double omega, double depth, double gravity) {
  const double y = omega * omega * depth / gravity;
  if (y <= 0.0) return 0.0;
  double x = y / std::sqrt(std::tanh(y));
  for (int i = 0; i < 20; ++i) {
    const double t = std::tanh(x), step = (x * t - y) / (t + x * (1.0 - t * t));
    x -= step;
    if (std::abs(step) <= 1e-16 * x) break;
  }
  return x / depth;
}

/// A regular wave in numbers; angular frequency [rad/s], wave number [rad/m], lengths [m], speeds [m/s].
struct WaveProperties {
  double angular_frequency, wave_number, length, phase_speed, group_speed, relative_depth;  ///< relative depth: k h [-]
};
inline WaveProperties wave_properties(double period, double depth, double gravity) {
  const double omega = 2.0 * pi / period, k = wave_number(omega, depth, gravity), kh = k * depth, c = omega / k;
  const double shoaling = kh > 300.0 ? 0.0 : 2.0 * kh / std::sinh(2.0 * kh);
  return {omega, k, 2.0 * pi / k, c, 0.5 * c * (1.0 + shoaling), kh};
}

/// Ursell number H L^2 / h^3 [-]: nonlinearity against dispersion.
constexpr double ursell_number(double height, double length, double depth) {
  return height * length * length / (depth * depth * depth);
}

}  // namespace spindrift::waves
