// Where a flow's grid comes from: each generator by its keys, files, and what is refused with which words.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow_grid.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "src/aero/doubts.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/cgns.hpp"
#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/aero/options.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

FlowOptions read(const std::string& flow) {
  scene::Document doc =
      scene::parse("[aero]\nmodel = 'blade_resolved'\n[aero.flow]\n" + flow, "test.toml", std::filesystem::temp_directory_path());
  const AeroOptions air = doc.read(aero_section());
  doc.finish();
  return *air.flow;
}
MultiBlockGrid made(const std::string& generate) { return flow_grid(read("[aero.flow.generate]\n" + generate)); }
long cells(const MultiBlockGrid& grid) {
  long sum = 0;
  for (const Block& b : grid.blocks) sum += long(b.ni) * b.nj * b.nk;
  return sum;
}

}  // namespace

TEST_CASE("the declarations of a flow are sound in themselves", "[flow][fast]") {
  CHECK(flow_section().faults().empty());
  CHECK(generate_section().faults().empty());
}

TEST_CASE("every generator makes the grid that its keys say", "[flow][fast]") {
  CHECK(cells(made("kind = 'flat_plate'\nrefinement = 1\n")) == 34 * 24);
  CHECK(cells(made("kind = 'naca0012'\nrefinement = 1\nfar_m = 50\n")) == 112 * 32);
  CHECK(cells(made("kind = 'bump'\nrefinement = 1\n")) == 44 * 20);
  CHECK(cells(made("kind = 'wing'\nrefinement = 1\nspan_cells = 3\nspan_m = 0.5\n")) == 112 * 32 * 3);
  CHECK(cells(made("kind = 'cylinder'\naround = 32\noutward = 16\nradius_m = 1\nfar_m = 20\n")) == 32 * 16);
  const MultiBlockGrid flat = made("kind = 'box'\ncells = [6, 1, 4]\nperiodic = ['x']\n");
  CHECK(flat.planar);
  CHECK(cells(flat) == 24);
  CHECK(flat.connections.size() == 1);
  CHECK(flat.boundaries.size() == 2);
  CHECK(flat.boundaries[0].patch == "z_min");
  const MultiBlockGrid box = made("kind = 'box'\ncells = [3, 4, 5]\nhigh_m = [1, 2, 3]\n");
  CHECK(!box.planar);
  CHECK(cells(box) == 60);
  CHECK(box.boundaries.size() == 6);
}

TEST_CASE("a section by its digits is that by its coordinates, with no file", "[flow][fast]") {
  const std::string common = "kind = 'aerofoil'\nrefinement = 1\nfar_m = 50\n";
  const Block file =
      made(common + "coordinates = '" + std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/tutorials/naca4412.dat'\n").blocks[0];
  for (const auto& [edge, bar] : {std::pair("closed", 5e-4), std::pair("open", 5e-4)}) {  // the edge is .25 % of the chord
    const MultiBlockGrid grid = made(common + "naca = '4412'\ntrailing_edge = '" + edge + "'\n");
    const Block& b = grid.blocks[0];
    double worst = 0.0;
    for (int i = 24; i <= 88; ++i) worst = std::max(worst, (b.nodes[b.node(0, 0, i)] - file.nodes[file.node(0, 0, i)]).norm());
    INFO(edge << ": nodes on the section are off by up to " << worst);
    CHECK(worst < bar);
  }
  for (const char* digits : {"0006", "0021", "2412", "6409", "23012", "24112", "43018"}) {
    INFO(digits);
    CHECK(cells(made(common + "naca = '" + digits + "'\n")) == 112 * 32);
  }
  CHECK(cells(made("kind = 'wing'\nnaca = '2412'\nrefinement = 1\nspan_cells = 3\nspan_m = 0.5\n")) == 112 * 32 * 3);
  const std::string open = "[aero.flow.generate]\n" + common;
  CHECK_THROWS_WITH(read(open), Contains("aero.flow.generate.naca") && Contains("coordinates"));
  CHECK_THROWS_WITH(read(open + "naca = 'NACA 0012'\n"), Contains("aero.flow.generate.naca") && Contains("digits alone"));
  CHECK_THROWS_WITH(read(open + "naca = '012'\n"), Contains("four or five digits"));
  CHECK_THROWS_WITH(read(open + "naca = '4012'\n"), Contains("both are 0, or neither"));
  CHECK_THROWS_WITH(read(open + "naca = 4412\n"), Contains("aero.flow.generate.naca") && Contains("4412"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'naca0012'\nnaca = '4412'\n"), Contains("only"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'wing'\ntrailing_edge = 'open'\n"), Contains("needs `naca`"));
}

TEST_CASE("the size of a grid is known before it is made, and the key that decides it", "[flow][fast]") {
  const std::string section = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/tutorials/naca4412.dat";
  for (const auto& [generate, key] : std::initializer_list<std::pair<std::string, std::string>>{
           {"kind = 'flat_plate'\nrefinement = 3\n", "refinement"},
           {"kind = 'naca0012'\nrefinement = 2\n", "refinement"},
           {"kind = 'aerofoil'\nrefinement = 2\ncoordinates = '" + section + "'\n", "refinement"},
           {"kind = 'aerofoil'\nrefinement = 2\nnaca = '23012'\n", "refinement"},
           {"kind = 'bump'\nrefinement = 3\n", "refinement"},
           {"kind = 'wing'\nrefinement = 1\nspan_cells = 3\n", "span_cells"},
           {"kind = 'cylinder'\naround = 32\noutward = 16\n", "around"},
           {"kind = 'box'\ncells = [3, 4, 5]\n", "cells"}}) {
    CAPTURE(generate);
    const FlowOptions o = read("[aero.flow.generate]\n" + generate);
    CHECK(generated_size(*o.generate).cells == double(cells(flow_grid(o))));
    CHECK(generated_size(*o.generate).key == "aero.flow.generate." + key);
  }
}

TEST_CASE("a CGNS file needs no map and gives the grid that was written", "[flow][fast]") {
  if (!cgns_available()) return;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_flow_grid_test.cgns";
  write_cgns(flat_plate(1), file);
  const MultiBlockGrid back = flow_grid(read("grid = '" + file.string() + "'\n"));
  CHECK(cells(back) == 34 * 24);
  CHECK(back.boundaries.size() == 5);
  std::filesystem::remove(file);
}

TEST_CASE("a grid that is not said, or said twice, or said wrongly is refused with what is wrong", "[flow][fast]") {
  CHECK_THROWS_WITH(read(""), Contains("aero.flow.grid") && Contains("must be given, or [aero.flow.generate]"));
  const std::string file = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/validation/naca0012/tmr_112x32.p3d";
  CHECK_THROWS_WITH(read("grid = '" + file + "'\n"), Contains("aero.flow.map") && Contains("Plot3D grid holds coordinates only"));
  CHECK_THROWS_WITH(read("grid = '" + file + "'\n[aero.flow.generate]\nkind = 'bump'\n"), Contains("one of the two"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nrefinement = 2\n"), Contains("kind"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'cylinder'\nrefinement = 2\n"), Contains("refinement"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'cylinder'\nfar_m = 0.6\n"), Contains("must be above 2 radius_m = 1"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'box'\ncells = [3.5, 1, 4]\n"), Contains("whole numbers"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'box'\nhigh_m = [0, 1, 1]\n"), Contains("along x"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'box'\nperiodic = ['t']\n"), Contains("names axes"));
  CHECK_THROWS_WITH(read("[aero.flow.generate]\nkind = 'sphere'\n"), Contains("flat_plate"));
}

TEST_CASE("lines off a wall of more cells than a sweep holds are refused, with the key or the file", "[flow][fast]") {
  const std::string plate = "[aero.flow.generate]\nkind = 'flat_plate'\nrefinement = ",
                    wall = "\n[[aero.flow.boundaries]]\npatch = 'wall'\ncondition = 'no_slip'\n";
  const FlowOptions most = read(plate + "21" + wall), more = read(plate + "22" + wall);
  CHECK_NOTHROW(flow_tiling(most, flow_grid(most)));
  CHECK_THROWS_WITH(flow_tiling(more, flow_grid(more)),
                    Contains("aero.flow.generate.refinement = 22") && Contains("lines of 528 cells") && Contains("at most 512"));
  FlowOptions file = more;
  file.grid = "wing.cgns", file.generate.reset();
  CHECK_THROWS_WITH(flow_tiling(file, flow_grid(more)), Contains("wing.cgns") && Contains("528 cells"));
}

TEST_CASE("a width is refused where the grid has one of its own", "[flow][fast]") {
  const auto with = [](const std::string& kind) { return "width_m = 2.0\n[aero.flow.generate]\nkind = '" + kind + "'\n"; };
  for (const char* kind : {"flat_plate", "cylinder", "naca0012", "bump"}) CHECK(planar_width(read(with(kind))) == 2.0);
  for (const char* kind : {"box", "stretched_box", "wing"})
    CHECK_THROWS_WITH(read(with(kind)), Contains("aero.flow.width_m") && Contains("has no effect") && Contains(kind));
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_width_test.p3dfmt",
                              map = file.string() + ".nmf";
  for (const bool planar : {true, false}) {
    const BoxOptions box{.ni = 4, .nj = 4, .nk = 4};
    const MultiBlockGrid grid = planar ? planar_box(box) : cartesian_box(box);
    write_plot3d(grid, file, Plot3dForm::formatted), write_neutral_map(grid, map);
    const FlowOptions o = read("width_m = 2.0\ngrid = '" + file.string() + "'\nmap = '" + map.string() + "'\n");
    if (planar)
      CHECK_NOTHROW(flow_grid(o));
    else
      CHECK_THROWS_WITH(flow_grid(o), Contains("aero.flow.width_m = 2") && Contains("three dimensions"));
  }
  std::filesystem::remove(file), std::filesystem::remove(map);
}

TEST_CASE("coefficients are by a metre times width or span where no area is given", "[flow][fast]") {
  const std::string grid = "[aero.flow.generate]\nkind = ";
  CHECK(reference_area(read(grid + "'naca0012'\n")) == 1.0);
  CHECK(reference_area(read("width_m = 0.5\n" + grid + "'aerofoil'\nnaca = '4412'\n")) == 0.5);
  CHECK(reference_area(read(grid + "'wing'\nspan_m = 30.0\n")) == 30.0);
  CHECK(reference_area(read("reference_area_m2 = 3.0\n" + grid + "'wing'\nspan_m = 30.0\n")) == 3.0);
  CHECK(reference_area(read(grid + "'cylinder'\n")) == 1.0);
  CHECK(reference_area(read("width_m = 3.0\n" + grid + "'cylinder'\n")) == 3.0);
  const std::string section = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/validation/naca0012/tmr_112x32";
  CHECK(reference_area(read("width_m = 3.0\ngrid = '" + section + ".p3d'\nmap = '" + section + ".nmf'\n")) == 3.0);
  const auto doubted = [&](const std::string& keys) {
    for (const scene::Doubt& d : flow_doubts(read(keys + grid + "'wing'\nspan_m = 30.0\n"), 50.0, 1.0, 1.225))
      if (d.key == "aero.flow.reference_area_m2") return true;
    return false;
  };
  CHECK(doubted("reference_area_m2 = 1.0\n"));
  CHECK_FALSE(doubted(""));
}

TEST_CASE("closures are chosen by name, and refused with what is allowed", "[flow][fast]") {
  const std::string grid = "[aero.flow.generate]\nkind = 'cylinder'\n",
                    wall = "[[aero.flow.boundaries]]\npatch = 'wall'\ncondition = 'wall_function'\n";
  for (const char* name :
       {"sst_1994", "sst_v", "sst_2003_vm", "k_omega", "k_omega_1988", "des97", "ddes", "les_wale", "les_smagorinsky"})
    CHECK(read("turbulence = '" + std::string(name) + "'\n" + grid).turbulence == name);
  CHECK_THROWS_WITH(read("turbulence = 'k_epsilon'\n" + grid),
                    Contains("aero.flow.turbulence") && Contains("k_epsilon") && Contains("k_omega_1988"));
  CHECK_NOTHROW(read("turbulence = 'k_omega'\n" + grid + wall));
  CHECK_THROWS_WITH(read("turbulence = 'les_wale'\n" + grid + wall), Contains("wall_function") && Contains("les_wale"));
  const FlowOptions plane = read("turbulence = 'les_wale'\n" + grid);
  CHECK_THROWS_WITH(patch_conditions(plane, make_tiling(flow_grid(plane), {}, {})),
                    Contains("les_wale") && Contains("three dimensions"));
}

TEST_CASE("walls that stick are refused in inviscid air, with what to take", "[flow][fast]") {
  const std::string grid =
      "viscous = 'none'\n[aero.flow.generate]\nkind = 'cylinder'\n[[aero.flow.boundaries]]\npatch = 'wall'\n";
  CHECK_NOTHROW(read(grid + "condition = 'slip'\n"));
  CHECK_THROWS_WITH(read(grid + "condition = 'no_slip'\n"),
                    Contains("aero.flow.boundaries") && Contains("\"wall\"") && Contains("take condition = \"slip\","));
  CHECK_THROWS_WITH(read(grid + "condition = 'wall_function'\n"), Contains("take condition = \"slip\""));
  CHECK_THROWS_WITH(read(grid + "condition = 'no_slip'\ntemperature_K = 300\n"), Contains("and leave out temperature_K"));
}

TEST_CASE("an intensity of the wind's turbulence that would decay at once is refused", "[flow][fast]") {
  const std::string grid = "[aero.flow.generate]\nkind = 'cylinder'\n", by_itself = "turbulence = 'sst'\nwind_intensity = 0.01\n";
  CHECK_THROWS_WITH(read(by_itself + grid), Contains("aero.flow.wind_intensity") && Contains("give wind_eddy_viscosity too"));
  CHECK_NOTHROW(read(by_itself + "wind_eddy_viscosity = 10\n" + grid));
}
