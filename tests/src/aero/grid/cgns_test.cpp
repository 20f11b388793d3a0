// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/cgns.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/grid/examples.hpp"

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

TEST_CASE("what is no CGNS file is refused by name", "[aero][grid][fast]") {
  const ScratchFile file("grid.cgns");
  std::ofstream(file.path) << "not a grid";
  CHECK_THROWS_AS(read_cgns(file.path), scene::SceneError);
  CHECK_THROWS_AS(read_cgns("/no/such/file.cgns"), scene::SceneError);
}
