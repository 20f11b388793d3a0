// SPDX-License-Identifier: Apache-2.0
#include "src/aero/thrust_curve.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

namespace {

std::vector<double> sorted_unique(std::span<const double> values) {
  std::vector<double> nodes(values.begin(), values.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The torque column of a table by whichever of its names is there; at most one.
std::string one_of(const scene::Columns& file, const std::vector<std::string>& names, bool required) {
  std::string found;
  for (const std::string& name : names) {
    if (!file.has(name)) continue;
    if (!found.empty()) file.fail(-1, fmt::format("gives both {} and {}: keep one", found, name));
    found = name;
  }
  if (required && found.empty()) file.fail(-1, fmt::format("needs one of the columns {}", fmt::join(names, ", ")));
  return found;
}

}  // namespace

ThrustCurve::ThrustCurve(const AeroOptions& aero, const RotorOptions& rotor, double air_density)
    : radius_(0.5 * rotor.diameter_m.value()),
      pressure_area_(0.5 * air_density * pi * radius_ * radius_),
      constant_{aero.thrust_coefficient.value_or(0.0), aero.torque_coefficient} {
  if (aero.curve.empty()) return;
  if (scene::read_columns(aero.curve).has("tip_speed_ratio"))
    read_against_tip_speed(aero);
  else
    read_against_wind(aero);
}

void ThrustCurve::read_against_wind(const AeroOptions& aero) {
  const scene::Columns file = scene::read_columns(aero.curve);
  file.allow_only({"wind_m_s", "thrust_N", "ct", "torque_N_m", "power_W", "cp", "cq", "speed_rpm", "blade_pitch_deg"});
  file.require_rows(2);
  file.require_increasing("wind_m_s", "wind speed");
  const auto wind = file["wind_m_s"];
  if (wind[0] <= 0.0) file.fail(0, "wind_m_s must be positive");
  const std::string thrust = one_of(file, {"thrust_N", "ct"}, true);
  const std::string torque = one_of(file, {"torque_N_m", "power_W", "cp", "cq"}, false);
  for (std::size_t i = 0; i < wind.size(); ++i) {
    const double pressure_force = pressure_area_ * wind[i] * wind[i];
    wind_.push_back(wind[i]);
    ct_.push_back(thrust == "ct" ? file["ct"][i] : file["thrust_N"][i] / pressure_force);
    if (torque.empty()) {
      cq_.push_back(0.0);
    } else if (torque == "cq" || torque == "torque_N_m") {
      cq_.push_back(torque == "cq" ? file["cq"][i] : file["torque_N_m"][i] / (pressure_force * radius_));
    } else {
      const double speed = file["speed_rpm"][i] * rad_s_per_rpm;
      if (speed <= 0.0) file.fail(int(i), fmt::format("speed_rpm must be positive to turn {} into a torque", torque));
      const double cp = torque == "cp" ? file["cp"][i] : file["power_W"][i] / (pressure_force * wind[i]);
      cq_.push_back(cp * wind[i] / (speed * radius_));
    }
  }
  if (aero.interpolation == "cubic") {
    ct_slope_.resize(wind_.size()), cq_slope_.resize(wind_.size());
    monotone_slopes(wind_, ct_, ct_slope_);
    monotone_slopes(wind_, cq_, cq_slope_);
  }
}

void ThrustCurve::read_against_tip_speed(const AeroOptions& aero) {
  const scene::Columns file = scene::read_columns(aero.curve);
  file.allow_only({"tip_speed_ratio", "blade_pitch_deg", "ct", "cp", "cq"});
  const auto ratio = file["tip_speed_ratio"], ct = file["ct"];
  const std::string torque = one_of(file, {"cp", "cq"}, false);
  const std::vector<double> no_pitch(file.rows(), 0.0);
  const auto pitch = file.has("blade_pitch_deg") ? file["blade_pitch_deg"] : std::span<const double>(no_pitch);
  tip_speed_ratio_ = sorted_unique(ratio);
  pitch_ = sorted_unique(pitch);
  const std::size_t columns = tip_speed_ratio_.size();
  if (columns < 2 || tip_speed_ratio_.front() <= 0.0) file.fail(-1, "needs at least two tip_speed_ratio values, all positive");
  if (file.rows() != columns * pitch_.size())
    file.fail(-1, fmt::format("has {} rows; {} tip_speed_ratio values times {} blade_pitch_deg values need {}", file.rows(),
                              columns, pitch_.size(), columns * pitch_.size()));
  ct_.assign(file.rows(), std::nan(""));
  cq_.assign(file.rows(), 0.0);
  for (std::size_t row = 0; row < file.rows(); ++row) {
    const auto at = [](const std::vector<double>& nodes, double x) {
      return std::size_t(std::lower_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
    };
    const std::size_t i = at(pitch_, pitch[row]) * columns + at(tip_speed_ratio_, ratio[row]);
    if (!std::isnan(ct_[i])) file.fail(int(row), "repeats a pair of tip_speed_ratio and blade_pitch_deg");
    ct_[i] = ct[row];
    if (!torque.empty()) cq_[i] = torque == "cq" ? file["cq"][row] : file["cp"][row] / ratio[row];
  }
  for (double& p : pitch_) p *= radians_per_degree;
}

Coefficients ThrustCurve::coefficients(double wind, double speed, double blade_pitch) const {
  if (ct_.empty()) return constant_;
  if (tip_speed_ratio_.empty()) {
    const double inside = std::clamp(std::abs(wind), wind_.front(), wind_.back());
    if (ct_slope_.empty()) return {interpolate_linear(wind_, ct_, inside), interpolate_linear(wind_, cq_, inside)};
    return {interpolate_hermite(wind_, ct_, ct_slope_, inside).value, interpolate_hermite(wind_, cq_, cq_slope_, inside).value};
  }
  const double tip_speed = std::abs(speed) * radius_, most = tip_speed_ratio_.back();
  const double ratio = tip_speed < most * std::abs(wind) ? tip_speed / std::abs(wind) : most;
  return {interpolate_bilinear(tip_speed_ratio_, pitch_, ct_, ratio, blade_pitch),
          interpolate_bilinear(tip_speed_ratio_, pitch_, cq_, ratio, blade_pitch)};
}

std::vector<double> pitches_of(const std::string& curve) {
  const scene::Columns file = scene::read_columns(curve);
  if (!file.has("tip_speed_ratio")) return {};
  if (!file.has("blade_pitch_deg")) return {0.0};
  std::vector<double> pitches = sorted_unique(file["blade_pitch_deg"]);
  for (double& pitch : pitches) pitch *= radians_per_degree;
  return pitches;
}

AxialLoad ThrustCurve::operator()(double wind, double speed, double blade_pitch) const {
  const Coefficients c = coefficients(wind, speed, blade_pitch);
  const double force = pressure_area_ * std::abs(wind) * wind;
  return {force * c.thrust, force * radius_ * c.torque};
}

}  // namespace spindrift::aero
