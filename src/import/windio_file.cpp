// SPDX-License-Identifier: Apache-2.0
#include "src/import/windio_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/scene/error.hpp"

namespace spindrift::decks {

void Key::fail(const std::string& what) const {
  const YAML::Mark mark = node_.Mark();
  std::string value = node_.IsScalar() ? node_.Scalar() : "";
  throw scene::SceneError({{file_.string(), mark.is_null() ? 0 : mark.line + 1, name_, value.substr(0, 60), what}});
}

bool Key::has(const std::string& key) const {
  require_map();
  return bool(node_[key]) && !node_[key].IsNull();
}

Key Key::at(const std::string& key) const {
  if (!has(key)) fail(fmt::format("has no \"{}\"", key));
  return {file_, node_[key], name_.empty() ? key : name_ + "." + key};
}

std::vector<Key> Key::entries() const {
  if (!node_.IsSequence() || node_.size() == 0) fail("must be a list of at least one entry");
  std::vector<Key> all;
  for (std::size_t i = 0; i < node_.size(); ++i) all.push_back({file_, node_[i], fmt::format("{}[{}]", name_, i)});
  return all;
}

double Key::number() const {
  double value = 0.0;
  if (!node_.IsScalar() || !YAML::convert<double>::decode(node_, value) || !std::isfinite(value)) fail("must be a number");
  return value;
}

double Key::positive() const {
  const double value = number();
  if (value <= 0.0) fail("must be > 0");
  return value;
}

double Key::angle() const {
  const double value = number();
  if (std::abs(value) > 0.5 * pi) fail("must be an angle in radians, within -pi/2 and pi/2 (windIO 1.x)");
  return value;
}

int Key::count() const {
  const double value = number();
  if (value < 1.0 || value > 12.0 || value != std::floor(value)) fail("must be a whole number from 1 to 12");
  return int(value);
}

std::string Key::text() const {
  if (!node_.IsScalar()) fail("must be a word");
  return node_.Scalar();
}

void Key::require_map() const {
  if (!node_.IsMap()) fail("must be a table of keys");
}

double Curve::at(double position) const { return interpolate_linear(x, y, position); }

std::vector<double> numbers(const Key& list) {
  std::vector<double> values;
  for (const Key& entry : list.entries()) values.push_back(entry.number());
  return values;
}

void require_increasing(const Key& grid, const std::vector<double>& x) {
  if (x.size() < 2) grid.fail("must have at least two entries");
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i] <= x[i - 1]) grid.entries()[i].fail(fmt::format("must be more than the entry before it, {:g}", x[i - 1]));
}

Curve curve(const Key& key) {
  Curve c{numbers(key.at("grid")), numbers(key.at("values"))};
  require_increasing(key.at("grid"), c.x);
  if (c.x.size() != c.y.size()) key.at("values").fail(fmt::format("has {} entries, grid has {}", c.y.size(), c.x.size()));
  return c;
}

void require_whole_span(const Key& grid, const std::vector<double>& x) {
  if (x.front() != 0.0 || x.back() != 1.0)
    grid.fail(fmt::format("must go from 0 to 1, goes from {:g} to {:g}", x.front(), x.back()));
}

Curve along_span(const Key& key) {
  Curve c = curve(key);
  require_whole_span(key.at("grid"), c.x);
  return c;
}

Key load_windio(const std::filesystem::path& file) {
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) throw scene::SceneError({{file.string(), 0, "", "", "is a directory"}});
  try {
    return {file, YAML::LoadFile(file.string())};
  } catch (const YAML::BadFile&) {
    throw scene::SceneError({{file.string(), 0, "", "", "cannot be read"}});
  } catch (const YAML::ParserException& e) {
    throw scene::SceneError({{file.string(), e.mark.line + 1, "", "", "is no YAML: " + e.msg}});
  }
}

}  // namespace spindrift::decks
