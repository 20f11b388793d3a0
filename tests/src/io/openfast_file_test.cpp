// Files in OpenFAST's formats, read back by the description of these formats. SPDX-License-Identifier: Apache-2.0
#include "src/io/openfast_file.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "src/io/atomic_file.hpp"
#include "src/io/machine_failure.hpp"

using namespace spindrift::io;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const std::vector<Column> columns{
    {"time_s", "s", ""}, {"platform.x_m", "m", ""}, {"line_1.tension_N", "N", ""}, {"still", "N m", ""}};

fs::path history(const std::string& rows) {
  const fs::path path = fs::temp_directory_path() / "spindrift_openfast_test.csv";
  std::ofstream(path) << "time_s,platform.x_m,line_1.tension_N,still\n" << rows;
  return path;
}
const std::string rows = "0,0.1,1000000,3\n0.5,-0.25,1200000,3\n1,0.7,900000.5,3\n1.5,0.35,1000000,3\n";

/// ReadFASTbinary of OpenFAST, in its words.
struct Binary {
  std::int16_t file_id, len_name;
  std::int32_t channels, rows;
  double time_out1, time_incr;
  std::vector<std::string> names, units;
  std::vector<std::vector<double>> values;  ///< [row][channel]
  explicit Binary(const fs::path& path) {
    const std::string bytes = read_file(path);
    std::size_t at = 0;
    const auto get = [&]<class T>(T& value) { std::memcpy(&value, bytes.data() + at, sizeof value), at += sizeof value; };
    get(file_id), get(len_name), get(channels), get(rows), get(time_out1), get(time_incr);
    const auto count = std::size_t(channels);
    std::vector<float> scale(count), offset(count);
    for (float& s : scale) get(s);
    for (float& o : offset) get(o);
    std::int32_t len_desc = 0;
    get(len_desc), at += std::size_t(len_desc);
    for (auto* list : {&names, &units})
      for (int n = 0; n <= channels; ++n, at += std::size_t(len_name)) {
        std::string text = bytes.substr(at, std::size_t(len_name));
        list->push_back(text.erase(text.find_last_not_of(' ') + 1));
      }
    for (int r = 0; r < rows; ++r) {
      auto& row = values.emplace_back();
      for (int c = 0; c < channels; ++c) {
        std::int16_t packed = 0;
        get(packed);
        row.push_back((packed - offset[std::size_t(c)]) / scale[std::size_t(c)]);
      }
    }
    CHECK(at == bytes.size());
  }
};

}  // namespace

TEST_CASE("the text file has names on line 7, units on line 8, and the digits of history.csv", "[io][fast]") {
  const fs::path path = write_openfast(history(rows), columns, OpenFastFormat::text, "a run");
  CHECK(path.extension() == ".out");
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  REQUIRE(lines.size() == 12);
  CHECK(lines[6] == "Time\tplatform.x_m\tline_1.tension_N\tstill");
  CHECK(lines[7] == "(s)\t(m)\t(N)\t(N*m)");
  CHECK(lines[10] == "1\t0.7\t900000.5\t3");
}

TEST_CASE("the binary file reads back to a 65,000th of each channel's range", "[io][fast]") {
  const Binary file(write_openfast(history(rows), columns, OpenFastFormat::binary, "a run"));
  CHECK(file.file_id == 4);
  CHECK((file.channels == 3 && file.rows == 4));
  CHECK((file.time_out1 == 0.0 && file.time_incr == 0.5));
  CHECK(file.names == std::vector<std::string>{"Time", "platform.x_m", "line_1.tension_N", "still"});
  CHECK(file.units == std::vector<std::string>{"(s)", "(m)", "(N)", "(N*m)"});
  const double x[] = {0.1, -0.25, 0.7, 0.35}, tension[] = {1e6, 1.2e6, 900000.5, 1e6};
  for (std::size_t r = 0; r < 4; ++r) {
    CHECK(file.values[r][0] == Approx(x[r]).margin(0.95 / 65535));
    CHECK(file.values[r][1] == Approx(tension[r]).margin(3e5 / 65535));
    CHECK(file.values[r][2] == Approx(3.0).epsilon(1e-5));
  }
}

TEST_CASE("rows that are not equally spaced in time are named, but for the last", "[io][fast]") {
  CHECK(Binary(write_openfast(history(rows + "1.7,0,1000000,3\n"), columns, OpenFastFormat::binary, "")).rows == 4);
  CHECK_THROWS_WITH(write_openfast(history(rows + "1.7,0,1000000,3\n1.9,0,1000000,3\n"), columns, OpenFastFormat::binary, ""),
                    Contains("1.7 s") && Contains("text"));
}

TEST_CASE("what is no number is named, as the binary file cannot say it", "[io][fast]") {
  for (const std::string value : {"nan", "-inf", ""})
    CHECK_THROWS_WITH(write_openfast(history(rows + "2,0.1," + value + ",3\n"), columns, OpenFastFormat::binary, ""),
                      Contains("line_1.tension_N at 2 s") && Contains("text"));
  CHECK_NOTHROW(write_openfast(history(rows + "2,0.1,nan,3\n"), columns, OpenFastFormat::text, ""));
}

TEST_CASE("a row cut short is left out", "[io][fast]") {
  CHECK(Binary(write_openfast(history(rows + "2,0.1"), columns, OpenFastFormat::binary, "")).rows == 4);
}
