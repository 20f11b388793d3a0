// Statistics of a history: final values, extremes, and means over stated ranges of time, row by row or in one pass over a file.
// Both give the same figures, and so does a run that was restarted. Goes into summary.json. Tested in
// tests/src/io/history_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::io {

/// A named range of simulated time for means, both ends included; `last_40_s` over 110 ... 150 s, say.
struct TimeRange {
  std::string name;
  double from_s, to_s;
};

struct ColumnStatistics {
  std::string name;
  double final, min, max, min_time_s, max_time_s;  ///< over finite values; nan where there are none
  long long not_finite;                            ///< rows with nan or infinity
  std::vector<double> means;  ///< one per range: the trapezoidal mean over time; nan where a value is not finite
};

struct HistoryStatistics {
  long long rows = 0;
  std::vector<TimeRange> ranges;
  std::vector<ColumnStatistics> columns;  ///< as in the file, time_s first
};

/// Takes rows as they come.
class RunningStatistics {
 public:
  RunningStatistics(const std::vector<std::string>& columns, std::vector<TimeRange> ranges);
  void add(std::span<const double> row);  ///< as many as there are columns, time_s first
  HistoryStatistics result() const;

 private:
  /// Trapezoidal integral of every column over the rows of one range.
  struct Integral {
    std::vector<double> sum, first;
    std::optional<double> from_s;
    double to_s = 0.0;
  };
  HistoryStatistics statistics_;  ///< but for the means
  std::vector<Integral> integrals_;
  std::vector<double> before_;  ///< the last row
};

/// The numbers of a line of history.csv; nan where it has fewer than `values`.
void read_row(std::string_view line, std::vector<double>& values);

/// Throws MachineFailure where the file cannot be read. A half-written last line is left out.
HistoryStatistics history_statistics(const std::filesystem::path& path, std::vector<TimeRange> ranges);

}  // namespace spindrift::io
