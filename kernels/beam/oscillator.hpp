// One mode of vibration, advanced exactly under a force that is linear over the step. Used by src/aero/flexible_blades.cpp;
// tested in tests/kernels/beam/oscillator_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace spindrift::beam {

/// x'' + damping x' + omega^2 x = force, of mass 1.
struct Oscillator {
  double omega;    ///< above half the damping [rad/s]
  double damping;  ///< [1/s]

  struct State {
    double x, v;
  };
  /// After h, over which the force goes from `from` to `to`.
  State advance(const State& s, double from, double to, double h) const {
    // The part that follows the force is a straight line; the rest decays.
    const double square = omega * omega, slope = (to - from) / (h * square), level = (from - damping * slope) / square;
    const double x = s.x - level, v = s.v - slope, half = 0.5 * damping, swing = std::sqrt(square - half * half);
    const double fade = std::exp(-half * h), c = std::cos(swing * h), sine = std::sin(swing * h) / swing;
    return {fade * (x * (c + half * sine) + v * sine) + level + slope * h,
            fade * (v * (c - half * sine) - square * x * sine) + slope};
  }
};

}  // namespace spindrift::beam
