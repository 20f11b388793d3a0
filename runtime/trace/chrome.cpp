// One JSON object a line, written (and compressed) as it is made: a trace may be larger than memory has room for twice. Times are
// microseconds from the first record. SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/chrome.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "runtime/trace/occurrences.hpp"

namespace spindrift::runtime {

namespace {

constexpr int first_message_row = 10000;  ///< rows of messages, numbered after any thread

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

class ChromeWriter {
 public:
  ChromeWriter(std::span<const RankTrace> traces, const std::string& path)
      : traces_(traces),
        path_(path),
        occurrences_(occurrences_of(traces)),
        row_(occurrences_.all.size(), -1),
        file_(gzopen(path.c_str(), path.ends_with(".gz") ? "wb1" : "wbT"), &gzclose) {
    if (!file_) fail();
    gzbuffer(file_.get(), 1 << 17);
    std::int64_t last = 0;
    origin_ = RankTrace::always;
    for (const RankTrace& trace : traces)
      for (const Record& record : trace.records)
        origin_ = std::min(origin_, record.begin_ns), last = std::max(last, record.end_ns);
    if (origin_ == RankTrace::always) origin_ = 0;
    span_ = std::max<std::int64_t>(1, last - origin_);
  }

  void write(const ChromeOptions& options) {
    gzputs(file_.get(), "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
    place_messages();
    names();
    slices();
    waits();
    arrows();
    counters(options.counter_bins);
    // A last event without a comma after it.
    gzprintf(file_.get(), R"({"ph":"M","name":"process_labels","pid":0,"args":{"labels":"spindrift"}})"
                          "\n]}\n");
    int failure = Z_OK;
    const std::string why = gzerror(file_.get(), &failure);  // of any line, with the path: what followed it is missing
    if (failure != Z_OK) throw std::runtime_error("cannot write trace " + why);
    if (gzclose(file_.release()) != Z_OK) fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error("cannot write trace " + path_ + ": " + std::strerror(errno)); }
  double us(std::int64_t ns) const { return 1e-3 * double(ns - origin_); }
  const TraceNode& node(const Occurrence& o) const { return traces_[o.trace].nodes[o.node]; }
  int rank(const Occurrence& o) const { return traces_[o.trace].rank; }

  /// Messages of a rank overlap: each goes to the first row that is free when it is posted.
  void place_messages() {
    std::vector<std::vector<std::int64_t>> free_from(traces_.size());
    for (std::size_t n = 0; n < occurrences_.all.size(); ++n) {
      const Occurrence& o = occurrences_.all[n];
      if (o.record == nullptr) continue;
      row_[n] = o.record->thread;
      if (!o.is_message()) continue;
      auto& rows = free_from[o.trace];
      const auto row = std::find_if(rows.begin(), rows.end(), [&](std::int64_t free) { return free <= o.begin; });
      row_[n] = first_message_row + int(row - rows.begin());
      if (row == rows.end())
        rows.push_back(o.end);
      else
        *row = o.end;
    }
    for (const auto& rows : free_from) message_rows_.push_back(int(rows.size()));
  }

  void names() {
    const auto name_row = [this](int rank, int row, const std::string& name) {
      gzprintf(file_.get(),
               R"({"ph":"M","name":"thread_name","pid":%d,"tid":%d,"args":{"name":"%s"}},)"
               "\n",
               rank, row, name.c_str());
    };
    for (std::size_t t = 0; t < traces_.size(); ++t) {
      const int rank = traces_[t].rank;
      gzprintf(file_.get(),
               R"({"ph":"M","name":"process_name","pid":%d,"args":{"name":"rank %d"}},)"
               "\n",
               rank, rank);
      for (std::size_t thread = 0; thread < traces_[t].threads.size(); ++thread)
        name_row(rank, int(thread), "thread " + std::to_string(thread));
      for (int row = 0; row < message_rows_[t]; ++row) name_row(rank, first_message_row + row, "messages " + std::to_string(row));
    }
  }

  void slices() {
    for (std::size_t n = 0; n < occurrences_.all.size(); ++n) {
      const Occurrence& o = occurrences_.all[n];
      if (o.record == nullptr) continue;
      gzprintf(file_.get(),
               R"({"ph":"X","name":"%s","cat":"%s","pid":%d,"tid":%d,"ts":%.3f,"dur":%.3f,"args":{"replay":%u,"iteration":%u)",
               escaped(node(o).label).c_str(), escaped(module_of(node(o).label)).c_str(), rank(o), row_[n], us(o.begin),
               1e-3 * double(o.end - o.begin), o.record->replay, o.record->iteration);
      if (o.is_message()) gzprintf(file_.get(), R"(,"bytes":%u,"peer":%d)", o.record->bytes, node(o).peer);
      gzputs(file_.get(), "}},\n");
    }
  }

  /// What threads did between tasks.
  void waits() {
    for (const RankTrace& trace : traces_)
      for (const Record& record : trace.records)
        if (record.activity == Activity::idle || record.activity == Activity::poll)
          gzprintf(file_.get(),
                   R"({"ph":"X","name":"%s","cat":"runtime","pid":%d,"tid":%d,"ts":%.3f,"dur":%.3f},)"
                   "\n",
                   record.activity == Activity::idle ? "waiting" : "completing messages", trace.rank, int(record.thread),
                   us(record.begin_ns), 1e-3 * double(record.end_ns - record.begin_ns));
  }

  /// From the time `at` in one slice to the time `to_at` in another.
  void arrow(const char* name, std::uint32_t from, std::int64_t at, std::uint32_t to, std::int64_t to_at) {
    const Occurrence &a = occurrences_.all[from], &b = occurrences_.all[to];
    const char* format = R"({"ph":"%s","name":"%s","cat":"%s","id":%ld,"pid":%d,"tid":%d,"ts":%.3f%s},)"
                         "\n";
    gzprintf(file_.get(), format, "s", name, name, arrows_, rank(a), row_[from], us(at), "");
    gzprintf(file_.get(), format, "f", name, name, arrows_, rank(b), row_[to], us(to_at), R"(,"bp":"e")");
    ++arrows_;
  }

  /// The last time that viewers still take as inside the slice: they bind an arrow's end to the slice round it ("bp":"e").
  static std::int64_t last_inside(const Occurrence& o) { return std::max(o.begin, o.end - 1); }

  void arrows() {
    for (std::uint32_t n = 0; n < occurrences_.all.size(); ++n) {
      const Occurrence& o = occurrences_.all[n];
      if (o.record == nullptr) continue;
      if (o.record->activity == Activity::receive)
        for (const std::uint32_t sender : occurrences_.partners_of(o))
          arrow("message", sender, occurrences_.all[sender].begin, n, last_inside(o));
      cross_module_arrows(n);
    }
  }

  std::string_view module(std::uint32_t occurrence) const { return module_of(node(occurrences_.all[occurrence]).label); }

  /// Arrows to `to` from the last record of each other module that it waited for; what all of a loop waits for leads to its first
  /// record alone.
  void cross_module_arrows(std::uint32_t to) {
    std::map<std::string_view, std::uint32_t> last;
    waited_for(to, last);
    for (const auto& [other, from] : last)
      if (other != module(to) && led_.insert({from, module(to)}).second)
        arrow("data between modules", from, last_inside(occurrences_.all[from]), to, occurrences_.all[to].begin);
  }
  /// The last record by module before `via`, which is a record or the beginning or end of a loop.
  void waited_for(std::uint32_t via, std::map<std::string_view, std::uint32_t>& last) const {
    for (const std::uint32_t from : occurrences_.before_of(occurrences_.all[via])) {
      if (occurrences_.all[from].record == nullptr) {
        waited_for(from, last);
        continue;
      }
      const auto [known, is_new] = last.try_emplace(module(from), from);
      if (!is_new && occurrences_.all[from].end > occurrences_.all[known->second].end) known->second = from;
    }
  }

  /// Mean number of busy threads by module, and bytes under way, in equal bins of time.
  void counters(int bins) {
    for (std::uint32_t t = 0; t < traces_.size(); ++t) {
      std::map<std::string, std::vector<double>> busy;
      std::vector<double> bytes(bins, 0.0);
      const double width = double(span_) / bins;
      for (const Occurrence& o : occurrences_.all) {
        if (o.trace != t || o.record == nullptr) continue;
        std::vector<double>* bin = &bytes;
        if (!o.is_message()) bin = &busy.try_emplace(std::string(module_of(node(o).label)), bins, 0.0).first->second;
        spread(o, o.is_message() ? double(o.record->bytes) : 1.0, width, *bin);
      }
      for (int n = 0; n < bins; ++n) {
        const auto open = [&](const char* name) {
          gzprintf(file_.get(), R"({"ph":"C","name":"%s","pid":%d,"ts":%.3f,"args":{)", name, traces_[t].rank, 1e-3 * width * n);
        };
        open("busy threads");
        const char* comma = "";
        for (const auto& [module, bin] : busy) {
          gzprintf(file_.get(), R"(%s"%s":%.3g)", comma, escaped(module).c_str(), bin[n]);
          comma = ",";
        }
        gzputs(file_.get(), "}},\n");
        if (message_rows_[t] == 0) continue;
        open("bytes under way");
        gzprintf(file_.get(),
                 R"("bytes":%.6g}},)"
                 "\n",
                 bytes[n]);
      }
    }
  }

  void spread(const Occurrence& o, double amount, double width, std::vector<double>& bins) const {
    const double begin = double(o.begin - origin_), end = double(o.end - origin_);
    for (int n = int(begin / width); n < int(bins.size()) && n * width < end; ++n)
      bins[n] += amount * (std::min(end, (n + 1) * width) - std::max(begin, n * width)) / width;
  }

  std::span<const RankTrace> traces_;
  std::string path_;
  Occurrences occurrences_;
  std::vector<int> row_, message_rows_;
  std::unique_ptr<gzFile_s, int (*)(gzFile)> file_;
  std::int64_t origin_ = 0, span_ = 1;
  long arrows_ = 0;
  std::set<std::pair<std::uint32_t, std::string_view>> led_;  ///< from a record to a module
};

}  // namespace

void write_chrome_trace(std::span<const RankTrace> traces, const std::string& path, ChromeOptions options) {
  ChromeWriter(traces, path).write(options);
}

}  // namespace spindrift::runtime
