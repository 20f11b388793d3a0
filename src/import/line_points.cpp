// SPDX-License-Identifier: Apache-2.0
#include "src/import/line_points.hpp"

#include <algorithm>
#include <cctype>

namespace spindrift::decks {

std::size_t words_of_point(const Deck& file, std::size_t heading) { return std::max<std::size_t>(5, file.words(heading).size()); }

std::string in_lower_case(std::string word) {
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return word;
}

double require_not_negative(const Deck& file, std::size_t line, const std::string& what, double value) {
  if (value < 0.0) file.fail(line, fmt::format("has {} = {:g}, which is negative", what, value));
  return value;
}

PointKind LinePoint::kind() const {
  if (type.rfind("fix", 0) == 0 || type == "anchor") return PointKind::fixed;
  if (type.rfind("vessel", 0) == 0 || type.rfind("coupled", 0) == 0 || type.rfind("body", 0) == 0) return PointKind::moved;
  if (type == "connect" || type == "con" || type == "free" || type == "point") return PointKind::free;
  return PointKind::unknown;
}

ImportedJunction free_point(const std::string& id, const Eigen::Vector3d& at) {
  std::string name = "junction_";
  for (const char c : id) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return {name, at};
}

double length_of(const Deck& file, std::size_t line, const std::string& word, const std::string& a, const std::string& b) {
  const double length = file.to_number(word, line);
  if (!(length > 0.0)) file.fail(line, fmt::format("has a line of {} m: its length must be above zero", word));
  if (a == b) file.fail(line, fmt::format("has a line from {} to itself", a));
  return length;
}

bool place_ends(ImportedLine& line, LinePoint a, LinePoint b) {
  if (a.kind() == PointKind::moved || b.kind() == PointKind::fixed) std::swap(a, b);
  const PointKind anchor = a.kind(), fairlead = b.kind();
  if (anchor == PointKind::moved || fairlead == PointKind::fixed || anchor == PointKind::unknown ||
      fairlead == PointKind::unknown)
    return false;
  line.anchor = a.point.at, line.fairlead = b.point.at;
  if (anchor == PointKind::free) line.at_anchor = a.point.name;
  if (fairlead == PointKind::free) line.at_fairlead = b.point.name;
  return true;
}

std::string not_tied(const Deck& file, const std::string& line, const LinePoint& a, const LinePoint& b) {
  return fmt::format("{}: line {} ties {} to {}; lines between the bed, the platform and free points alone are carried over",
                     file.file().filename().string(), line, a.type, b.type);
}

std::vector<ImportedJunction> junctions_of(const std::vector<ImportedLine>& lines,
                                           const std::map<std::string, LinePoint>& points) {
  std::vector<ImportedJunction> found;
  for (const auto& [id, p] : points)
    if (p.kind() == PointKind::free && std::ranges::any_of(lines, [&](const ImportedLine& l) {
          return l.at_anchor == p.point.name || l.at_fairlead == p.point.name;
        }))
      found.push_back(p.point);
  return found;
}

}  // namespace spindrift::decks
