// SPDX-License-Identifier: Apache-2.0
#include "src/io/openfast_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "src/io/atomic_file.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

static_assert(std::endian::native == std::endian::little, "OpenFAST's files have the least byte first");

/// Whole lines of the file, split at commas; the heading first.
using Table = std::vector<std::vector<std::string_view>>;

Table table_of(std::string_view text) {
  Table rows;
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
    auto& row = rows.emplace_back();
    for (std::string_view line = text.substr(0, end);;) {
      const std::size_t comma = line.find(',');
      row.push_back(line.substr(0, comma));
      if (comma == std::string_view::npos) break;
      line.remove_prefix(comma + 1);
    }
    if (row.size() != rows.front().size()) rows.pop_back();
  }
  return rows;
}

std::vector<std::string> names(const Table& table) {
  std::vector<std::string> all{"Time"};
  for (std::size_t c = 1; c < table[0].size(); ++c) all.emplace_back(table[0][c]);
  return all;
}

std::vector<std::string> units(const Table& table, std::span<const Column> columns) {
  std::vector<std::string> all;
  for (const std::string_view name : table[0]) {
    const auto column = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
    std::string unit = column == columns.end() ? "-" : column->unit;
    std::replace(unit.begin(), unit.end(), ' ', '*');  // readers split at blanks
    all.push_back("(" + unit + ")");
  }
  return all;
}

std::string description(const std::string& title) { return "Written by Spindrift from history.csv: " + title; }

std::string text_of(const Table& table, std::span<const Column> columns, const std::string& title) {
  // Six lines, then names, then units.
  std::string out = fmt::format("\n{}\n\n\n\n\n{}\n{}\n", description(title), fmt::join(names(table), "\t"),
                                fmt::join(units(table, columns), "\t"));
  for (std::size_t r = 1; r < table.size(); ++r) out += fmt::format("{}\n", fmt::join(table[r], "\t"));
  return out;
}

double number_in(std::string_view text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

/// Packed value = scale * value + offset, over the whole range of 16 bits.
struct Packing {
  float scale = 1.0f, offset = 0.0f;
  std::int16_t operator()(double value) const {
    return std::int16_t(std::clamp(std::round(double(scale) * value + double(offset)), -32768.0, 32767.0));
  }
};

Packing packing_of(const Table& table, std::size_t column, std::size_t rows, const std::string& file) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t r = 1; r <= rows; ++r) {
    const double value = number_in(table[r][column]);
    if (!std::isfinite(value))
      throw MachineFailure(
          fmt::format("{}: {} at {} s is no finite number, which the binary format of OpenFAST cannot say; take "
                      "output.openfast = \"text\"",
                      file, table[0][column], table[r][0]));
    low = std::min(low, value), high = std::max(high, value);
  }
  if (low > high) return {};
  constexpr double most = 32767.0, least = -32768.0;
  const auto scale = float((most - least) / std::max(high - low, 1e-12 * std::max(std::abs(low), 1.0)));
  return {scale, float(most - high * double(scale))};
}

std::string binary_of(const Table& table, std::span<const Column> columns, const std::string& title, const std::string& file) {
  std::size_t rows = table.size() - 1;
  const auto time = [&](std::size_t r) { return number_in(table[r][0]); };
  const double step = rows > 1 ? time(2) - time(1) : 0.0;
  const auto on_grid = [&](std::size_t r) { return std::abs(time(r) - time(1) - double(r - 1) * step) < 1e-3 * step; };
  if (rows > 2 && !on_grid(rows)) --rows;
  for (std::size_t r = 3; r <= rows; ++r)
    if (!on_grid(r))
      throw MachineFailure(
          fmt::format("{}: the row at {} s is not {} s after the one before, as the binary format of OpenFAST "
                      "needs it; take output.openfast = \"text\"",
                      file, table[r][0], step));
  const std::vector<std::string> name = names(table), unit = units(table, columns);
  std::size_t longest = 10;
  for (const auto* list : {&name, &unit})
    for (const std::string& text : *list) longest = std::max(longest, text.size());
  const std::size_t channels = name.size() - 1;

  std::string out;
  put(out, std::int16_t(4));  // without a time column, names of stated length
  put(out, std::int16_t(longest));
  put(out, std::int32_t(channels));
  put(out, std::int32_t(rows));
  put(out, rows > 0 ? time(1) : 0.0);
  put(out, step);
  std::vector<Packing> packing;
  for (std::size_t c = 1; c <= channels; ++c) packing.push_back(packing_of(table, c, rows, file));
  for (const Packing& p : packing) put(out, p.scale);
  for (const Packing& p : packing) put(out, p.offset);
  put(out, std::int32_t(description(title).size()));
  out += description(title);
  for (const auto* list : {&name, &unit})
    for (const std::string& text : *list) out += text + std::string(longest - text.size(), ' ');
  for (std::size_t r = 1; r <= rows; ++r)
    for (std::size_t c = 1; c <= channels; ++c) put(out, packing[c - 1](number_in(table[r][c])));
  return out;
}

}  // namespace

std::filesystem::path write_openfast(const std::filesystem::path& history, std::span<const Column> columns, OpenFastFormat format,
                                     const std::string& title) {
  const std::string text = read_file(history);
  const Table table = table_of(text);
  const bool binary = format == OpenFastFormat::binary;
  std::filesystem::path path = history;
  path.replace_extension(binary ? ".outb" : ".out");
  if (table.empty()) throw MachineFailure(history.string() + ": has no heading");
  write_atomically(path, binary ? binary_of(table, columns, title, history.string()) : text_of(table, columns, title));
  return path;
}

}  // namespace spindrift::io
