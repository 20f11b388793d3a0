// SPDX-License-Identifier: Apache-2.0
#include "src/scene/range.hpp"

#include <cmath>

#include "src/scene/value.hpp"

namespace spindrift::scene {

namespace {
/// 1000 rather than 1000.0: limits are read by people.
std::string plain(double x) {
  std::string text = toml_number(x);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}
}  // namespace

bool Range::bounded() const { return std::isfinite(low) || std::isfinite(high); }

bool Range::contains(double x) const {
  return std::isfinite(x) && (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

std::string Range::describe(const std::string& unit) const {
  std::string text;
  if (std::isfinite(low)) text += (low_open ? "> " : ">= ") + plain(low);
  if (std::isfinite(high)) text += (text.empty() ? "" : " and ") + std::string(high_open ? "< " : "<= ") + plain(high);
  if (text.empty()) text = "finite";
  return unit.empty() || unit == "-" || !bounded() ? text : text + " " + unit;
}

}  // namespace spindrift::scene
