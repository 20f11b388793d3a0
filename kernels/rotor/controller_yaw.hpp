// Active yaw of a nacelle, of the usual kind: it turns at a steady rate once the filtered wind has stood off the rotor's axis by
// more than a threshold for a while, until the error is small (Burton et al. 2011, Wind Energy Handbook, section 8.2). The wind
// is filtered as a vector in earth axes, so that the nacelle's own turning is not delayed: it does not run past the wind. The
// drive is a spring and damper about the asked angle. Used by src/coupling/yaw_drive.cpp; tested in
// tests/kernels/rotor/controller_yaw_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/half_turn.hpp"

namespace spindrift {

/// What it remembers; plain numbers, the caller keeps them.
struct YawState {
  double time;            ///< [s]
  double wind_x, wind_y;  ///< filtered, earth axes [m/s]
  double waited;          ///< that the error has been beyond the threshold [s]
  double turning;         ///< 1: towards +z, -1: towards -z, 0: the drive holds
  double asked;           ///< angle about +z since the scene's position [rad]
};

struct YawController {
  double start_error, stop_error;  ///< [rad]
  double filter_time, delay;       ///< [s]
  double rate;                     ///< [rad/s]

  /// Of the filtered wind from a heading along (x, y), positive towards +z; 0 in still air [rad].
  static double error(const YawState& s, double x, double y) {
    return s.wind_x == 0.0 && s.wind_y == 0.0
               ? 0.0
               : within_half_turn(std::atan2(x * s.wind_y - y * s.wind_x, x * s.wind_x + y * s.wind_y));
  }
  double asked(const YawState& s, double t) const { return s.asked + s.turning * rate * (t - s.time); }

  /// From s.time to t, where the wind and the heading are so.
  YawState advanced(YawState s, double t, double wind_x, double wind_y, double x, double y) const {
    const double h = t - s.time, share = filter_time > 0.0 ? 1.0 - std::exp(-h / filter_time) : 1.0;
    s.asked = asked(s, t), s.time = t;
    s.wind_x += share * (wind_x - s.wind_x), s.wind_y += share * (wind_y - s.wind_y);
    const double off = error(s, x, y);
    if (s.turning != 0.0) {
      if (off * s.turning <= stop_error) s.turning = 0.0;
      return s;
    }
    s.waited = std::abs(off) > start_error ? s.waited + h : 0.0;
    if (s.waited > 0.0 && s.waited >= delay) s.turning = off > 0.0 ? 1.0 : -1.0, s.waited = 0.0;
    return s;
  }
};

}  // namespace spindrift
