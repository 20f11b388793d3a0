// The XDMF 2 text that makes a row of HDF5 files a time series in ParaView (5.11). Grows by one entry per output and is whole at
// any time. Rank 0 of fields.cpp keeps one per grid or particle set. Tested in tests/src/io/fields_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <string_view>

#include "src/io/atomic_file.hpp"

namespace spindrift::io {

class XdmfSeries {
 public:
  /// A new series, or the one that is there cut back to entries up to `resume_s` [s]: -infinity keeps none.
  XdmfSeries(const std::filesystem::path& path, std::string_view name, double resume_s);

  /// Adds the <Grid> element of a time; in one write, over the closing lines.
  void append(double time_s, std::string_view grid);

  /// Of the last entry; -infinity where there is none.
  double last_s() const { return last_s_; }

 private:
  OutputFile file_;
  long long end_;  ///< of the last entry
  double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace spindrift::io
