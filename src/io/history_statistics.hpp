// Statistics of a finished history.csv: final values, extremes, and means over stated ranges of time, in one pass over the file.
// From the file, not from memory, so that a restarted run gives the figures of an uninterrupted one. Goes into summary.json.
// Tested in tests/src/io/history_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
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

/// Throws MachineFailure where the file cannot be read. A half-written last line is left out.
HistoryStatistics history_statistics(const std::filesystem::path& path, std::vector<TimeRange> ranges);

}  // namespace spindrift::io
