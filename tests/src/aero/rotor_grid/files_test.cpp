// A rotor grid written and read back is the same grid: what users' tools are given.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <filesystem>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

TEST_CASE("a rotor grid survives Plot3D and neutral map files, its rotational periodicity found again", "[rotor_grid][fast]") {
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec_of(1.0, 1e-3, 12.0, GENERATE(true, false)));
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_rotor_grid.p3d",
                              map = std::filesystem::path(file).replace_extension(".nmf");
  write_plot3d(grid, file, Plot3dForm::binary);
  write_neutral_map(grid, map);
  MultiBlockGrid back = read_plot3d(file);
  read_neutral_map(back, map);
  REQUIRE(back.blocks.size() == grid.blocks.size());
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) CHECK(back.blocks[b].nodes == grid.blocks[b].nodes);
  CHECK(back.connections.size() == grid.connections.size());
  CHECK(back.boundaries.size() == grid.boundaries.size());
  CHECK(grid_faults(back).empty());
  for (std::size_t b = 0; b < grid.boundaries.size() && b < back.boundaries.size(); ++b)
    CHECK(back.boundaries[b].patch == grid.boundaries[b].patch);
  CHECK(rotor_grid_quality(back, blade_walls()).interface_gap < 1e-11);
  std::filesystem::remove(file), std::filesystem::remove(map);
}
