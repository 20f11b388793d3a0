// SPDX-License-Identifier: Apache-2.0
#include "src/aero/control_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "kernels/base/constants.hpp"
#include "src/aero/control_options.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/thrust_curve.hpp"

namespace spindrift::aero {

namespace {

/// Turbines of 1 kW to 22 MW are rated at 160 to 600 W per square metre swept.
void doubt_rating(scene::Doubts& doubts, const std::string& key, double power, double radius) {
  constexpr double least = 50.0, most = 1000.0;
  const double share = power / (pi * radius * radius);
  const auto fits = [&](double factor) { return factor * share > least && factor * share < most; };
  if (fits(1.0)) return;
  doubts.push_back({key, fmt::format("{:.4g} W with blades of {:.4g} m, {:.3g} W per square metre swept", power, radius, share),
                    fmt::format("{:g} to {:g} W/m2: turbines are rated at 160 to 600", least, most),
                    fits(1e3)   ? "in kW? give W"
                    : fits(1e6) ? "in MW? give W"
                                : "look at its unit, W, and at the length of the blades"});
}

/// Tips of turbines of any size are at 60 to 110 m/s at rated speed, of old and slow ones at 30.
void doubt_tips(scene::Doubts& doubts, const std::string& key, double speed, double radius) {
  constexpr double least = 20.0, most = 130.0;
  if (const double tip = speed * radius; tip < least || tip > most)
    doubts.push_back({key, fmt::format("{:.4g} rpm, tips at {:.4g} m/s", speed / rad_s_per_rpm, tip),
                      fmt::format("tips at {:g} to {:g} m/s", least, most),
                      tip < least ? "in rad/s or Hz? give rpm" : "of the generator, or in deg/s? give rpm of the rotor"});
}

/// From rated wind on blades are pitched by up to 25 degrees, or stay as they are.
void doubt_pitch(scene::Doubts& doubts, const std::string& at, const Operation& table, std::size_t rated) {
  constexpr double enough = 1.2, least_degrees = 1.0;
  if (table.pitch.empty() || table.wind.back() < enough * table.wind[rated]) return;
  const auto [least, most] = std::ranges::minmax(table.pitch);
  const double low = least / radians_per_degree, high = most / radians_per_degree;
  if (high > low && std::max(std::abs(low), std::abs(high)) < least_degrees)
    doubts.push_back({at + ".blade_pitch_deg", fmt::format("from {:.4g} to {:.4g} degrees", low, high),
                      fmt::format("more than {:g} degree well above rated wind", least_degrees), "in radians? give degrees"});
}

/// Pitch answers an excess of all of the rated speed by 0.2 (floaters) to 2.5 rad (DTU 10 MW, NREL 5 MW on the shaft), and less
/// the more the blades are pitched already, from some 5 degrees on.
void doubt_gains(scene::Doubts& doubts, const std::string& at, const PitchGainOptions& gains, double rated_speed) {
  constexpr double least = 0.05, most = 20.0, least_degrees = 1.0;
  if (const double answer = gains.kp_s * rated_speed; answer < least || answer > most)
    doubts.push_back({at + ".kp_s",
                      fmt::format("{:.4g} s, {:.3g} rad for an excess of all of the rated speed", gains.kp_s, answer),
                      fmt::format("{:g} to {:g} rad", least, most),
                      answer > most ? "in degrees? give rad/(rad/s)" : "of the generator's speed? times the ratio of the gear"});
  constexpr double slow = 0.005, fast = 5.0;  // 1/s: .05 of floaters to .5
  if (const double rate = gains.ki / std::max(gains.kp_s, 1e-12); gains.ki > 0.0 && (rate < slow || rate > fast))
    doubts.push_back({at + ".ki", fmt::format("{:.4g}, {:.3g} 1/s of kp_s", gains.ki, rate),
                      fmt::format("{:g} to {:g} 1/s of it", slow, fast), "look at the units of both: rad/(rad/s), rad/rad"});
  if (gains.schedule_linear_deg && *gains.schedule_linear_deg < least_degrees)
    doubts.push_back({at + ".schedule_linear_deg", fmt::format("{:.4g} degrees", *gains.schedule_linear_deg),
                      fmt::format("{:g} degree or more", least_degrees), "in radians? give degrees"});
}

/// Pitch drives of 0.5 to 22 MW turn by 2 to 15 degrees in a second, within a second or so; the speed is filtered as fast.
void doubt_pitch_drive(scene::Doubts& doubts, const std::string& at, const ControllerOptions& c) {
  constexpr double least_rate = 0.5, least_pitch = 10.0, least_Hz = 0.05;
  if (const double rate = c.max_pitch_rate / radians_per_degree; rate < least_rate)
    doubts.push_back({at + ".max_pitch_rate_deg_s", fmt::format("{:.4g} degrees per second", rate),
                      fmt::format("{:g} or more: 2 to 15", least_rate), "in radians? give degrees per second"});
  if (const double pitch = c.max_pitch / radians_per_degree; pitch < least_pitch)
    doubts.push_back({at + ".max_pitch_deg", fmt::format("{:.4g} degrees", pitch),
                      fmt::format("{:g} or more: storms want 20 to 90", least_pitch), "in radians? give degrees"});
  for (const auto& [key, frequency] : {std::pair{".filter_frequency_Hz", c.filter_frequency_Hz},
                                       std::pair{".servo_frequency_Hz", c.servo_frequency_Hz.value_or(1.0)}})
    if (frequency < least_Hz)
      doubts.push_back({at + key, fmt::format("{:.4g} Hz", frequency), fmt::format("{:g} Hz or more", least_Hz),
                        "slower than the gusts that it is for; look at its unit: Hz"});
}

/// What turns at rated speed holds rated power for 3 to 12 s (inertia constants of turbines of 1 to 22 MW); small ones less.
void doubt_drive_train(scene::Doubts& doubts, const std::string& at, const ControllerOptions& c) {
  constexpr double least_s = 0.3, most_s = 60.0, least_share = 0.2, most_share = 5.0;
  const double held = 0.5 * c.rotor_inertia_kg_m2 * c.rated_speed * c.rated_speed / c.rated_power_W;
  if (held < least_s || held > most_s)
    doubts.push_back({at + ".rotor_inertia_kg_m2",
                      fmt::format("{:.4g} kg m2, which holds rated power for {:.3g} s", c.rotor_inertia_kg_m2, held),
                      fmt::format("{:g} to {:g} s", least_s, most_s),
                      "look at its unit, kg m2, and at those of power and speed"});
  if (c.generator_inertia_kg_m2 > c.rotor_inertia_kg_m2)
    doubts.push_back({at + ".generator_inertia_kg_m2",
                      fmt::format("{:.4g} kg m2 beside a rotor of {:.4g}", c.generator_inertia_kg_m2, c.rotor_inertia_kg_m2),
                      "less than that of the rotor", "on the low-speed shaft: times the ratio of the gear squared, once"});
  if (constexpr double most = 100.0; c.torque_kp_N_m_s * c.rated_speed > most * c.max_torque_N_m)
    doubts.push_back({at + ".torque_kp_N_m_s",
                      fmt::format("{:.4g} N m s, {:.3g} of the largest torque for an excess of all of the rated speed",
                                  c.torque_kp_N_m_s, c.torque_kp_N_m_s * c.rated_speed / c.max_torque_N_m),
                      fmt::format("up to {:g} of it: 4.6 of the DTU 10 MW", most),
                      "look at its unit, for rad/s of the low-speed shaft"});
  if (!c.torque_gain_N_m_s2) return;
  const double share = *c.torque_gain_N_m_s2 * std::pow(c.rated_speed, 3) * c.generator_efficiency / c.rated_power_W;
  if (share < least_share || share > most_share)
    doubts.push_back({at + ".torque_gain_N_m_s2",
                      fmt::format("{:.4g} N m s2, {:.3g} of rated power at rated speed", *c.torque_gain_N_m_s2, share),
                      fmt::format("{:g} to {:g} of it", least_share, most_share),
                      "for rad/s on the low-speed shaft: not rpm, not the generator's"});
}

DriveTrainOptions drive_train(const ControlOptions& control) {
  return control.model == ControlModel::library ? *control.drive_train : read_controller(control.file);
}

/// Beyond its edge a curve holds: blades at feather brake by no more than at its largest pitch.
void doubt_curve(scene::Doubts& doubts, const ControlOptions& control, const std::string& curve) {
  constexpr double near_feather = 20.0 * radians_per_degree;
  const std::vector<double> pitches = pitches_of(curve);
  const double feather = drive_train(control).feather;
  const bool feathers =
      control.start == ControlStart::parked ||
      std::ranges::any_of(control.events, [](const EventOptions& event) { return event.what != ControlEvent::blade_stuck; });
  if (pitches.size() < 2)
    doubts.push_back({"aero.curve", "coefficients at one blade pitch", "several, from the least to feather",
                      "pitch changes nothing: above rated wind the rotor runs away, and no event stops it"});
  else if (feathers && pitches.back() < feather - near_feather)
    doubts.push_back({"aero.curve",
                      fmt::format("pitches up to {:.4g} degrees, with blades that feather at {:.4g}",
                                  pitches.back() / radians_per_degree, feather / radians_per_degree),
                      "pitches up to feather", "beyond its last pitch the curve stays as it is, and the rotor may not stop"});
}

}  // namespace

scene::Doubts operation_doubts(const std::string& path, double radius) {
  scene::Doubts doubts;
  if (radius <= 0.0) return doubts;
  const Operation table = read_operation(path);
  const std::string at = std::filesystem::path(path).filename();
  doubt_tips(doubts, at + ".speed_rpm", std::ranges::max(table.speed), radius);
  if (table.power.empty()) return doubts;
  doubt_rating(doubts, at + ".power_W", std::ranges::max(table.power), radius);
  constexpr double near_rated = 0.99, most_wind = 20.0, betz = 16.0 / 27.0, dense = 1.225;
  const std::size_t rated = table.first_above(near_rated);
  if (rated < table.wind.size() && table.wind[rated] > most_wind)
    doubts.push_back({at + ".wind_m_s", fmt::format("rated power at {:.4g} m/s", table.wind[rated]),
                      fmt::format("up to {:g} m/s: turbines have it at 9 to 15", most_wind), "in km/h or knots? give m/s"});
  for (std::size_t n = 0; n < table.wind.size(); ++n) {
    const double coefficient = table.power[n] / (0.5 * dense * pi * radius * radius * std::pow(table.wind[n], 3));
    if (coefficient <= 1.1 * betz || table.wind[n] <= 0.0) continue;
    doubts.push_back({at, fmt::format("a power coefficient of {:.3g} at {:.4g} m/s", coefficient, table.wind[n]),
                      "up to 16/27 (Betz 1920)", "look at the units of power and wind, W and m/s, and at the blades' length"});
    break;
  }
  if (rated < table.wind.size()) doubt_pitch(doubts, at, table, rated);
  return doubts;
}

scene::Doubts controller_doubts(const std::string& path, double radius) {
  scene::Doubts doubts;
  const ControllerOptions c = read_controller(path);
  const std::string at = std::filesystem::path(path).filename();
  if (radius > 0.0) {
    doubt_rating(doubts, at + ".rated_power_W", c.rated_power_W, radius);
    doubt_tips(doubts, at + ".rated_speed_rpm", c.rated_speed, radius);
  }
  doubt_drive_train(doubts, at, c);
  doubt_pitch_drive(doubts, at, c);
  doubt_gains(doubts, at + ".gains", c.gains, c.rated_speed);
  if (c.floating_gains) doubt_gains(doubts, at + ".floating_gains", *c.floating_gains, c.rated_speed);
  return doubts;
}

scene::Doubts control_doubts(const ControlOptions& control, const std::string& curve) {
  scene::Doubts doubts;
  if (control.model != ControlModel::none && !curve.empty()) doubt_curve(doubts, control, curve);
  const bool library = control.model == ControlModel::library;
  for (std::size_t i = 0; i < control.events.size(); ++i)
    if (control.events[i].what == ControlEvent::emergency_stop && !(drive_train(control).brake_torque_N_m > 0.0))
      doubts.push_back({fmt::format("control.events[{}]", i), "emergency_stop with a brake of 0 N m",
                        fmt::format("brake_torque_N_m above 0 in {}", library ? "control.drive_train" : control.file),
                        "without a brake it is a grid_loss: the blades alone slow the rotor down"});
  const auto first = std::ranges::min_element(control.events, {}, &EventOptions::time_s);
  if (first != control.events.end() && first->what == ControlEvent::start_up && control.model == ControlModel::dtu &&
      control.start == ControlStart::operating)
    doubts.push_back({fmt::format("control.events[{}]", first - control.events.begin()), "start_up of a turbine that operates",
                      "control.start = \"parked\"", "it starts at its operating point, and the event does nothing"});
  return doubts;
}

}  // namespace spindrift::aero
