// What the readers of line files share: tables, points, and the ends of lines. Of map_lines.cpp and moordyn_lines.cpp alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "src/import/line_files.hpp"

namespace spindrift::decks {

/// A table has ended: at the next rule, or at a line without words.
inline bool ends_table(const Deck& file, std::size_t line) { return file.words(line).empty() || file.is_rule(line); }

/// Calls `row` with line and words; a heading of names and one of units stand above the rows.
template <class Row>
void each_row(const Deck& file, std::size_t heading, const Row& row) {
  for (std::size_t n = heading + 2; n < file.size() && !ends_table(file, n); ++n) row(n, file.words(n));
}

/// Words of a row of points: those of its heading, name, kind and place at least.
std::size_t words_of_point(const Deck& file, std::size_t heading);

std::string in_lower_case(std::string word);

/// Puts an entry of a table into its map; a name that comes twice is refused.
template <class T>
void enter(const Deck& file, std::size_t line, std::map<std::string, T>& table, const std::string& name, T entry) {
  if (!table.emplace(name, std::move(entry)).second) file.fail(line, fmt::format("has the name {} of a row before", name));
}

double require_not_negative(const Deck& file, std::size_t line, const std::string& what, double value);

/// A point of a line file.
enum class PointKind { fixed, moved, free, unknown };
struct LinePoint {
  std::string type;        ///< the file's word, in lower case
  ImportedJunction point;  ///< name and values of a free one
  PointKind kind() const;
};
ImportedJunction free_point(const std::string& id, const Eigen::Vector3d& at);

/// Unstretched length of a row of lines [m], between the points `a` and `b`.
double length_of(const Deck& file, std::size_t line, const std::string& word, const std::string& a, const std::string& b);

/// Ends of a line: the anchor is what is fixed, the fairlead what moves with the platform; a free point takes the other end.
/// False where the line ties the bed to the bed, the platform to itself, or something unknown: not_tied() says so.
bool place_ends(ImportedLine& line, LinePoint a, LinePoint b);
std::string not_tied(const Deck& file, const std::string& line, const LinePoint& a, const LinePoint& b);

/// The free points that lines end at.
std::vector<ImportedJunction> junctions_of(const std::vector<ImportedLine>& lines,
                                           const std::map<std::string, LinePoint>& points);

}  // namespace spindrift::decks
