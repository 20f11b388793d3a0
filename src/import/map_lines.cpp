// Files of MAP++: lines in rest. SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>

#include "kernels/base/constants.hpp"
#include "src/import/line_points.hpp"

namespace spindrift::decks {

namespace {

/// Line of the first heading of a section below: the one whose first word is this, or "ID" as files have it of late.
std::size_t heading_of(const Deck& file, std::size_t from, const std::string& first_word) {
  for (std::size_t n = from; n < file.size(); ++n)
    if (!file.words(n).empty() && (file.words(n)[0] == first_word || file.words(n)[0] == "ID")) return n;
  file.fail(std::nullopt, "has no table that begins with " + first_word);
}

}  // namespace

ImportedMoorings read_map(const Deck& file, double depth, std::vector<std::string>& left_out) {
  const std::size_t types = heading_of(file, 0, "LineType"), nodes = heading_of(file, types, "Node"),
                    lines = heading_of(file, nodes + 1, "Line");
  struct Type {
    double diameter, mass, stiffness, friction;
  };
  std::map<std::string, Type> by_name;
  each_row(file, types, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, 5);
    for (std::size_t unused = 5; unused < w.size(); ++unused) file.to_number(w[unused], n);
    enter(file, n, by_name, w[0],
          Type{require_not_negative(file, n, "Diam", file.to_number(w[1], n)),
               require_not_negative(file, n, "MassDenInAir", file.to_number(w[2], n)),
               require_not_negative(file, n, "EA", file.to_number(w[3], n)), file.to_number(w[4], n)});
  });
  const std::string file_name = file.file().filename().string();
  std::map<std::string, LinePoint> by_number;
  each_row(file, nodes, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, words_of_point(file, nodes));
    // "#" marks what MAP++ looks for; a free node's place behind it is where the search begins.
    const auto value = [&](std::size_t column) {
      std::string word = w.size() > column ? w[column] : "0";
      if (!word.empty() && word[0] == '#') word = word.substr(1);
      return word == "depth" ? -depth : word.empty() && column > 4 ? 0.0 : file.to_number(word, n);
    };
    LinePoint node{in_lower_case(w[1]), free_point(w[0], {value(2), value(3), value(4)})};
    const Eigen::Vector3d force(value(7), value(8), value(9));
    node.point.mass = require_not_negative(file, n, "M", value(5)),
    node.point.volume = require_not_negative(file, n, "B", value(6));
    node.point.added_mass = 0.5;  // a sphere's
    if (node.kind() == PointKind::free && force.norm() > 0.0)
      left_out.push_back(fmt::format("{}: the force FX, FY, FZ on node {}", file_name, w[0]));
    enter(file, n, by_number, w[0], node);
  });
  std::vector<ImportedLine> found;
  each_row(file, lines, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, 5);
    if (!by_name.count(w[1])) file.fail(n, fmt::format("names line type '{}', which is not in the dictionary", w[1]));
    for (const std::string& node : {w[3], w[4]})
      if (!by_number.count(node)) file.fail(n, fmt::format("names node {}, which is not in the table of nodes", node));
    const Type& t = by_name[w[1]];
    ImportedLine line{{}, {}, length_of(file, n, w[2], w[3], w[4]), t.diameter, t.mass, t.stiffness, t.friction};
    line.meets_bed = std::none_of(w.begin() + 5, w.end(), [](const auto& flag) { return in_lower_case(flag) == "omit_contact"; });
    const LinePoint &a = by_number.at(w[3]), &b = by_number.at(w[4]);
    if (!place_ends(line, a, b)) return left_out.push_back(not_tied(file, w[0], a, b));
    found.push_back(line);
  });
  std::vector<ImportedJunction> junctions = junctions_of(found, by_number);
  // "repeat 120 240": all lines again, turned about z.
  const std::size_t once = found.size(), points_once = junctions.size();
  std::size_t turns = 0;
  for (std::size_t n = lines; n < file.size(); ++n) {
    const auto& w = file.words(n);
    if (w.empty() || w[0] != "repeat") continue;
    for (std::size_t k = 1; k < w.size(); ++k) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(file.to_number(w[k], n) * radians_per_degree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const auto renamed = [&](const std::string& name) { return name.empty() ? name : fmt::format("{}_{}", name, turns + 2); };
      for (std::size_t l = 0; l < once; ++l) {
        ImportedLine copy = found[l];
        copy.anchor = turn * copy.anchor, copy.fairlead = turn * copy.fairlead;
        copy.at_anchor = renamed(copy.at_anchor), copy.at_fairlead = renamed(copy.at_fairlead);
        found.push_back(copy);
      }
      for (std::size_t j = 0; j < points_once; ++j) {
        ImportedJunction copy = junctions[j];
        copy.at = turn * copy.at, copy.name = renamed(copy.name);
        junctions.push_back(copy);
      }
      ++turns;
    }
  }
  return {found, junctions};
}

}  // namespace spindrift::decks
