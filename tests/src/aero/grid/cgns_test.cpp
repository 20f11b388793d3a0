// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/cgns.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/grid/examples.hpp"

#ifdef SPINDRIFT_CGNS
#include <cgnslib.h>
#endif

using namespace spindrift;
using namespace spindrift::aero;

TEST_CASE("a grid written as CGNS is the grid read", "[aero][grid][fast]") {
  const ScratchFile file("grid.cgns");
  if (!cgns_available()) {
    CHECK_THROWS_AS(write_cgns(cylinder({}), file.path), scene::SceneError);
    return;
  }
  const int which = GENERATE(0, 1, 2);
  const BoxOptions box{.ni = 6, .nj = 7, .nk = 8, .periodic = {true, false, false}};
  const MultiBlockGrid grid = which == 0   ? turned_box(perturbed(cartesian_box(box), box, 0.05), 12)
                              : which == 1 ? turned_box(perturbed(planar_box(box), box, 0.05), 13)
                                           : naca0012({.n = 1});
  write_cgns(grid, file.path);
  const MultiBlockGrid back = read_cgns(file.path);
  CHECK(back.planar == grid.planar);
  CHECK(grid_faults(back).empty());
  REQUIRE(back.blocks.size() == grid.blocks.size());
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    REQUIRE(back.blocks[b].cells() == grid.blocks[b].cells());
    double gap = 0;
    for (std::size_t p = 0; p < grid.blocks[b].nodes.size(); ++p) {
      Eigen::Vector3d d = back.blocks[b].nodes[p] - grid.blocks[b].nodes[p];
      if (grid.planar) d.y() = 0;  // y is not in a planar file
      gap = std::max(gap, d.norm());
    }
    CHECK(gap == 0.0);
  }
  REQUIRE(back.connections.size() == grid.connections.size());
  int periodic = 0;
  for (const Connection& c : back.connections) periodic += c.periodic.has_value();
  for (const Connection& c : grid.connections) periodic -= c.periodic.has_value();
  CHECK(periodic == 0);
  REQUIRE(back.boundaries.size() == grid.boundaries.size());
  const auto of = [](const MultiBlockGrid& g) {
    std::vector<std::tuple<int, Side, std::array<int, 2>, std::array<int, 2>, std::string>> all;
    for (const Boundary& b : g.boundaries) all.emplace_back(b.where.block, b.where.side, b.where.low, b.where.high, b.patch);
    std::ranges::sort(all);
    return all;
  };
  CHECK(of(back) == of(grid));
}

TEST_CASE("patches whose names begin alike stay apart in a CGNS file", "[aero][grid][fast]") {
  if (!cgns_available()) return;
  const ScratchFile file("patches.cgns");
  MultiBlockGrid grid = cartesian_box({.ni = 4, .nj = 4, .nk = 4});
  REQUIRE(grid.boundaries.size() == 6);
  const std::string long_name = "the_surface_of_the_main_wing_upper";  // 34 letters
  const std::string names[] = {long_name, long_name + "_side", long_name.substr(0, 32), "tip", long_name, "tip"};
  for (std::size_t b = 0; b < 6; ++b) grid.boundaries[b].patch = names[b];
  write_cgns(grid, file.path);
  std::map<std::string, std::set<std::string>> read;  // by patch as written
  for (const Boundary& back : read_cgns(file.path).boundaries)
    for (const Boundary& b : grid.boundaries)
      if (b.where.side == back.where.side) read[b.patch].insert(back.patch);
  CHECK(read[long_name] == std::set<std::string>{long_name.substr(0, 32)});
  CHECK(read[long_name + "_side"] == std::set<std::string>{"the_surface_of_the_main__2"});
  CHECK(read[long_name.substr(0, 32)] == std::set<std::string>{"the_surface_of_the_main__3"});
  CHECK(read["tip"] == std::set<std::string>{"tip"});
}

TEST_CASE("what is no CGNS file is refused by name", "[aero][grid][fast]") {
  const ScratchFile file("grid.cgns");
  std::ofstream(file.path) << "not a grid";
  CHECK_THROWS_AS(read_cgns(file.path), scene::SceneError);
  CHECK_THROWS_AS(read_cgns("/no/such/file.cgns"), scene::SceneError);
}

#ifdef SPINDRIFT_CGNS
namespace {
/// Changes a file by the library's own calls, beginning at its first base or a node below.
template <class Change>
void change(const ScratchFile& file, Change what) {
  int number = 0;
  REQUIRE(cg_open(file.path.c_str(), CG_MODE_MODIFY, &number) == CG_OK);
  what(number);
  REQUIRE(cg_close(number) == CG_OK);
}
void say_unit(LengthUnits_t unit) { REQUIRE(cg_units_write(Kilogram, unit, Second, Kelvin, Degree) == CG_OK); }
}  // namespace

TEST_CASE("a CGNS file's lengths are in the unit stated nearest to them", "[aero][grid][fast]") {
  const ScratchFile file("units.cgns");
  write_cgns(cartesian_box({.ni = 4, .nj = 4, .nk = 4, .high = {2, 2, 2}}), file.path);
  const auto last = [&] { return read_cgns(file.path).blocks[0].nodes.back(); };
  CHECK(last() == Eigen::Vector3d(2, 2, 2));
  change(file, [](int f) { cg_goto(f, 1, "end"), say_unit(Millimeter); });
  CHECK((last() - Eigen::Vector3d(2e-3, 2e-3, 2e-3)).norm() < 1e-15);
  change(file, [](int f) { cg_goto(f, 1, "Zone_t", 1, "GridCoordinates_t", 1, "CoordinateY", 0, "end"), say_unit(Inch); });
  CHECK((last() - Eigen::Vector3d(2e-3, 0.0508, 2e-3)).norm() < 1e-15);
  change(file, [](int f) { cg_goto(f, 1, "Zone_t", 1, "end"), say_unit(LengthUnitsUserDefined); });
  CHECK_THROWS_WITH(last(), Catch::Contains("CoordinateX of zone 1 is in a unit of its own"));
}

TEST_CASE("a CGNS file with zones in two bases is refused, an empty base is none", "[aero][grid][fast]") {
  const ScratchFile file("bases.cgns");
  write_cgns(cartesian_box({.ni = 4, .nj = 4, .nk = 4}), file.path);
  int base = 0, zone = 0;
  change(file, [&](int f) { cg_base_write(f, "Second", 3, 3, &base); });
  CHECK(read_cgns(file.path).blocks.size() == 1);
  const cgsize_t size[9] = {2, 2, 2, 1, 1, 1, 0, 0, 0};
  change(file, [&](int f) { cg_zone_write(f, base, "more", size, Structured, &zone); });
  CHECK_THROWS_WITH(read_cgns(file.path), Catch::Contains("more than one base with zones"));
}
#endif
