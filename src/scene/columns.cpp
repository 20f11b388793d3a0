// SPDX-License-Identifier: Apache-2.0
#include "src/scene/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "src/scene/error.hpp"

namespace spindrift::scene {

namespace {

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

std::vector<std::string_view> split_at_blanks(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t from = 0; (from = line.find_first_not_of(" \t\r", from)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", from), line.size());
    cells.push_back(line.substr(from, end - from));
    from = end;
  }
  return cells;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t comma = std::min(line.find(',', from), line.size());
    cells.push_back(trim(line.substr(from, comma - from)));
    from = comma + 1;
  }
  return cells;
}

std::optional<double> finite_number(std::string_view cell) {
  double value = 0.0;
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) return {};
  return value;
}

[[noreturn]] void fail_at(const std::string& file, int line, const std::string& value, const std::string& message) {
  throw SceneError({Problem{.source = file, .line = line, .key = "", .value = value, .message = message}});
}

}  // namespace

namespace {

/// What spreadsheets put before the text: UTF-8's mark is skipped, UTF-16 is not read.
void skip_mark(const std::string& file, std::string& first_line) {
  if (first_line.starts_with("\xEF\xBB\xBF")) first_line.erase(0, 3);
  if (first_line.starts_with("\xFF\xFE") || first_line.starts_with("\xFE\xFF"))
    fail_at(file, 1, "", "is text in UTF-16: save it in UTF-8");
}

/// A spreadsheet, a program or a picture where a table in text should be.
void require_text(const std::string& file, int line, const std::string& text) {
  if (text.find('\0') != std::string::npos) fail_at(file, line, "", "is no text: save the table as text (CSV in UTF-8)");
}

/// Other ways to write a table, told by name.
void require_commas(const std::string& file, int line, std::string_view header) {
  const char* wrong = header.find(';') != std::string_view::npos    ? "semicolons"
                      : header.find(',') != std::string_view::npos  ? nullptr
                      : header.find('\t') != std::string_view::npos ? "tabs"
                      : header.find(' ') != std::string_view::npos  ? "blanks"
                                                                    : nullptr;
  if (wrong != nullptr)
    fail_at(file, line, "",
            fmt::format("has {} between its columns: write commas between columns, and points in numbers", wrong));
}

void add_row(Columns::Table& table, const std::vector<std::string_view>& cells, int line) {
  if (cells.size() != table.names.size())
    fail_at(table.file, line, "",
            fmt::format(
                "has {} values where there are {} columns ({}){}", cells.size(), table.names.size(), fmt::join(table.names, ", "),
                cells.size() == 2 * table.names.size() ? "; decimal commas? write points: 0.5, not 0,5"
                : cells.size() == 1 && cells[0].find(',') != std::string_view::npos ? "; write blanks between numbers, not commas"
                                                                                    : ""));
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::optional<double> value = finite_number(cells[c]);
    if (!value)
      fail_at(table.file, line, fmt::format("\"{}\"", cells[c]),
              fmt::format("must be a finite number (column {}){}", table.names[c],
                          cells[c].find(',') != std::string_view::npos ? "; write a decimal point, not a comma" : ""));
    table.values[c].push_back(*value);
  }
  table.lines.push_back(line);
}

}  // namespace

Columns read_columns(const std::string& path) {
  std::ifstream in(path);
  if (!in) fail_at(path, 0, "", "cannot be read");
  Columns::Table table;
  table.file = path;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (line == 1) skip_mark(path, text);
    require_text(path, line, text);
    const std::string_view content = trim(std::string_view(text).substr(0, text.find('#')));
    if (content.empty()) continue;
    const auto cells = split(content);
    if (table.names.empty()) {
      require_commas(path, line, content);
      table.names.assign(cells.begin(), cells.end());
      for (std::size_t c = 1; c < table.names.size(); ++c)
        if (std::find(table.names.begin(), table.names.begin() + std::ptrdiff_t(c), table.names[c]) !=
            table.names.begin() + std::ptrdiff_t(c))
          fail_at(path, line, "", fmt::format("has two columns \"{}\": which of them holds?", table.names[c]));
      table.values.resize(cells.size());
    } else {
      add_row(table, cells, line);
    }
  }
  if (table.names.empty()) fail_at(path, 0, "", "holds no table: a header line of column names, then rows of numbers");
  return Columns(std::move(table));
}

Columns read_blank_columns(const std::string& path, std::vector<std::string> names) {
  std::ifstream in(path);
  std::string text;
  if (!in || !std::getline(in, text)) fail_at(path, 0, "", "cannot be read");
  Columns::Table table;
  table.file = path;
  table.names = std::move(names);
  table.values.resize(table.names.size());
  skip_mark(path, text);
  require_text(path, 1, text);
  // A title, unless it is a row like those that follow.
  if (const auto cells = split_at_blanks(text);
      cells.size() == table.names.size() && std::ranges::all_of(cells, [](auto cell) { return finite_number(cell).has_value(); }))
    add_row(table, cells, 1);
  for (int line = 2; std::getline(in, text); ++line)
    if (const auto cells = split_at_blanks(text); !cells.empty()) add_row(table, cells, line);
  return Columns(std::move(table));
}

bool Columns::has(std::string_view name) const {
  return std::find(table_.names.begin(), table_.names.end(), name) != table_.names.end();
}

std::span<const double> Columns::operator[](std::string_view name) const {
  const auto found = std::find(table_.names.begin(), table_.names.end(), name);
  if (found == table_.names.end()) fail(-1, fmt::format("needs a column \"{}\"; has {}", name, fmt::join(table_.names, ", ")));
  return table_.values[found - table_.names.begin()];
}

void Columns::require_increasing(std::string_view name, const std::string& why) const {
  const auto x = (*this)[name];
  for (std::size_t i = 1; i < x.size(); ++i)
    if (!(x[i] > x[i - 1]))
      fail(int(i), fmt::format("{} = {} must be above {} of the row before ({})", name, x[i], x[i - 1], why));
}

void Columns::require_rows(std::size_t count) const {
  if (rows() < count) fail(-1, fmt::format("needs at least {} rows of numbers, has {}", count, rows()));
}

void Columns::allow_only(const std::vector<std::string>& names) const {
  for (const std::string& name : table_.names)
    if (std::find(names.begin(), names.end(), name) == names.end())
      fail(-1, fmt::format("has a column \"{}\" that means nothing here; known: {}", name, fmt::join(names, ", ")));
}

void Columns::fail(int row, const std::string& message) const {
  fail_at(table_.file, row < 0 ? 0 : table_.lines[row], "", message);
}

}  // namespace spindrift::scene
