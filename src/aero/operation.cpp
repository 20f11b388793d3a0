// SPDX-License-Identifier: Apache-2.0
#include "src/aero/operation.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

OperatingPoint Operation::at(double wind_m_s) const {
  return {interpolate_linear(wind, speed, wind_m_s), pitch.empty() ? 0.0 : interpolate_linear(wind, pitch, wind_m_s)};
}

std::optional<double> Operation::torque_gain() const {
  if (power.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  double sum = 0.0;
  int rows = 0;
  for (std::size_t i = 0; i < wind.size(); ++i)
    if (speed[i] > *least * (1.0 + 1e-6) && speed[i] < *most * (1.0 - 1e-6))
      sum += power[i] / (speed[i] * speed[i] * speed[i]), ++rows;
  if (rows == 0) return std::nullopt;
  return sum / rows;
}

std::size_t Operation::first_above(double share) const {
  const std::vector<double>& rises = power.empty() ? speed : power;
  const double least = share * std::ranges::max(rises);
  return std::size_t(std::ranges::find_if(rises, [&](double value) { return value > least; }) - rises.begin());
}

Operation Operation::below_rated() const {
  constexpr double rated_share = 0.995;  // of the largest: rows above it are rated but for the table's round-off
  Operation below;
  for (std::size_t i = 0, rows = first_above(rated_share); i < rows; ++i) {
    below.wind.push_back(wind[i]), below.speed.push_back(speed[i]);
    if (!pitch.empty()) below.pitch.push_back(pitch[i]);
    if (!power.empty()) below.power.push_back(power[i]);
  }
  return below;
}

Operation read_operation(const std::string& path) {
  const scene::Columns table = scene::read_columns(path);
  table.require_rows(1);
  table.require_increasing("wind_m_s", "wind must increase from row to row");
  const auto column = [&](const char* name, double unit) {
    std::vector<double> values(table[name].begin(), table[name].end());
    for (double& v : values) v *= unit;
    return values;
  };
  Operation operation{column("wind_m_s", 1.0), column("speed_rpm", rad_s_per_rpm), {}, {}};
  if (table.has("blade_pitch_deg")) operation.pitch = column("blade_pitch_deg", radians_per_degree);
  if (table.has("power_W")) operation.power = column("power_W", 1.0);
  for (std::size_t i = 0; i < operation.speed.size(); ++i)
    if (operation.speed[i] < 0.0) table.fail(int(i), "speed_rpm must not be negative");
  return operation;
}

}  // namespace spindrift::aero
