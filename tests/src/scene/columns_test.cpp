// Laws of src/scene/columns.hpp: data files are read whole or refused with file and line.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/columns.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "src/scene/error.hpp"

using namespace spindrift::scene;
using Catch::Matchers::Contains;

namespace {

std::string file_with(const std::string& text) {
  const std::string path = (std::filesystem::temp_directory_path() / "spindrift_columns_test.csv").string();
  std::ofstream(path) << text;
  return path;
}

}  // namespace

TEST_CASE("named columns are read past comments and blank lines", "[scene][fast]") {
  const Columns t = read_columns(file_with("# source: a report\n\ntime_s, thrust_N # mean\n+0, +1.5e6\r\n 0.5 ,-2\n"));
  CHECK(t.rows() == 2);
  CHECK(t.has("thrust_N"));
  CHECK(t["time_s"][1] == 0.5);
  CHECK(t["thrust_N"][1] == -2.0);
  CHECK_THROWS_WITH(t["torque_N_m"], Contains("needs a column \"torque_N_m\"; has time_s, thrust_N"));
  CHECK_THROWS_WITH(t.allow_only({"time_s"}), Contains("thrust_N"));
  CHECK_THROWS_WITH(t.require_rows(3), Contains("at least 3 rows"));
  CHECK_NOTHROW(t.require_increasing("time_s", "time"));
  CHECK_THROWS_WITH(t.require_increasing("thrust_N", "thrust"), Contains(".csv:5") && Contains("must be above 1500000"));
}

TEST_CASE("a table of a spreadsheet is read past its mark and its line ends", "[scene][fast]") {
  const Columns t = read_columns(file_with("\xEF\xBB\xBFtime_s,thrust_N\r\n0,1\r\n1,2\r\n"));
  CHECK(t.has("time_s"));
  CHECK(t["thrust_N"][1] == 2.0);
  const Columns points = read_blank_columns(file_with("\xEF\xBB\xBF"
                                                      "1.0 0.0\r\n0.5\t0.1\r\n"),
                                            {"x", "y"});
  CHECK(points.rows() == 2);
  CHECK_THROWS_WITH(read_blank_columns(file_with("title\n1,0 0,0\n"), {"x", "y"}),
                    Contains(":2 = \"1,0\"") && Contains("write a decimal point"));
}

TEST_CASE("a data file that is not a table is refused where it goes wrong", "[scene][fast]") {
  struct Case {
    const char *text, *message;
  };
  const auto c =
      GENERATE(Case{"a,b\n1,2\n3\n", ":3: has 1 values where there are 2 columns (a, b)"}, Case{"a,b\n1,two\n", ":2 = \"two\""},
               Case{"a\n+-1\n", ":2 = \"+-1\""}, Case{"a,b\n1,\n", "must be a finite number (column b)"},
               Case{"a\nnan\n", "must be a finite number"}, Case{"a\n1e999\n", "must be a finite number"},
               Case{"# nothing\n", "holds no table"}, Case{"a;b\n1;2\n", ":1: has semicolons between its columns"},
               Case{"# x\na\tb\n1\t2\n", ":2: has tabs between"}, Case{"a b\n1 2\n", "has blanks between"},
               Case{"a,b,a\n1,2,3\n", ":1: has two columns \"a\""},
               Case{"a,b\n0,5,1,5\n", ":2: has 4 values where there are 2 columns (a, b); decimal commas?"},
               Case{"\xFF\xFE"
                    "a,b",
                    "UTF-16"});
  CHECK_THROWS_WITH(read_columns(file_with(c.text)), Contains(c.message));
  CHECK_THROWS_AS(read_columns("/no/such/file.csv"), SceneError);
}
