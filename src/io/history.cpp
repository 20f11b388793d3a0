// SPDX-License-Identifier: Apache-2.0
#include "src/io/history.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

constexpr std::size_t buffer_bytes = 1 << 16;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// CRC-32 of a text that goes on from one whose digest is given; of nothing it is 0.
std::uint32_t digest_of(std::uint32_t digest, std::string_view text) {
  return std::uint32_t(crc32_z(digest, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

/// Shortest text that reads back as the same double; sign and payload of a nan are dropped so that equal runs give equal bytes.
void append_number(std::string& out, double value) {
  if (std::isnan(value)) {
    out += "nan";
    return;
  }
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string header_of(const std::vector<Column>& columns) {
  std::string header;
  for (const Column& column : columns) header += (header.empty() ? "" : ",") + column.name;
  return header;
}

/// Names the first column that differs, for a restart with another scene.
std::string difference(const std::string& found, const std::string& expected) {
  const auto split = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  const auto name_at = [](const std::string& header, std::size_t at) {
    if (at >= header.size()) return std::string("no further column");
    const std::size_t comma = header.rfind(',', at), from = comma == std::string::npos ? 0 : comma + (comma < at ? 1 : 0);
    const std::size_t begin = header[from] == ',' ? from + 1 : from;
    return header.substr(begin, header.find(',', begin) - begin);
  };
  const auto at = static_cast<std::size_t>(split.first - found.begin());
  return "it has '" + name_at(found, at) + "' where this run has '" + name_at(expected, at) + "'";
}

}  // namespace

History::History() { add({"time_s", "s", "Simulated time at the end of the window."}); }

History::~History() {
  try {
    drain();
  } catch (const MachineFailure&) {}
}

std::size_t History::add(Column column) {
  if (file_.is_open() || statistics_)
    throw std::logic_error("history column " + column.name + " declared after the file was opened, or statistics began");
  if (column.name.empty() || column.name.find_first_of(", \t\r\n\"") != std::string::npos)
    throw std::logic_error("history column '" + column.name + "': a name has no comma, quote or white space");
  for (const Column& other : columns_)
    if (other.name == column.name) throw std::logic_error("history column " + column.name + " declared twice");
  columns_.push_back(std::move(column));
  values_.push_back(nan);
  return columns_.size() - 1;
}

void History::keep_statistics(std::vector<TimeRange> ranges) {
  std::vector<std::string> names;
  for (const Column& column : columns_) names.push_back(column.name);
  statistics_.emplace(names, std::move(ranges));
}

std::optional<HistoryStatistics> History::statistics() const {
  if (!statistics_ || !file_.is_open()) return std::nullopt;
  return statistics_->result();
}

void History::open(const std::filesystem::path& path) {
  file_ = OutputFile(path, OutputFile::Start::empty);
  buffer_ = header_of(columns_) + "\n";
  buffer_.reserve(buffer_bytes + columns_.size() * 26);
  bytes_ = rows_ = 0;
  digest_ = 0;
  before_last_.reset();
  drain();
}

double History::resume(const std::filesystem::path& path, double time_s, const std::optional<Extent>& written, bool goes_on) {
  std::ifstream in(path, std::ios::binary);
  if (!in && !std::filesystem::exists(path))
    throw InputError(path.string() + " is gone; put a copy of it back, or go on from start.file in a new run directory");
  if (!in) throw_errno("cannot read", path, errno);
  std::string line;
  std::getline(in, line);
  const std::string header = header_of(columns_);
  if (line == header + "\r")
    throw InputError(path.string() + " was saved with other line ends (CR LF): put a copy of it back, or save it with LF");
  if (in.eof() || line != header)
    throw InputError(path.string() + " was written with other columns: " + difference(line, header) +
                     "; restart with the scene of the first run, or start anew");
  long long kept_bytes = static_cast<long long>(line.size()) + 1;
  // A window's end is the same sum of ticks in both runs; the margin only forgives the last digit of other arithmetic.
  const double margin = 1e-12 * std::max(1.0, std::abs(time_s)), last_kept = time_s + margin;
  double last = nan;
  rows_ = 0;
  before_last_.reset();
  digest_ = digest_of(digest_of(0, line), "\n");
  while (std::getline(in, line) && !in.eof()) {  // at the end of file: a line without its newline, half written
    double time = nan;
    std::from_chars(line.data(), line.data() + line.size(), time);
    if (!(time <= last_kept)) break;
    if (written && rows_ == written->rows && !before_last_ && time >= time_s - margin) {
      if (goes_on) break;
      before_last_ = Extent{kept_bytes, rows_, std::int64_t(digest_)};
    }
    kept_bytes += static_cast<long long>(line.size()) + 1;
    digest_ = digest_of(digest_of(digest_, line), "\n");
    last = time;
    ++rows_;
    if (!statistics_) continue;
    read_row(line, values_);
    statistics_->add(values_);
  }
  in.close();
  bytes_ = kept_bytes;
  if (written) require_whole(*written, time_s, last);
  buffer_.clear();
  buffer_.reserve(buffer_bytes + columns_.size() * 26);
  file_ = OutputFile(path, OutputFile::Start::end);
  file_.cut(kept_bytes);
  drained_ = std::chrono::steady_clock::now();
  return last;
}

void History::require_whole(const Extent& written, double time_s, double last_s) const {
  const Extent found = extent();
  if (found.bytes == written.bytes && found.rows == written.rows && found.digest == written.digest) return;
  const std::string text =
      found.rows == written.rows
          ? fmt::format("its {} rows are not those that the run wrote: they were changed", found.rows)
          : fmt::format("it has {} rows up to t = {:g} s (the last of t = {:g} s), the run had written {}: rows are missing",
                        found.rows, time_s, last_s, written.rows);
  throw InputError("history.csv: " + text +
                   "; put a whole copy of it back, or say --allow-change history.csv to go on with it as it is");
}

std::span<double> History::row(double time_s) {
  std::fill(values_.begin(), values_.end(), nan);
  values_[0] = time_s;
  return values_;
}

void History::write(Row row) {
  if (row == Row::off_schedule) drain(), before_last_ = extent();
  ++rows_;
  if (!file_.is_open()) return;
  if (statistics_) statistics_->add(values_);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (i != 0) buffer_ += ',';
    append_number(buffer_, values_[i]);
  }
  buffer_ += '\n';
  if (buffer_.size() >= buffer_bytes || std::chrono::steady_clock::now() - drained_ > flush_interval) drain();
}

void History::flush() {
  drain();
  sync();
}

void History::sync() {
  if (file_.is_open()) file_.sync();
}

void History::drain() {
  drained_ = std::chrono::steady_clock::now();
  if (!file_.is_open() || buffer_.empty()) return;
  try {
    file_.write(buffer_);
  } catch (const MachineFailure&) {
    // Leave a file that ends with a whole row; what is buffered stays, for a disk that is given room.
    file_.cut(bytes_);
    throw;
  }
  bytes_ += static_cast<long long>(buffer_.size());
  digest_ = digest_of(digest_, buffer_);
  buffer_.clear();
}

}  // namespace spindrift::io
