// SPDX-License-Identifier: Apache-2.0
#include "src/io/history_statistics.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

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

/// Trapezoidal integral of every column over the rows of one range.
struct Integral {
  std::vector<double> sum, first;
  double from = absent, to = absent;

  void add(double time, const std::vector<double>& before, const std::vector<double>& now) {
    if (std::isnan(from)) {
      from = to = time;
      first = now;
      sum.assign(now.size(), 0.0);
      return;
    }
    const double half = 0.5 * (time - to);
    for (std::size_t c = 0; c < now.size(); ++c) sum[c] += half * (before[c] + now[c]);
    to = time;
  }
  double mean(std::size_t column) const {
    if (std::isnan(from)) return absent;
    return to > from ? sum[column] / (to - from) : first[column];
  }
};

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

HistoryStatistics history_statistics(const std::filesystem::path& path, std::vector<TimeRange> ranges) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw_errno("cannot read", path, errno);
  HistoryStatistics result;
  result.ranges = std::move(ranges);
  std::string line;
  std::getline(in, line);
  for_each_field(line, [&](std::string_view name) {
    result.columns.push_back({std::string(name), absent, absent, absent, absent, absent, 0, {}});
  });

  std::vector<Integral> integrals(result.ranges.size());
  std::vector<double> before, now;
  while (std::getline(in, line) && !in.eof()) {
    now.clear();
    for_each_field(line, [&](std::string_view field) { now.push_back(number(field)); });
    now.resize(result.columns.size(), absent);
    const double time = now[0];
    for (std::size_t c = 0; c < now.size(); ++c) update(result.columns[c], time, now[c]);
    for (std::size_t r = 0; r < integrals.size(); ++r) {
      const double margin = 1e-12 * std::abs(time);
      if (time >= result.ranges[r].from_s - margin && time <= result.ranges[r].to_s + margin) integrals[r].add(time, before, now);
    }
    std::swap(before, now);
    ++result.rows;
  }
  for (std::size_t c = 0; c < result.columns.size(); ++c)
    for (const Integral& integral : integrals) result.columns[c].means.push_back(integral.mean(c));
  return result;
}

}  // namespace spindrift::io
