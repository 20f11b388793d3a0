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
  double torque_integral = 0.0;          ///< [N m]
  double pitch_integral = 0.0;           ///< [rad]
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

/// The state in which the controller asks for this torque and pitch at this speed and wind and has been doing so.
inline ControllerDtuState settled(const ControllerDtu& c, double speed, double wind, double pitch, double least_pitch,
                                  double torque) {
  const double full = pitch > least_pitch + c.switch_pitch ? 1.0 : 0.0;
  return {speed, 0.0, wind, pitch, full, torque, pitch, torque, pitch};
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

  // Torque: tracks K omega^2 between the speed limits, a PI loop on the nearer limit within what its bounds leave free.
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
  const double speed_error = s.speed - (s.speed < 0.5 * (c.min_speed + c.rated_speed) ? c.min_speed : c.rated_speed);
  s.torque_integral = std::clamp(s.torque_integral + h * c.torque_ki * speed_error, least_torque, most_torque);
  s.torque = std::clamp(s.torque_integral + c.torque_kp * speed_error, least_torque, most_torque);

  // Pitch: a PI loop on rated speed whose gains fall as torque depends more on pitch.
  const double scheduled =
      1.0 / (1.0 + c.schedule_linear * s.schedule_pitch + c.schedule_quadratic * s.schedule_pitch * s.schedule_pitch);
  const double over = s.speed - c.rated_speed;
  s.pitch_integral = std::clamp(s.pitch_integral + h * scheduled * c.pitch_ki * over, least, c.max_pitch);
  const double asked = std::clamp(s.pitch_integral + scheduled * c.pitch_kp * over, least, c.max_pitch);
  s.pitch = std::clamp(asked, s.pitch - c.max_pitch_rate * h, s.pitch + c.max_pitch_rate * h);
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
