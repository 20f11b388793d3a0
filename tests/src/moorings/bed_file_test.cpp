// Files of beds, src/moorings/bed_file.hpp, and what scenes are refused for. SPDX-License-Identifier: Apache-2.0
#include "src/moorings/bed_file.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::moorings;
using Catch::Contains;

namespace {

const std::string path =
    (std::filesystem::temp_directory_path() / ("spindrift_bed_" + std::to_string(getpid()) + ".csv")).string();
const std::string good = "x_m,y_m,depth_m\n0,0,100\n500,0,120\n0,300,110\n500,300,150\n";

Bed bed_of(const std::string& text) {
  std::ofstream(path) << text;
  return read_bed(path);
}

}  // namespace

TEST_CASE("a bed's file has a depth at each place of a grid, in any order", "[moorings][fast]") {
  const Bed bed = bed_of(good), mixed = bed_of("y_m,x_m,depth_m\n300,500,150\n0,0,100\n300,0,110\n0,500,120\n");
  CHECK(bed.level(250.0, 150.0) == Approx(-120.0));
  CHECK(mixed.level(250.0, 150.0) == bed.level(250.0, 150.0));
  CHECK(bed_of("x_m,y_m,depth_m\n0,0,100\n500,0,120\n").level(250.0, 700.0) == Approx(-110.0));  // a profile along x
}

TEST_CASE("a bed that is no grid is refused by file and line", "[moorings][fast]") {
  struct Case {
    std::string text, message;
  };
  const auto c = GENERATE(Case{"x_m,y_m,depth_m\n0,0,100\n500,0,120\n0,300,110\n", "no row for x_m = 500, y_m = 300"},
                          Case{"x_m,y_m,depth_m\n0,0,100\n500,0,120\n0,0,110\n", ".csv:4: x_m = 0, y_m = 0 is in a row before"},
                          Case{"x_m,y_m,depth_m\n0,0,100\n500,0,-120\n", ".csv:3: depth_m = -120 must be above zero"},
                          Case{"x_m,y_m,depth_m\n0,0,100\n500,0,0\n", ".csv:3: depth_m = 0 must be above zero"},
                          Case{"x_m,y_m,depth_m\n0,0,100\n", "rows"}, Case{"x_m,y_m,z_m\n0,0,100\n1,0,100\n", "z_m"},
                          Case{"x_m,depth_m\n0,100\n1,100\n", "y_m"}, Case{"x_m,y_m,depth_m\n0,0,deep\n1,0,100\n", ".csv:2"});
  CHECK_THROWS_WITH(bed_of(c.text), Contains(c.message));
}
