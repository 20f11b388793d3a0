// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine_control.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/base/interpolation.hpp"

namespace spindrift::aero {

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
                    .doubling_speed = gains.doubling_speed,
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

TurbineControl::TurbineControl(const ControlOptions& options, const ControllerOptions& controller,
                               const std::optional<Operation>& operation, int blades, const Start& start,
                               const std::optional<PeakShaving>& shaving)
    : drive_train_(controller),
      law_{law_of(options, controller, operation), controller.stop_pitch_rate, {}},
      events_(options.events),
      blades_(blades),
      start_(options.start == ControlStart::parked ? Start{start.azimuth, 0.0, controller.feather, true} : start) {
  if (operation) law_.below_rated = operation->below_rated();
  if (shaving) law_.below_rated.wind = shaving->wind, law_.below_rated.pitch = shaving->pitch;
}

TurbineControl::TurbineControl(const ControlOptions& options, int blades, const Start& start, double step_s)
    : drive_train_(*options.drive_train),
      events_(options.events),
      blades_(blades),
      start_(start),
      library_(std::make_unique<BladedLibrary>(options, blades)),
      step_(step_s) {}

double TurbineControl::Law::least_pitch(double wind) const {
  return below_rated.pitch.empty() ? 0.0 : interpolate_linear(below_rated.wind, below_rated.pitch, wind);
}

TurbineControl::State TurbineControl::state(std::span<const double> memory) {
  std::array<double, head> values;
  std::copy_n(memory.begin(), head, values.begin());
  return std::bit_cast<State>(values);
}

TurbineControl::Shaft TurbineControl::shaft(std::span<const double> memory) const {
  std::array<double, shaft_size> values;
  std::copy_n(memory.begin() + std::ptrdiff_t(memory_size() - shaft_size), shaft_size, values.begin());
  return std::bit_cast<Shaft>(values);
}

void TurbineControl::store(const Shaft& shaft, std::span<double> memory) const {
  std::ranges::copy(std::bit_cast<std::array<double, shaft_size>>(shaft),
                    memory.begin() + std::ptrdiff_t(memory_size() - shaft_size));
}

void TurbineControl::store(const State& s, std::span<double> memory) {
  const auto values = std::bit_cast<std::array<double, head>>(s);
  std::copy(values.begin(), values.end(), memory.begin());
}

TurbineControl::Rows TurbineControl::rows(std::span<double> memory) const {
  const std::size_t n = std::size_t(blades_), after = head + 4 * n;
  Rows rows{memory.subspan(head, n),
            memory.subspan(head + n, n),
            memory.subspan(head + 2 * n, n),
            memory.subspan(head + 3 * n, n),
            {},
            {}};
  if (library_) rows.velocity = memory.subspan(after, 3), rows.turning = memory.subspan(after + 3, 3);
  return rows;
}

void TurbineControl::begin(double t, const Measured& measured, std::span<double> memory) const {
  std::ranges::fill(memory, 0.0);
  State s{t, start_.azimuth, start_.speed, 0.0, 0.0, 0.0, double(Mode::parked), start_.pitch, 0.0, 0.0, {}};
  const Rows rows = this->rows(memory);
  constexpr double before_all = -std::numeric_limits<double>::infinity();
  std::ranges::fill(rows.pitch, start_.pitch), std::ranges::fill(rows.asked, start_.pitch);
  if (library_) {
    s.mode = double(Mode::operating);
    s.shaft_torque = measured.torque;
    std::copy_n(measured.velocity.data(), 3, rows.velocity.begin()),
        std::copy_n(measured.turning.data(), 3, rows.turning.begin());
    happen(before_all, t, s, rows.stuck);
    ask_library(t, 0.0, measured, s.speed, s, rows);
    lay_shaft(measured, s, memory);
    return store(s, memory);
  }
  const double least = law_.least_pitch(measured.wind);
  const auto settled_at = [&](double torque) {
    return settled(law_.dtu, start_.speed, measured.wind, start_.pitch, least, torque);
  };
  if (!start_.parked) {
    s.mode = double(Mode::operating);
    // What the law asks of the generator at this speed and pitch: the torque of the air may be that of a gust's moment.
    const ControllerDtuState by_air = settled_at(std::clamp(measured.torque, 0.0, law_.dtu.max_torque));
    s.generator_torque = spindrift::advance(law_.dtu, by_air, start_.speed, start_.pitch, measured.wind, 0.0, [this](double w) {
                           return law_.least_pitch(w);
                         }).torque;
  }
  s.shaft_torque = s.generator_torque;
  s.controller = settled_at(s.generator_torque);
  lay_shaft(measured, s, memory);
  if (happen(before_all, t, s, rows.stuck)) ask_law(0.0, measured, s.speed, s, rows);
  store(s, memory);
}

/// The air's torque before the first step is that of the start; an elastic shaft is twisted by what the generator takes then.
void TurbineControl::lay_shaft(const Measured& measured, State& s, std::span<double> memory) const {
  s.acceleration = measured.torque / turned_inertia(measured);
  if (!has_elastic_shaft()) return;
  store(Shaft{s.generator_torque / *drive_train_.shaft_stiffness_N_m_rad, s.speed, s.generator_torque}, memory);
}

/// Largest torque of the brake [N m].
double TurbineControl::brake(const State& s) const {
  return s.mode == double(Mode::parked) || s.mode == double(Mode::braked) ? drive_train_.brake_torque_N_m : s.brake_torque;
}

bool TurbineControl::happen(double after, double t, State& s, std::span<double> stuck) const {
  bool any = false;
  for (const EventOptions& event : events_) {
    if (!(after < event.time_s && event.time_s <= t)) continue;
    any = true;
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
  return any;
}

/// Blades pitch to feather; the generator's torque is up to the caller.
void TurbineControl::feather(double h, double rate, State& s, const Rows& rows) const {
  s.asked = s.mode == double(Mode::parked) ? drive_train_.feather : std::min(s.asked + h * rate, drive_train_.feather);
  std::ranges::fill(rows.asked, s.asked);
}

/// Our own controller, at the end of a step.
void TurbineControl::ask_law(double h, const Measured& measured, double speed, State& s, const Rows& rows) const {
  double pitch = 0.0;
  for (double p : rows.pitch) pitch += p / blades_;
  const double least = law_.least_pitch(s.controller.wind);
  s.controller = spindrift::advance(law_.dtu, s.controller, speed, pitch, measured.wind, h,
                                    [this](double w) { return law_.least_pitch(w); });
  if (s.mode == double(Mode::operating)) {
    s.asked = s.controller.pitch, s.generator_torque = s.controller.torque;
  } else if (s.mode == double(Mode::starting)) {
    s.generator_torque = 0.0;
    s.asked = std::max(s.asked - h * law_.stop_pitch_rate, std::max(least, s.controller.pitch));
    if (s.controller.speed >= law_.dtu.min_speed) {
      s.mode = double(Mode::operating);
      s.controller = settled(law_.dtu, s.controller.speed, s.controller.wind, std::max(s.asked, least), least, 0.0);
    }
  } else {
    const double k_torque = speed > 0.0 ? law_.dtu.torque_gain * speed * speed : 0.0;
    s.generator_torque =
        s.mode == double(Mode::stopping) && speed > law_.dtu.min_speed ? std::min(s.generator_torque, k_torque) : 0.0;
    return feather(h, s.mode == double(Mode::stopping) ? law_.stop_pitch_rate : drive_train_.max_pitch_rate, s, rows);
  }
  std::ranges::fill(rows.asked, s.asked);
}

/// The library, at the end of a step of h; at the start of the run without one.
void TurbineControl::ask_library(double t, double h, const Measured& measured, double generator_speed, State& s,
                                 const Rows& rows) const {
  const double gear = drive_train_.gear_ratio;
  Eigen::Map<Eigen::Vector3d> velocity(rows.velocity.data()), turning(rows.turning.data());
  const Eigen::Vector3d acceleration = h > 0.0 ? Eigen::Vector3d((measured.velocity - velocity) / h) : Eigen::Vector3d::Zero(),
                        turned = h > 0.0 ? Eigen::Vector3d((measured.turning - turning) / h) : Eigen::Vector3d::Zero();
  velocity = measured.velocity, turning = measured.turning;
  const auto pitch = [&](std::size_t blade) { return float(blade < rows.pitch.size() ? rows.pitch[blade] : 0.0); };
  const double turn = std::fmod(s.azimuth, 2.0 * pi);
  const BladedLibrary::Asked asked = library_->call(
      std::int64_t(s.calls), {.time = float(t),
                              .step = float(h > 0.0 ? h : step_),
                              .pitch_1 = pitch(0),
                              .asked_pitch = float(rows.asked[0]),
                              .shaft_power = float(s.shaft_torque * s.speed),
                              .electrical_power = float(drive_train_.generator_efficiency * s.generator_torque * generator_speed),
                              .generator_speed = float(gear * generator_speed),
                              .rotor_speed = float(s.speed),
                              .generator_torque = float(s.generator_torque / gear),
                              .yaw_error = float(measured.yaw_error),
                              .wind = float(measured.wind_speed),
                              .pitch_2 = pitch(1),
                              .pitch_3 = pitch(2),
                              .fore_aft = float(acceleration.x()),
                              .side_to_side = float(acceleration.y()),
                              .azimuth = float(turn < 0.0 ? turn + 2.0 * pi : turn),
                              .rolling = float(turned.x()),
                              .nodding = float(turned.y()),
                              .yawing = float(turned.z()),
                              .shaft_torque = float(s.shaft_torque)});
  s.calls += 1.0;
  if (s.mode != double(Mode::operating)) {
    s.generator_torque = 0.0;
    return feather(h, drive_train_.max_pitch_rate, s, rows);
  }
  s.generator_torque = gear * asked.generator_torque;
  s.brake_torque = asked.brake ? drive_train_.brake_torque_N_m : gear * asked.brake_torque;
  s.asked = 0.0;
  for (std::size_t b = 0; b < rows.asked.size(); ++b) rows.asked[b] = asked.pitch[b], s.asked += asked.pitch[b] / blades_;
}

void TurbineControl::turn_blades(double h, const Rows& rows) const {
  for (std::size_t b = 0; b < rows.pitch.size(); ++b) {
    double &pitch = rows.pitch[b], &rate = rows.rate[b];
    if (rows.stuck[b] != 0.0) {
      rate = 0.0;
    } else if (drive_train_.servo_frequency_Hz) {
      pitch_servo(rows.asked[b], 2.0 * pi * *drive_train_.servo_frequency_Hz, drive_train_.servo_damping,
                  drive_train_.max_pitch_rate, drive_train_.max_pitch_acceleration, h, pitch, rate);
    } else {
      pitch += std::clamp(rows.asked[b] - pitch, -h * drive_train_.max_pitch_rate, h * drive_train_.max_pitch_rate);
    }
  }
}

/// Of what the air's torque turns: the whole drive train, or the rotor on its elastic shaft [kg m2].
double TurbineControl::turned_inertia(const Measured& measured) const {
  return drive_train_.rotor_inertia_kg_m2 + (has_elastic_shaft() ? 0.0 : drive_train_.generator_inertia_kg_m2) -
         measured.bending_inertia;
}

/// Under the torque of the air by Adams and Bashforth, and of the generator, which holds over the step.
void TurbineControl::turn_rigid(double h, const Measured& measured, State& s) const {
  const double inertia = turned_inertia(measured), acceleration = measured.torque / inertia, before = s.speed;
  s.speed += h * (1.5 * acceleration - 0.5 * s.acceleration - s.generator_torque / inertia);
  if (const double stop = h * brake(s) / inertia; stop > 0.0) s.speed -= std::clamp(s.speed, -stop, stop);
  s.acceleration = acceleration;
  s.shaft_torque = measured.torque - inertia * (s.speed - before) / h;
  s.azimuth += 0.5 * h * (before + s.speed);
}

/// Rotor and generator on the two ends of a spring and a damper, by the trapezium rule in twist and torque: stable at any step
/// and without damping of its own.
void TurbineControl::turn_elastic(double h, const Measured& measured, State& s, std::span<double> memory) const {
  Shaft shaft = this->shaft(memory);
  const double rotor = turned_inertia(measured), generator = drive_train_.generator_inertia_kg_m2,
               stiffness = *drive_train_.shaft_stiffness_N_m_rad;
  const double acceleration = measured.torque / rotor, by_air = 1.5 * acceleration - 0.5 * s.acceleration;
  const double before = s.speed, generator_before = shaft.generator_speed, looseness = 1.0 / rotor + 1.0 / generator;
  const double per_rate = 0.5 * h * stiffness + drive_train_.shaft_damping_N_m_s_rad;
  const double rate =
      (before - generator_before + 0.5 * h * (by_air + s.generator_torque / generator - looseness * stiffness * shaft.twist)) /
      (1.0 + 0.5 * h * looseness * per_rate);  // of the twist, its mean over the step
  shaft.torque = stiffness * shaft.twist + per_rate * rate;
  shaft.twist += h * rate;
  shaft.generator_speed += h * (shaft.torque - s.generator_torque) / generator;
  s.speed += h * (by_air - shaft.torque / rotor);
  if (const double stop = h * brake(s) / rotor; stop > 0.0) s.speed -= std::clamp(s.speed, -stop, stop);
  s.acceleration = acceleration;
  s.shaft_torque = measured.torque - (rotor * (s.speed - before) + generator * (shaft.generator_speed - generator_before)) / h;
  s.azimuth += 0.5 * h * (before + s.speed);
  store(shaft, memory);
}

void TurbineControl::advance(double t, double h, const Measured& measured, std::span<double> memory) const {
  State s = state(memory);
  const Rows rows = this->rows(memory);
  if (has_elastic_shaft())
    turn_elastic(h, measured, s, memory);
  else
    turn_rigid(h, measured, s);
  const double generator_speed = this->generator_speed(s, memory);

  happen(s.time, t, s, rows.stuck);  // from the time stored: t - h may round past an event
  s.time = t;
  if (library_)
    ask_library(t, h, measured, generator_speed, s, rows);
  else
    ask_law(h, measured, generator_speed, s, rows);
  turn_blades(h, rows);
  store(s, memory);
}

}  // namespace spindrift::aero
