// Numbers in named columns from a text file (comma-separated, '#' comments): the data files that scenes name.
// Used by the options of src/moorings and src/aero; tested in tests/src/scene/columns_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spindrift::scene {

/// A table read whole: a header line of names, then rows of as many finite numbers. Errors are SceneErrors with file and line.
class Columns {
 public:
  /// Checked already.
  struct Table {
    std::string file;
    std::vector<std::string> names;
    std::vector<std::vector<double>> values;  ///< by column
    std::vector<int> lines;                   ///< of each row in the file
  };
  explicit Columns(Table table) : table_(std::move(table)) {}

  const std::string& file() const { return table_.file; }
  std::size_t rows() const { return table_.lines.size(); }
  bool has(std::string_view name) const;
  /// The column `name`; fails, naming the columns there are, where it is missing.
  std::span<const double> operator[](std::string_view name) const;

  /// Fails unless every value is above the one before, by the rule `why`.
  void require_increasing(std::string_view name, const std::string& why) const;
  /// Fails unless there are at least `count` rows.
  void require_rows(std::size_t count) const;
  /// Fails where a column has another name than these.
  void allow_only(const std::vector<std::string>& names) const;
  /// Throws a SceneError about one row of a column, or about the file (row < 0).
  [[noreturn]] void fail(int row, const std::string& message) const;

 private:
  Table table_;
};

Columns read_columns(const std::string& path);
/// From a file of other programs: a line of title, then numbers parted by blanks, in columns that have these names.
Columns read_blank_columns(const std::string& path, std::vector<std::string> names);

}  // namespace spindrift::scene
