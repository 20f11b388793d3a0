// src/io/history.hpp and history_statistics.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/io/history.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>

#include "src/io/history_statistics.hpp"
#include "src/io/machine_failure.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;

namespace {

/// Declares two columns and writes windows [first, last) of 0.1 s, opened or resumed by `start`. Returns the statistics kept.
template <class Start>
std::optional<io::HistoryStatistics> run(int first, int last, Start start) {
  io::History history;
  const auto x = history.add({"platform.x_m", "m", "surge"});
  const auto f = history.add({"platform.sea.fx_N", "N", "force"});
  start(history);
  for (int window = first; window < last; ++window) {
    const double t = 0.1 * (window + 1);
    const auto row = history.row(t);
    row[x] = std::sin(t) / 3.0;
    row[f] = 1e6 * std::cos(t);
    history.write();
  }
  history.flush();
  return history.statistics();
}

}  // namespace

TEST_CASE("every double of a history reads back as itself", "[io][fast]") {
  const test::Scratch folder("history");
  std::mt19937_64 random(7);
  std::vector<double> values = {0.0, -0.0, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 0.1, 1e22, INFINITY, -INFINITY};
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) values.push_back(value);
  }
  io::History history;
  const auto column = history.add({"a_m", "m", "any"});
  history.open(folder / "history.csv");
  for (const double value : values) {
    history.row(1.0)[column] = value;
    history.write();
  }
  history.flush();
  const std::string text = io::read_file(folder / "history.csv");
  std::size_t line = text.find('\n') + 1;
  CHECK(text.substr(0, line) == "time_s,a_m\n");
  for (const double value : values) {
    const double back = std::strtod(text.c_str() + text.find(',', line) + 1, nullptr);
    REQUIRE(std::memcmp(&back, &value, sizeof back) == 0);
    line = text.find('\n', line) + 1;
  }
  CHECK(line == text.size());
}

TEST_CASE("what a window does not set is nan, whatever the one before said", "[io][fast]") {
  const test::Scratch folder("history");
  io::History history;
  const auto a = history.add({"a", "-", ""});
  history.open(folder / "h.csv");
  history.row(0.5)[a] = 2;
  history.write();
  history.row(1.0);
  history.write();
  history.flush();
  CHECK(io::read_file(folder / "h.csv") == "time_s,a\n0.5,2\n1,nan\n");
}

TEST_CASE("a resumed history is cut back and goes on to the same bytes as an uninterrupted one", "[io][fast]") {
  const test::Scratch folder("history");
  run(0, 500, [&](io::History& h) { h.open(folder / "whole.csv"); });
  const std::string whole = io::read_file(folder / "whole.csv");
  const int restart = GENERATE(0, 1, 200, 350);
  run(0, 350, [&](io::History& h) { h.open(folder / "parts.csv"); });
  {  // killed while writing a line
    io::OutputFile file(folder / "parts.csv", io::OutputFile::Start::end);
    file.write("35.1,0.0");
  }
  run(restart, 500, [&](io::History& h) {
    const double last = h.resume(folder / "parts.csv", 0.1 * restart);
    CHECK(h.rows() == restart);
    CHECK((restart == 0 ? std::isnan(last) : last == 0.1 * restart));
  });
  CHECK(io::read_file(folder / "parts.csv") == whole);
}

TEST_CASE("a history of other columns is not resumed; the first that differs is named", "[io][fast]") {
  const test::Scratch folder("history");
  run(0, 3, [&](io::History& h) { h.open(folder / "h.csv"); });
  const std::string before = io::read_file(folder / "h.csv");
  io::History other;
  other.add({"platform.x_m", "m", ""});
  other.add({"platform.wind.fx_N", "N", ""});
  CHECK_THROWS_AS(other.resume(folder / "h.csv", 1.0), io::InputError);
  CHECK_THROWS_WITH(other.resume(folder / "h.csv", 1.0), Contains("'platform.sea.fx_N'") && Contains("'platform.wind.fx_N'"));
  io::History fewer;
  CHECK_THROWS_WITH(fewer.resume(folder / "h.csv", 1.0), Contains("'platform.x_m'") && Contains("no further column"));
  std::ofstream(folder / "crlf.csv") << "time_s\r\n0.1\r\n";
  CHECK_THROWS_WITH(fewer.resume(folder / "crlf.csv", 1.0), Contains("was saved with other line ends (CR LF)"));
  CHECK(io::read_file(folder / "h.csv") == before);
}

TEST_CASE("a column name that would break the table, or comes twice, is a programmer's error", "[io][fast]") {
  io::History history;
  history.add({"a", "-", ""});
  CHECK_THROWS_AS(history.add({"a", "-", ""}), std::logic_error);
  CHECK_THROWS_AS(history.add({"b,c", "-", ""}), std::logic_error);
  CHECK_THROWS_AS(history.add({"b c", "-", ""}), std::logic_error);
  CHECK_THROWS_AS(history.add({"", "-", ""}), std::logic_error);
}

TEST_CASE("a history that is not opened, as on other ranks, takes rows and writes nothing", "[io][fast]") {
  io::History history;
  history.row(1.0);
  history.write();
  history.flush();
  CHECK(history.rows() == 1);
}

TEST_CASE("when the disk is full the history says so and still ends with a whole row", "[io][faults][fast]") {
  const test::Scratch folder("history");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  io::History history;
  const auto a = history.add({"a", "-", ""});
  history.open(folder / "h.csv");
  rlimit small = before;
  small.rlim_cur = 4099;
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  for (int i = 0; i < 2000; ++i) {
    history.row(i)[a] = 0.125;
    history.write();
  }
  try {
    history.flush();
  } catch (const io::MachineFailure& failure) { message = failure.what(); }
  setrlimit(RLIMIT_FSIZE, &before);
  CHECK_THAT(message, Contains("h.csv") && Contains("File too large"));
  const std::string text = io::read_file(folder / "h.csv");
  CHECK(text.size() <= 4099);
  CHECK(text.back() == '\n');
  history.flush();  // room again: nothing was lost
  const auto statistics = io::history_statistics(folder / "h.csv", {});
  CHECK(statistics.rows == 2000);
  CHECK(statistics.columns[0].final == 1999.0);
}

TEST_CASE("statistics: final, extremes and trapezoidal means over ranges", "[io][fast]") {
  const test::Scratch folder("history");
  io::write_atomically(folder / "h.csv", "time_s,a,b\n1,2,nan\n2,4,-inf\n4,8,7\n5,-1,7\n6,");
  const auto s = io::history_statistics(folder / "h.csv", {{"all", 0, 5}, {"middle", 2, 4}, {"one", 4, 4}, {"none", 2.5, 3}});
  CHECK(s.rows == 4);
  REQUIRE(s.columns.size() == 3);
  const auto& a = s.columns[1];
  CHECK(a.final == -1);
  CHECK((a.min == -1 && a.min_time_s == 5));
  CHECK((a.max == 8 && a.max_time_s == 4));
  CHECK(a.means[0] == Approx((3.0 + 12.0 + 3.5) / 4.0));
  CHECK(a.means[1] == Approx(6.0));
  CHECK(a.means[2] == 8.0);
  CHECK(std::isnan(a.means[3]));
  CHECK(a.not_finite == 0);
  CHECK(s.columns[2].not_finite == 2);
  CHECK(s.columns[2].min == 7);
  CHECK(std::isnan(s.columns[2].means[0]));
}

TEST_CASE("statistics kept while rows are written are those of the file, after a restart too", "[io][fast]") {
  const test::Scratch folder("history");
  const std::vector<io::TimeRange> ranges = {{"all", 0, 50}, {"end", 40, 50}, {"later", 60, 70}};
  const int restart = GENERATE(0, 120, 450);
  if (restart > 0) run(0, 460, [&](io::History& h) { h.open(folder / "h.csv"); });
  const auto kept = run(restart, 500, [&](io::History& h) {
    h.keep_statistics(ranges);
    if (restart > 0)
      h.resume(folder / "h.csv", 0.1 * restart);
    else
      h.open(folder / "h.csv");
  });
  const io::HistoryStatistics read = io::history_statistics(folder / "h.csv", ranges);
  REQUIRE(kept);
  CHECK(kept->rows == read.rows);
  REQUIRE(kept->columns.size() == read.columns.size());
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t c = 0; c < read.columns.size(); ++c) {
    const io::ColumnStatistics &a = kept->columns[c], &b = read.columns[c];
    CHECK(a.name == b.name);
    CHECK((same(a.final, b.final) && same(a.min, b.min) && same(a.max, b.max) && same(a.min_time_s, b.min_time_s)));
    CHECK((same(a.max_time_s, b.max_time_s) && a.not_finite == b.not_finite));
    for (std::size_t r = 0; r < ranges.size(); ++r) CHECK(same(a.means[r], b.means[r]));
  }
}

TEST_CASE("statistics of a history without rows are nan, and the file must be there", "[io][fast]") {
  const test::Scratch folder("history");
  io::write_atomically(folder / "h.csv", "time_s,a\n");
  const auto s = io::history_statistics(folder / "h.csv", {{"all", 0, 1}});
  CHECK(s.rows == 0);
  CHECK(std::isnan(s.columns[1].final));
  CHECK(std::isnan(s.columns[1].means[0]));
  CHECK_THROWS_AS(io::history_statistics(folder / "absent.csv", {}), io::MachineFailure);
}

TEST_CASE("a last row off schedule stays until the run goes on", "[io][fast]") {
  const test::Scratch folder("history");
  const auto path = folder / "h.csv";
  const auto declared = [](io::History& h) {
    h.add({"x_m", "m", "A number."});
    h.keep_statistics({{"whole", 0.0, 3.0}});
  };
  io::History::Extent extent;
  {
    io::History h;
    declared(h);
    h.open(path);
    for (const double t : {0.0, 1.0}) h.row(t)[1] = t, h.write();
    h.row(1.5)[1] = 1.5, h.write(io::History::Row::off_schedule);
    h.flush(), extent = h.extent();
  }
  const std::string whole = io::read_file(path);
  CHECK(extent.rows == 2);
  {
    io::History h;
    declared(h);
    CHECK(h.resume(path, 1.5, extent, false) == 1.5);
    CHECK(h.statistics()->rows == 3);
    CHECK(h.extent().digest == extent.digest);
  }
  CHECK(io::read_file(path) == whole);
  for (int n = 0; n < 2; ++n) {  // once more, from the same checkpoint
    io::History h;
    declared(h);
    CHECK(h.resume(path, 1.5, extent, true) == 1.0);
    CHECK(h.statistics()->rows == 2);
  }
  CHECK(io::read_file(path) == whole.substr(0, whole.find("1.5")));
}

TEST_CASE("a history that lost rows or changed since the checkpoint is not gone on with", "[io][faults][fast]") {
  const test::Scratch folder("history");
  const auto path = folder / "h.csv";
  const auto declared = [](io::History& h) { h.add({"x_m", "m", "A number."}); };
  io::History::Extent extent;
  {
    io::History h;
    declared(h);
    h.open(path);
    for (int n = 0; n < 20; ++n) {
      h.row(0.1 * n)[1] = n * n, h.write();
      if (n == 10) h.flush(), extent = h.extent();
    }
  }
  const std::string whole = io::read_file(path);
  const auto resume = [&](const std::string& text) {
    io::write_atomically(path, text);
    io::History h;
    declared(h);
    h.resume(path, 1.0, extent);
    h.row(1.1)[1] = 121, h.write();
  };
  resume(whole);
  const std::string until_11 = whole.substr(0, whole.find("\n1.2") + 1);
  CHECK(io::read_file(path) == until_11);
  const std::size_t row = whole.find("\n0.5") + 1, next = whole.find('\n', row) + 1;
  std::string changed = whole;
  changed[next - 2] = '7';
  CHECK_THROWS_WITH(resume(whole.substr(0, row)), Contains("rows are missing") && Contains("--allow-change history.csv"));
  CHECK_THROWS_WITH(resume(whole.substr(0, row) + whole.substr(next)), Contains("had written 11: rows are missing"));
  CHECK_THROWS_WITH(resume(changed), Contains("were changed"));
  std::filesystem::remove(path);
  io::History h;
  declared(h);
  CHECK_THROWS_AS(h.resume(path, 1.0, extent), io::InputError);
}
