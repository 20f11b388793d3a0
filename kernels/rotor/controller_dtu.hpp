// Generator torque and collective pitch from rotor speed: the Basic DTU Wind Energy controller (Hansen & Henriksen 2013, DTU Wind
// Energy Report E-0028) with its partial- and full-load regions, gain scheduling, limits and switching; without its power-error,
// damper and individual-pitch parts. Pure: a step is a function of its arguments. Equations: docs/theory/rotor_engineering.md.
// Used by src/aero/turbine_control.cpp; tested in tests/kernels/rotor/controller_dtu_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/smooth_step.hpp"

namespace spindrift {

/// Speeds and torques on the low-speed shaft.
struct ControllerDtu {
  double min_speed = 0.0, rated_speed = 1.0;  ///< [rad/s]
  double rated_power = 0.0;                   ///< mechanical [W]
  double max_torque = 0.0;                    ///< [N m]
  double torque_gain = 0.0;                   ///< K of Q = K omega^2 [N m s2/rad2]
  double torque_kp = 0.0, torque_ki = 0.0;    ///< [N m s/rad], [N m/rad]
  double pitch_kp = 0.0, pitch_ki = 0.0;      ///< [s], [-]: rad per rad/s, rad per rad
  double schedule_linear = 0.0;               ///< 1/KK1: gains fall by 1 / (1 + pitch / KK1 + pitch^2 / KK2) [1/rad]
  double schedule_quadratic = 0.0;            ///< 1/KK2 [1/rad2]
  double doubling_speed = 1.3;                ///< over rated, at which the gains of pitch are twice as large
  double max_pitch = 0.5 * pi;                ///< [rad]
  double max_pitch_rate = 0.2;                ///< [rad/s]
  double filter_frequency = 2.5;              ///< of the speed's low-pass filter [rad/s]
  double filter_damping = 0.7;
  bool constant_power = true;     ///< above rated; false: constant torque
  double switch_pitch = 0.00873;  ///< above the least pitch, where full load begins [rad]
  double open_share = 0.95;       ///< of rated speed, where the torque's limits are fully open (and its inverse of least speed)
  double wind_turns = 2.0;        ///< time constant of the wind's filter, in turns of the rotor
  double schedule_turns = 1.0;    ///< that of the pitch for gain scheduling, and of the switch to full load
};

struct ControllerDtuState {
  double speed = 0.0, speed_rate = 0.0;  ///< filtered [rad/s], [rad/s2]
  double wind = 0.0;                     ///< filtered [m/s]
  double schedule_pitch = 0.0;           ///< filtered [rad]
  double full_load = 0.0;                ///< 0 partial, 1 full load
  double torque_integral = 0.0;          ///< asked for, less the proportional part [N m]
  double pitch_integral = 0.0;           ///< the same [rad]
  double torque = 0.0, pitch = 0.0;      ///< asked for [N m], [rad]
};

/// One step of a low-pass filter of second order by the trapezoidal rule; stable at any step.
inline void filter_second_order(double input, double frequency, double damping, double h, double& value, double& rate) {
  const double half = 0.5 * h, w2 = frequency * frequency, d = 2.0 * damping * frequency;
  const double start = w2 * (input - value) - d * rate;
  const double next = (rate + half * start + half * w2 * (input - value - half * rate)) / (1.0 + half * d + half * half * w2);
  value += half * (rate + next), rate = next;
}

/// One step of a low-pass filter of first order, exact for an input that holds over the step.
inline double filter_first_order(double input, double time_constant, double h, double value) {
  return input + (value - input) * std::exp(-h / time_constant);
}

/// By which the torque's loop finds the speed off the nearer of its limits.
inline double torque_speed_error(const ControllerDtu& c, double speed) {
  return speed - (speed < 0.5 * (c.min_speed + c.rated_speed) ? c.min_speed : c.rated_speed);
}

/// Factor on the gains of pitch: they fall as torque depends more on pitch, and grow above rated speed.
inline double pitch_gain_share(const ControllerDtu& c, double schedule_pitch, double over) {
  const double excess = std::max(over, 0.0) / (c.rated_speed * (c.doubling_speed - 1.0));
  return (1.0 + excess * excess) /
         (1.0 + c.schedule_linear * schedule_pitch + c.schedule_quadratic * schedule_pitch * schedule_pitch);
}

/// The state in which the controller asks for this torque and pitch at this speed and wind and has been doing so.
inline ControllerDtuState settled(const ControllerDtu& c, double speed, double wind, double pitch, double least_pitch,
                                  double torque) {
  const double full = pitch > least_pitch + c.switch_pitch ? 1.0 : 0.0;
  const double torque_integral = torque - c.torque_kp * torque_speed_error(c, speed);
  const double over = speed - c.rated_speed, pitch_integral = pitch - pitch_gain_share(c, pitch, over) * c.pitch_kp * over;
  return {speed, 0.0, wind, pitch, full, torque_integral, pitch_integral, torque, pitch};
}

/// Asks for torque and pitch after a step of h seconds at whose end speed, pitch and wind are measured. `least_pitch(wind)`:
/// below rated power the blades are pitched so.
template <class LeastPitch>
ControllerDtuState advance(const ControllerDtu& c, ControllerDtuState s, double speed, double pitch, double wind, double h,
                           const LeastPitch& least_pitch) {
  filter_second_order(speed, c.filter_frequency, c.filter_damping, h, s.speed, s.speed_rate);
  const double turn = 2.0 * pi / std::max(s.speed, 0.5 * c.min_speed);
  s.wind = filter_first_order(wind, c.wind_turns * turn, h, s.wind);
  s.schedule_pitch = filter_first_order(pitch, c.schedule_turns * turn, h, s.schedule_pitch);
  const double least = least_pitch(s.wind);
  s.full_load = filter_first_order(pitch > least + c.switch_pitch ? 1.0 : 0.0, c.schedule_turns * turn, h, s.full_load);

  // Each loop's integral is what was asked for within the limits, less the proportional part. So blades begin to pitch below
  // rated speed, where the speed grows by more than ki / kp of what it lacks per second. Torque: tracks K omega^2 between the
  // speed limits, a PI loop on the nearer limit within what its bounds leave free.
  const auto open = [](double x, double from, double to) { return smooth_step((x - from) / (to - from)); };
  const double lower = c.min_speed, lower_open = c.min_speed / c.open_share;
  const double upper = (2.0 * c.open_share - 1.0) * c.rated_speed, upper_open = c.open_share * c.rated_speed;
  const double optimal = c.torque_gain * s.speed * s.speed, opened = open(s.speed, upper, upper_open);
  const double full =
      std::min(c.constant_power ? c.rated_power / std::max(speed, c.min_speed) : c.rated_power / c.rated_speed, c.max_torque);
  double most_torque = std::max(optimal * (1.0 - opened) + full * opened, c.torque_gain * lower * lower);
  double least_torque =
      std::min({optimal * open(s.speed, lower, lower_open), c.torque_gain * upper_open * upper_open, most_torque});
  least_torque += s.full_load * (full - least_torque), most_torque += s.full_load * (full - most_torque);
  const double off = torque_speed_error(c, s.speed), torque_part = c.torque_kp * off;
  s.torque = std::clamp(s.torque_integral + h * c.torque_ki * off + torque_part, least_torque, most_torque);
  s.torque_integral = s.torque - torque_part;

  // Pitch: a PI loop on rated speed.
  const double over = s.speed - c.rated_speed, gain = pitch_gain_share(c, s.schedule_pitch, over),
               part = gain * c.pitch_kp * over;
  const double asked = std::clamp(s.pitch_integral + h * gain * c.pitch_ki * over + part, least, c.max_pitch);
  s.pitch = std::clamp(asked, s.pitch - c.max_pitch_rate * h, s.pitch + c.max_pitch_rate * h);
  s.pitch_integral = s.pitch - part;
  return s;
}

/// One step of a pitch servo of second order with limits of rate and acceleration [rad], [rad/s], [rad/s2].
inline void pitch_servo(double asked, double frequency, double damping, double max_rate, double max_acceleration, double h,
                        double& pitch, double& rate) {
  double value = pitch, next = rate;
  filter_second_order(asked, frequency, damping, h, value, next);
  next = std::clamp(next, rate - max_acceleration * h, rate + max_acceleration * h);
  next = std::clamp(next, -max_rate, max_rate);
  pitch += 0.5 * h * (rate + next), rate = next;
}

}  // namespace spindrift
