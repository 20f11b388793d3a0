// What a wavemaker's stroke gives: far-field wave height over stroke of a piston and of a flap hinged at the bottom.
// Biesel & Suquet (1951); Dean & Dalrymple (1991), eqs. 6.25 and 6.26. Called by the wavemakers of src/sea;
// tested in tests/kernels/waves/wave_kernels_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace spindrift::waves {

/// Height / stroke of a piston; kh: wave number times depth [-]. Below kh = 0.3 it approaches kh.
inline double piston_transfer(double kh) {
  if (kh > 300.0) return 2.0;
  const double s = std::sinh(kh);
  return 4.0 * s * s / (std::sinh(2.0 * kh) + 2.0 * kh);  // 2 (cosh 2kh - 1) without its cancellation
}

/// Height / stroke at still water of a flap hinged at the bottom.
inline double flap_transfer(double kh) {
  if (kh > 300.0) return 2.0 * (1.0 - 1.0 / kh);
  // kh sinh kh - cosh kh + 1 cancels for small kh: its series is sum over n of (2n-1) kh^2n / (2n)!
  const double lever =
      kh < 0.5
          ? kh * kh *
                (0.5 + kh * kh * (3.0 / 24.0 + kh * kh * (5.0 / 720.0 + kh * kh * (7.0 / 40320.0 + kh * kh * 9.0 / 3628800.0))))
          : kh * std::sinh(kh) - std::cosh(kh) + 1.0;
  return 4.0 * std::sinh(kh) / kh * lever / (std::sinh(2.0 * kh) + 2.0 * kh);
}

/// Height / stroke at still water of a flap whose hinge stands over the bottom: kd is wave number times its height (kh: at the
/// surface, the limit of no flap). The wall under it does not move.
inline double flap_transfer(double kh, double kd) {
  if (kd <= 0.0) return flap_transfer(kh);
  if (kh > 300.0) return 2.0 * (1.0 - 1.0 / (kh - kd));
  return 4.0 * std::sinh(kh) / (std::sinh(2.0 * kh) + 2.0 * kh) * (std::sinh(kh) + (std::cosh(kd) - std::cosh(kh)) / (kh - kd));
}

/// Amplitude [m] of the motion at twice the frequency that a piston adds, so that the wave is free of the free second harmonic:
/// e = S/2 sin wt + piston_second sin 2wt. Madsen (1971), J. Geophys. Res. 76, 8672, eq. 24.
inline double piston_second(double height, double depth, double kh) {
  const double s = std::sinh(kh);
  return height * height / (32.0 * depth) * (3.0 / (std::tanh(kh) * s * s) - 2.0 / piston_transfer(kh));
}

}  // namespace spindrift::waves
