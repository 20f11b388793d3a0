// SPDX-License-Identifier: Apache-2.0
#include "src/io/history_statistics.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// Calls visit(field) for each comma-separated part of a line.
template <class Visit>
void for_each_field(std::string_view line, Visit visit) {
  for (;;) {
    const std::size_t comma = line.find(',');
    visit(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

double number(std::string_view text) {
  double value = absent;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void update(ColumnStatistics& column, double time, double value) {
  column.final = value;
  if (!std::isfinite(value)) {
    ++column.not_finite;
    return;
  }
  if (!(column.min <= value)) column.min = value, column.min_time_s = time;
  if (!(column.max >= value)) column.max = value, column.max_time_s = time;
}

}  // namespace

RunningStatistics::RunningStatistics(const std::vector<std::string>& columns, std::vector<TimeRange> ranges)
    : integrals_(ranges.size()) {
  statistics_.ranges = std::move(ranges);
  for (const std::string& name : columns) statistics_.columns.push_back({name, absent, absent, absent, absent, absent, 0, {}});
}

void RunningStatistics::add(std::span<const double> row) {
  const double time = row[0];
  for (std::size_t c = 0; c < row.size(); ++c) update(statistics_.columns[c], time, row[c]);
  for (std::size_t r = 0; r < integrals_.size(); ++r) {
    const TimeRange& range = statistics_.ranges[r];
    const double margin = 1e-12 * std::abs(time);
    if (time < range.from_s - margin || time > range.to_s + margin) continue;
    Integral& integral = integrals_[r];
    if (!integral.from_s) {
      integral.from_s = time;
      integral.first.assign(row.begin(), row.end());
      integral.sum.assign(row.size(), 0.0);
    } else {
      const double half = 0.5 * (time - integral.to_s);
      for (std::size_t c = 0; c < row.size(); ++c) integral.sum[c] += half * (before_[c] + row[c]);
    }
    integral.to_s = time;
  }
  before_.assign(row.begin(), row.end());
  ++statistics_.rows;
}

HistoryStatistics RunningStatistics::result() const {
  HistoryStatistics result = statistics_;
  for (std::size_t c = 0; c < result.columns.size(); ++c)
    for (const Integral& of : integrals_) {
      const double length = of.from_s ? of.to_s - *of.from_s : 0.0;
      result.columns[c].means.push_back(!of.from_s ? absent : length > 0.0 ? of.sum[c] / length : of.first[c]);
    }
  return result;
}

void read_row(std::string_view line, std::vector<double>& values) {
  std::size_t c = 0;
  for_each_field(line, [&](std::string_view field) {
    if (c < values.size()) values[c++] = number(field);
  });
  std::fill(values.begin() + std::ptrdiff_t(c), values.end(), absent);
}

HistoryStatistics history_statistics(const std::filesystem::path& path, std::vector<TimeRange> ranges) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw_errno("cannot read", path, errno);
  std::string line;
  std::getline(in, line);
  std::vector<std::string> columns;
  for_each_field(line, [&](std::string_view name) { columns.emplace_back(name); });
  RunningStatistics statistics(columns, std::move(ranges));
  std::vector<double> row(columns.size());
  while (std::getline(in, line) && !in.eof()) {
    read_row(line, row);
    statistics.add(row);
  }
  return statistics.result();
}

}  // namespace spindrift::io
