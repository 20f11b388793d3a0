// SPDX-License-Identifier: Apache-2.0
#include "src/scene/angle_doubts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "kernels/base/constants.hpp"
#include "src/scene/toml_reader.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

namespace {

bool is_near(double x, double wanted, double share) { return std::abs(x - wanted) <= share * std::abs(wanted); }

/// The round number of degrees that so many radians are, if they are one.
std::optional<double> round_degrees(double radians) {
  const double degrees = std::abs(radians) / radians_per_degree;
  for (const auto& [three_digits, angle] : {std::pair{0.785, 45.0}, std::pair{1.57, 90.0}, std::pair{3.14, 180.0}})
    if (is_near(std::abs(radians), three_digits, 1e-9)) return std::copysign(angle, radians);
  const double grain = degrees < 10.0 ? 0.5 : degrees < 30.0 ? 1.0 : 5.0, share = degrees < 30.0 ? 1e-3 : 3e-4;
  const double round = grain * std::round(degrees / grain);
  if (round == 0.0 || round > 180.0 || !is_near(degrees, round, share)) return std::nullopt;
  return std::copysign(round, radians);
}

/// Two digits say what degrees say too.
bool has_few_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(x))) - 1.0);
  return is_near(x, unit * std::round(x / unit), 1e-9);
}

void look(const Value& value, const std::string& key, Doubts& doubts) {
  if (value.is_table()) {
    for (const Value& child : value.children) look(child, key.empty() ? child.key : key + "." + child.key, doubts);
    return;
  }
  if (value.kind == Value::Kind::array) {
    if (!value.is_list_of_tables() && value.children.size() > 3) return;
    for (std::size_t n = 0; n < value.children.size(); ++n)
      look(value.children[n], value.is_list_of_tables() ? fmt::format("{}[{}]", key, n) : key, doubts);
    return;
  }
  if (value.kind != Value::Kind::number || !key.ends_with("_deg") || key.find("phase") != std::string::npos) return;
  if (looks_like_radians(value.number)) doubts.push_back(doubt_of_angle(key, value.number));
}

}  // namespace

bool looks_like_radians(double degrees) {
  return degrees != 0.0 && !has_few_digits(degrees) && round_degrees(degrees).has_value();
}

Doubt doubt_of_angle(const std::string& key, double degrees) {
  return {key, fmt::format("{:.6g} degrees", degrees), "round numbers of degrees",
          fmt::format("in radians? that is {:g} degrees", *round_degrees(degrees))};
}

Doubts angle_doubts(const std::string& echo) {
  Doubts doubts;
  look(read_toml(echo, 0, "the scene"), "", doubts);
  return doubts;
}

}  // namespace spindrift::scene
