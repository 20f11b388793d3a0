// y+ of first cells: what a plate's grid lets expect, and which walls do not suit their cells. SPDX-License-Identifier:
// Apache-2.0
#include "src/aero/first_cells.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/line_growth.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/aero/rotor_grid/rotor_grid.hpp"
#include "src/aero/turbine.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

TEST_CASE("the y+ expected on a plate follows from its first cells, its Reynolds number and White's friction", "[flow][fast]") {
  FlowOptions o;
  o.viscosity_Pa_s = 1e-5;
  o.boundaries = {{.patch = "wall", .condition = Condition::no_slip}, {.patch = "top", .condition = Condition::far_field}};
  const MultiBlockGrid grid = flat_plate(1);
  const FlowSetting setting = flow_setting(o, 1.2, {60.0, 0.0, 0.0}, 0.0);
  const FirstCells cells = expected_first_cells(grid, o, setting);
  REQUIRE(cells.resolved.size() == 28);
  CHECK(cells.by_law.empty());
  // The last face, 2 m from the edge at most: u_tau y / nu with y half of the first cell's height.
  const Block& block = grid.blocks[0];
  const double height = block.nodes[block.node(0, 1, block.ni)].z() - block.nodes[block.node(0, 0, block.ni)].z();
  const double re = 1.2 * 60.0 * 2.0 / 1e-5, friction = 0.027 / std::pow(re, 1.0 / 7.0);
  CHECK(cells.resolved.back().y_plus == Approx(60.0 * std::sqrt(0.5 * friction) * 0.5 * height * 1.2 / 1e-5).epsilon(0.01));
  double area = 0.0;
  for (const FirstCell& c : cells.resolved) area += c.area;
  CHECK(area == Approx(2.0));
  REQUIRE(doubts_of(cells, "").size() == 1);  // no first cell is doubted, the growth of so few layers is
  CHECK_THAT(doubts_of(cells, "")[0], Contains("cells grow from layer to layer"));
  CHECK(doubts_of(expected_first_cells(flat_plate(4), o, setting), "").empty());
  o.turbulence = "none";
  CHECK(expected_first_cells(grid, o, flow_setting(o, 1.2, {60.0, 0.0, 0.0}, 0.0)).resolved.empty());
}

TEST_CASE("a tenth of the walls' area off what their treatment wants is doubted, less is not", "[flow][fast]") {
  CHECK(doubts_of({.resolved = {{0.91, 1.0}, {0.09, 50.0}}, .by_law = {{0.91, 100.0}, {0.09, 1e5}}}, "").empty());
  const auto coarse = doubts_of({.resolved = {{0.8, 1.0}, {0.2, 50.0}}, .by_law = {}}, "");
  REQUIRE(coarse.size() == 1);
  CHECK_THAT(coarse[0], Contains("50 at most") && Contains("resolved walls want 0 to 5") && Contains("20 % of their area"));
  const auto fine = doubts_of({.resolved = {}, .by_law = {{1.0, 2.0}}}, "");
  REQUIRE(fine.size() == 1);
  CHECK_THAT(fine[0], Contains("wall-function walls want 15 to 1000"));
}

TEST_CASE("growth counts from the wall to y+ 300, shrinking like growing, and not beyond", "[flow][fast]") {
  FlowOptions o;
  o.viscosity_Pa_s = 1e-5;
  o.boundaries = {{.patch = "wall", .condition = Condition::no_slip}, {.patch = "top", .condition = Condition::far_field}};
  MultiBlockGrid grid = flat_plate(1);
  const FlowSetting setting = flow_setting(o, 1.2, {60.0, 0.0, 0.0}, 0.0);
  Block& block = grid.blocks[0];
  const auto z = [&](int j, int i) -> double& { return block.nodes[block.node(0, j, i)].z(); };
  // Heights of 1, 1.2, 1.44 ... times 1e-5 m, but for one layer of 1.8 times its lower neighbour's, and twice that far away.
  const auto stretch = [&](int odd, double times) {
    for (int k = 0; k <= block.nk; ++k)
      for (int i = 0; i <= block.ni; ++i) {
        double height = 1e-5;
        for (int j = 1; j <= block.nj; ++j) {
          block.nodes[block.node(k, j, i)].z() = block.nodes[block.node(k, j - 1, i)].z() + height;
          height *= j == odd ? times : 1.2;
        }
      }
  };
  const auto growth = [&] { return expected_first_cells(grid, o, setting).resolved.back().growth; };
  stretch(-1, 1.0);
  CHECK(growth() == Approx(1.2).epsilon(1e-9));
  const double y_plus = expected_first_cells(grid, o, setting).resolved.back().y_plus, unit = 0.5e-5 / y_plus;
  int last = 0;  // layer whose upper face is the last one below y+ 300
  while (z(last + 1, block.ni) < wall_layer_y_plus * unit) ++last;
  REQUIRE(last > 4);
  REQUIRE(last + 2 < block.nj);
  for (const int layer : {1, 3, last}) {
    stretch(layer, 1.8);
    CHECK(growth() == Approx(1.8).epsilon(1e-9));
    stretch(layer, 1.0 / 1.8);
    CHECK(growth() == Approx(1.8).epsilon(1e-9));
  }
  stretch(last + 1, 1.8);
  CHECK(growth() == Approx(1.2).epsilon(1e-9));
}

TEST_CASE("growth above 1.5 over a tenth of resolved walls is doubted with what mends it, at walls by the law it is not",
          "[flow][fast]") {
  CHECK(doubts_of({.resolved = {{0.91, 1.0, 1.4}, {0.09, 1.0, 3.0}}, .by_law = {}}, "").empty());
  CHECK(doubts_of({.resolved = {}, .by_law = {{1.0, 100.0, 3.0}}}, "").empty());
  FlowOptions o;
  o.grid = "coarse.p3d";
  const auto doubts = doubts_of({.resolved = {{0.4, 1.0, 1.4}, {0.4, 1.0, 1.4}, {0.2, 1.0, 1.6}}, .by_law = {}}, more_layers(o));
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], Contains("1.4 in the middle, 1.6 at most") && Contains("20 % of the walls' area has more than 1.5") &&
                            Contains("more layers than aero.flow.grid = \"coarse.p3d\""));
  o.generate.emplace();
  for (const auto& [kind, key] :
       {std::pair{"naca0012", "refinement"}, {"cylinder", "outward"}, {"box", "cells"}, {"stretched_box", "growth"}}) {
    o.generate->kind = kind;
    CHECK_THAT(more_layers(o), Contains(std::string("aero.flow.generate.") + key));
  }
}

TEST_CASE("growth off a rotor's resolved blades is foretold as its whole grid has it, from six surfaces of nodes",
          "[flow][fast]") {
  ResolvedRotorSetup s;
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.speed = 0.925, s.wind = {11.0, 0.0, 0.0};
  s.flow.blades = Condition::no_slip;
  s.grid.y_plus = 1.0;
  const auto growths = [](std::vector<FirstCell> cells) {
    std::ranges::sort(cells, {}, &FirstCell::growth);
    REQUIRE(!cells.empty());
    return std::array{cells[cells.size() / 2].growth, cells[cells.size() * 95 / 100].growth};
  };
  const Turbine turbine = read_turbine(s.rotor.turbine);
  double planform = 0.0;
  for (std::size_t n = 1; n < turbine.planform.span.size(); ++n)
    planform += 0.5 * (turbine.planform.chord[n] + turbine.planform.chord[n - 1]) *
                (turbine.planform.span[n] - turbine.planform.span[n - 1]);
  for (const auto& [layers, coarsen] : {std::pair{10, 0}, {32, 0}, {20, 1}}) {
    s.grid.cells_layers = layers, s.grid.coarsen = coarsen;
    const FirstCells foretold = expected_first_cells(s);
    CHECK(foretold.by_law.empty());
    double area = 0.0;
    for (const FirstCell& c : foretold.resolved) area += c.area;
    CHECK(area == Approx(2.0 * planform).epsilon(0.1));
    FlowOptions o = s.flow;
    o.boundaries = {{.patch = "blade_1", .condition = Condition::no_slip}};
    const RotorGridSpec spec = rotor_grid_spec(s.grid, turbine, 0.0, s.rotor.speed, 11.0);
    const FirstCells whole =
        expected_first_cells(make_rotor_grid(turbine, spec), o, flow_setting(o, 1.225, {0.0, 80.0, 0.0}, 0.0));
    const auto expected = growths(whole.resolved), found = growths(foretold.resolved);
    CAPTURE(layers, coarsen, expected[0], expected[1]);
    CHECK(found[0] == Approx(expected[0]).epsilon(0.03));
    CHECK(found[1] == Approx(expected[1]).epsilon(0.05));
    const auto doubts = doubts_of(foretold, "raise aero.grid.cells_layers");
    if (layers == 32) {
      CHECK(found[1] < doubted_growth);
      CHECK(doubts.empty());
    } else {
      REQUIRE(!doubts.empty());
      CHECK_THAT(doubts.back(), Contains("cells grow from layer to layer") && Contains("raise aero.grid.cells_layers"));
    }
  }
  s.flow.blades = Condition::wall_function;
  for (const FirstCell& c : expected_first_cells(s).by_law) CHECK(c.growth == 1.0);
}

TEST_CASE("the y+ expected on a rotor's blades is that asked of its grid, and says which walls suit them", "[flow][fast]") {
  ResolvedRotorSetup s;
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.speed = 0.925, s.wind = {11.0, 0.0, 0.0};
  s.flow.blades = Condition::wall_function;
  const auto middle = [](const std::vector<FirstCell>& cells) {
    double area = 0.0, sum = 0.0;
    for (const FirstCell& c : cells) area += c.area, sum += c.area * c.y_plus;
    return sum / area;
  };
  s.grid.y_plus = 100.0;
  const FirstCells asked = expected_first_cells(s);
  CHECK(asked.resolved.empty());
  CHECK(middle(asked.by_law) == Approx(100.0).epsilon(0.1));  // from the same law at half the chord
  double area = 0.0;
  for (const FirstCell& c : asked.by_law) area += c.area;
  const Planform blade = read_turbine(s.rotor.turbine).planform;
  double planform = 0.0;
  for (std::size_t n = 1; n < blade.span.size(); ++n)
    planform += 0.5 * (blade.chord[n] + blade.chord[n - 1]) * (blade.span[n] - blade.span[n - 1]);
  CHECK(area < 2.0 * planform);  // both sides, without the hub and the tip
  CHECK(area > 1.9 * planform);
  s.grid.coarsen = 1;
  CHECK(middle(expected_first_cells(s).by_law) == Approx(2.0 * middle(asked.by_law)));
  s.grid.coarsen = 0;
  CHECK(suits_wall_law(s));
  s.grid.y_plus = 1.0;
  CHECK_FALSE(suits_wall_law(s));
  CHECK(doubts_of(expected_first_cells(s), "").size() == 1);  // by the law, which wants 15
  s.grid = {}, s.flow.blades = Condition::no_slip;
  CHECK(suits_wall_law(s));
  REQUIRE(doubts_of(expected_first_cells(s), "").size() == 2);
  CHECK_THAT(doubts_of(expected_first_cells(s), "")[0], Contains("resolved walls want 0 to 5"));
  CHECK_THAT(doubts_of(expected_first_cells(s), "")[1], Contains("grow from layer to layer"));
  s.rotor.speed = 0.0;
  CHECK(suits_wall_law(s));  // at an assumed speed
  for (const char* without : {"none", "les_wale"}) {
    s.flow.turbulence = without;
    CHECK_FALSE(suits_wall_law(s));
  }
  s.flow.turbulence = "none";
  CHECK(expected_first_cells(s).resolved.empty());
}
