// Separation takes time: lift between that of attached and that of separated flow, by a separation point that lags behind the
// static one. Oye (1991), Dynamic stall simulated as time lag of separation, 4th IEA symposium on aerodynamics; the static
// separation point from the polar by flat-plate Kirchhoff flow as in Hansen, Gaunaa & Madsen (2004), Riso-R-1354, eqs. 2.14 to
// 2.17. Used by src/aero/bem.cpp; tested in tests/kernels/rotor/unsteady_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/base/constants.hpp"
#include "kernels/rotor/dynamic_inflow_oye.hpp"

namespace spindrift {

struct DynamicStallOye {
  /// Beyond these angles from zero lift the flow is separated however it came there: lift goes over to the polar's [rad].
  static constexpr double fade_from = 40.0 * radians_per_degree, fade_to = 50.0 * radians_per_degree;

  double zero_lift = 0.0;  ///< angle [rad]
  double slope = 0.0;      ///< of attached flow [1/rad]; 0: a section without lift, which has no stall

  /// From a polar: the zero of lift nearest to no angle of attack, and the steepest line from it that touches the polar.
  static DynamicStallOye of(std::span<const double> attack, std::span<const double> lift) {
    DynamicStallOye found;
    double nearest = 30.0 * radians_per_degree;
    for (std::size_t i = 0; i + 1 < attack.size(); ++i) {
      if (lift[i] > 0.0 || lift[i + 1] <= 0.0) continue;
      const double zero = attack[i] - lift[i] * (attack[i + 1] - attack[i]) / (lift[i + 1] - lift[i]);
      if (std::abs(zero) < nearest) nearest = std::abs(zero), found.zero_lift = zero;
    }
    constexpr double least = 2.0 * radians_per_degree, most = 20.0 * radians_per_degree;  // nearer the zero polars are rough
    for (std::size_t i = 0; i < attack.size(); ++i)
      if (const double angle = attack[i] - found.zero_lift; std::abs(angle) > least && std::abs(angle) < most)
        found.slope = std::max(found.slope, lift[i] / angle);
    return found;
  }

  /// 0 where dynamic stall holds, so far from zero lift, 1 where the flow is separated however it came there.
  static double away(double off) { return std::clamp((off - fade_from) / (fade_to - fade_from), 0.0, 1.0); }

  double attached(double attack) const { return slope * (attack - zero_lift); }

  /// f of the polar's lift: 1 attached, 0 separated to the leading edge.
  double separation(double attack, double lift) const {
    const double line = attached(attack);
    if (line == 0.0) return 1.0;
    const double root = 2.0 * std::sqrt(std::max(lift / line, 0.0)) - 1.0;
    return root > 0.0 ? std::min(root * root, 1.0) : 0.0;
  }

  /// Lift where the flow separates at f, and the polar has `lift`.
  double lift(double attack, double lift, double f) const {
    const double still = separation(attack, lift), line = attached(attack), out = away(std::abs(attack - zero_lift));
    const double separated = still < 0.9999 ? (lift - still * line) / (1.0 - still) : 0.5 * lift;
    return lift + (1.0 - out) * (f - still) * (line - separated);
  }

  /// f after h in the relative speed [m/s], over which the static one went from `before` to `now`; so many chords pass in the
  /// time constant (4: Hansen 2008, ch. 9).
  static double advance(double f, double before, double now, double h, double chord, double speed, double chords) {
    return lagged(f, before, now, h, chords * chord / std::max(speed, 1e-3));
  }
};

}  // namespace spindrift
