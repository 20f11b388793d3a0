// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine_control.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "kernels/base/interpolation.hpp"

namespace spindrift::aero {

namespace {

ControllerDtu law_of(const ControlOptions& options, const ControllerOptions& o, const std::optional<Operation>& operation) {
  const PitchGainOptions& gains = options.tuning == Tuning::floating ? *o.floating_gains : o.gains;
  ControllerDtu law{.min_speed = o.min_speed,
                    .rated_speed = o.rated_speed,
                    .rated_power = o.rated_power_W / o.generator_efficiency,
                    .max_torque = o.max_torque_N_m,
                    .torque_gain = o.torque_gain_N_m_s2 ? *o.torque_gain_N_m_s2 : *operation->torque_gain(),
                    .torque_kp = o.torque_kp_N_m_s,
                    .torque_ki = o.torque_ki_N_m,
                    .pitch_kp = gains.kp_s,
                    .pitch_ki = gains.ki,
                    .max_pitch = o.max_pitch,
                    .max_pitch_rate = o.max_pitch_rate,
                    .filter_frequency = 2.0 * pi * o.filter_frequency_Hz,
                    .filter_damping = o.filter_damping,
                    .constant_power = gains.constant_power,
                    .switch_pitch = o.switch_pitch};
  constexpr double degrees_per_radian = 1.0 / radians_per_degree;
  if (gains.schedule_linear_deg) law.schedule_linear = degrees_per_radian / *gains.schedule_linear_deg;
  if (gains.schedule_quadratic_deg2)
    law.schedule_quadratic = degrees_per_radian * degrees_per_radian / *gains.schedule_quadratic_deg2;
  return law;
}

}  // namespace

TurbineControl::TurbineControl(const ControlOptions& options, const ControllerOptions& controller,
                               const std::optional<Operation>& operation, int blades, double start_azimuth, double start_speed,
                               double start_pitch)
    : law_(law_of(options, controller, operation)),
      options_(controller),
      events_(options.events),
      blades_(blades),
      inertia_(controller.rotor_inertia_kg_m2 + controller.generator_inertia_kg_m2),
      rotor_inertia_(controller.rotor_inertia_kg_m2),
      efficiency_(controller.generator_efficiency),
      start_azimuth_(start_azimuth),
      start_speed_(start_speed),
      start_pitch_(start_pitch),
      starts_parked_(options.start == ControlStart::parked) {
  if (operation) below_rated_ = operation->below_rated();
  if (starts_parked_) start_speed_ = 0.0, start_pitch_ = controller.feather;
}

double TurbineControl::least_pitch(double wind) const {
  return below_rated_.pitch.empty() ? 0.0 : interpolate_linear(below_rated_.wind, below_rated_.pitch, wind);
}

TurbineControl::State TurbineControl::state(std::span<const double> memory) {
  std::array<double, head> values;
  std::copy_n(memory.begin(), head, values.begin());
  return std::bit_cast<State>(values);
}

void TurbineControl::store(const State& s, std::span<double> memory) {
  const auto values = std::bit_cast<std::array<double, head>>(s);
  std::copy(values.begin(), values.end(), memory.begin());
}

void TurbineControl::begin(double t, double aero_torque, double wind, std::span<double> memory) const {
  State s{t, start_azimuth_, start_speed_, 0.0, 0.0, 0.0, double(Mode::parked), start_pitch_, {}};
  if (!starts_parked_) {
    s.mode = double(Mode::operating);
    s.generator_torque = std::clamp(aero_torque, 0.0, law_.max_torque);
  }
  s.shaft_torque = s.generator_torque;
  s.controller = settled(law_, start_speed_, wind, start_pitch_, least_pitch(wind), s.generator_torque);
  store(s, memory);
  std::fill_n(memory.begin() + std::ptrdiff_t(head), blades_, start_pitch_);
}

/// Largest torque of the brake [N m].
double TurbineControl::brake(const State& s) const {
  return s.mode == double(Mode::parked) || s.mode == double(Mode::braked) ? options_.brake_torque_N_m : 0.0;
}

/// Events of this step.
void TurbineControl::happen(double t, double h, State& s, std::span<double> stuck) const {
  for (const EventOptions& event : events_) {
    if (event.time_s > t || event.time_s <= t - h) continue;
    switch (event.what) {
      case ControlEvent::start_up:
        s.mode = double(Mode::starting);
        break;
      case ControlEvent::shut_down:
        s.mode = double(Mode::stopping);
        break;
      case ControlEvent::emergency_stop:
        s.mode = double(Mode::braked);
        break;
      case ControlEvent::grid_loss:
        s.mode = double(Mode::tripped);
        break;
      case ControlEvent::blade_stuck:
        stuck[std::size_t(event.blade - 1)] = 1.0;
        break;
    }
  }
}

void TurbineControl::advance(double t, double h, double aero_torque, double wind, std::span<double> memory) const {
  State s = state(memory);
  const std::span<double> pitch = memory.subspan(head, std::size_t(blades_)),
                          rate = memory.subspan(head + std::size_t(blades_), std::size_t(blades_)),
                          stuck = memory.subspan(head + 2 * std::size_t(blades_), std::size_t(blades_));
  // The shaft first, under the torque that the generator had: Adams-Bashforth, second order.
  const double acceleration = (aero_torque - s.generator_torque) / inertia_;
  const double before = s.speed;
  s.speed += h * (1.5 * acceleration - 0.5 * s.acceleration);
  if (const double stop = h * brake(s) / inertia_; stop > 0.0) s.speed -= std::clamp(s.speed, -stop, stop);
  s.acceleration = acceleration;
  s.shaft_torque = aero_torque - inertia_ * (s.speed - before) / h;
  s.azimuth += 0.5 * h * (before + s.speed), s.time = t;

  happen(t, h, s, stuck);
  double measured = 0.0;
  for (double p : pitch) measured += p / blades_;
  const double least = least_pitch(s.controller.wind);
  s.controller = spindrift::advance(law_, s.controller, s.speed, measured, wind, h, [this](double w) { return least_pitch(w); });
  if (s.mode == double(Mode::operating)) {
    s.asked = s.controller.pitch, s.generator_torque = s.controller.torque;
  } else if (s.mode == double(Mode::starting)) {
    s.generator_torque = 0.0;
    s.asked = std::max(s.asked - h * options_.stop_pitch_rate, std::max(least, s.controller.pitch));
    if (s.controller.speed >= law_.min_speed) {
      s.mode = double(Mode::operating);
      s.controller = settled(law_, s.controller.speed, s.controller.wind, std::max(s.asked, least), least, 0.0);
    }
  } else {
    const double to_feather = s.mode == double(Mode::stopping) ? options_.stop_pitch_rate : options_.max_pitch_rate;
    s.asked = std::min(s.asked + h * to_feather, options_.feather);
    const double k_torque = s.speed > 0.0 ? law_.torque_gain * s.speed * s.speed : 0.0;
    s.generator_torque =
        s.mode == double(Mode::stopping) && s.speed > law_.min_speed ? std::min(s.generator_torque, k_torque) : 0.0;
    if (s.mode == double(Mode::parked)) s.asked = options_.feather;
  }
  for (std::size_t b = 0; b < pitch.size(); ++b) {
    if (stuck[b] != 0.0) {
      rate[b] = 0.0;
      continue;
    }
    pitch_servo(s.asked, 2.0 * pi * options_.servo_frequency_Hz, options_.servo_damping, options_.max_pitch_rate,
                options_.max_pitch_acceleration, h, pitch[b], rate[b]);
  }
  store(s, memory);
}

}  // namespace spindrift::aero
