// history.csv: named columns, one row per coupling window, every number with the digits that give the same double back.
// Columns are declared by whoever has the values; rows are written by the coupling. Their statistics:
// history_statistics.hpp. Tested in tests/src/io/history_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/io/atomic_file.hpp"
#include "src/io/history_statistics.hpp"

namespace spindrift::io {

/// What a column holds. The name carries the unit too (`platform.x_m`), as docs/user/outputs.md lists them.
struct Column {
  std::string name, unit, meaning;
};

/// The table of a run. All ranks may declare and set; only the one that opens it writes a file, on the others rows go nowhere.
/// The first column, `time_s`, is there from the start.
///
///     const std::size_t x = history.add({"platform.x_m", "m", "Surge from the scene's initial reference."});
///     history.open(directory.history());                 // or history.resume(directory.history(), restart_time)
///     history.row(t)[x] = ...;  history.write();         // once per window; what is not set is nan
///     history.flush();                                   // before a checkpoint is written, and at the end
class History {
 public:
  History();
  ~History();  ///< Writes what is buffered; failures are silent here: call flush() at the end of a run.
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Declares a column and gives its index in row(). Before open(); names are unique, without comma, quote or white space.
  std::size_t add(Column column);
  const std::vector<Column>& columns() const { return columns_; }

  /// Has statistics of all rows, kept and written, with means over these ranges of time. After all columns are added, before
  /// open() or resume().
  void keep_statistics(std::vector<TimeRange> ranges);
  /// None where they are not kept, or no file is open: on other ranks.
  std::optional<HistoryStatistics> statistics() const;

  /// Starts a new file.
  void open(const std::filesystem::path& path);

  /// What is in the file after drain() but for a last row off schedule, as a checkpoint keeps it.
  struct Extent {
    std::int64_t bytes = 0, rows = 0, digest = 0;
  };
  Extent extent() const { return before_last_.value_or(Extent{bytes_, rows_, std::int64_t(digest_)}); }

  /// Goes on with the file of an interrupted run: removes the rows after `time_s` and a half-written last line. With `written`,
  /// what the checkpoint says was there, rows that are missing or changed are an InputError that says what mends them; without,
  /// gaps are accepted. So are other columns than those declared, never. A row of `time_s` beyond `written`, which was off
  /// schedule, stays only where the run ends there all the same: not where it `goes_on`. Returns the time of the last row kept
  /// (nan: none).
  double resume(const std::filesystem::path& path, double time_s, const std::optional<Extent>& written = {}, bool goes_on = true);

  /// Begins the row of time `time_s` [s] and gives its values to fill, all nan but the first.
  std::span<double> row(double time_s);
  enum class Row : std::uint8_t { on_schedule, off_schedule };
  /// Appends the row begun. Forces it out where the buffer is full or `flush_interval` has passed. One off schedule, at the end
  /// of a run, is no part of extent(): a run that goes on from there leaves it out.
  void write(Row row = Row::on_schedule);
  /// Everything written so far, in the file. Throws MachineFailure; the file then still ends with a whole row.
  void drain();
  /// The file on disk as it stands. Throws MachineFailure.
  void sync();
  /// Both.
  void flush();

  long long rows() const { return rows_; }  ///< written or kept by this object
  std::chrono::duration<double> flush_interval{2.0};

 private:
  void require_whole(const Extent& written, double time_s, double last_s) const;

  std::vector<Column> columns_;
  std::vector<double> values_;
  std::string buffer_;
  OutputFile file_;
  long long bytes_ = 0, rows_ = 0;
  std::uint32_t digest_ = 0;           ///< of these bytes: CRC-32
  std::optional<Extent> before_last_;  ///< where the last row is off schedule
  std::optional<RunningStatistics> statistics_;
  std::chrono::steady_clock::time_point drained_;
};

}  // namespace spindrift::io
