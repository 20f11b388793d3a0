// The law of the wall in place of a resolved sublayer: the flat plate of flat_plate_test.cpp with its lowest cells replaced by
// one whose centre stands at y+ 30, 50, 100 (at x = 0.97), and in the sublayer and between, against friction and drag of the
// resolved grids. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/verification/air/plate.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// Of the plate's grid, one cell of this height at the wall in place of all that begin below 1.5 heights.
MultiBlockGrid coarse_at_wall(MultiBlockGrid grid, double height) {
  REQUIRE(grid.blocks.size() == 1);
  const Block from = grid.blocks[0];  // i along the wall, j away from it
  int first = 1;
  while (from.nodes[from.node(0, first, 0)][2] < 1.5 * height) ++first;
  const int gone = first - 2;
  Block to{.name = from.name, .ni = from.ni, .nj = from.nj - gone, .nk = from.nk};
  for (int k = 0; k <= to.nk; ++k)
    for (int j = 0; j <= to.nj; ++j)
      for (int i = 0; i <= to.ni; ++i) {
        to.nodes.push_back(from.nodes[from.node(k, j == 0 ? 0 : j + gone, i)]);
        if (j == 1) to.nodes.back()[2] = height;
      }
  grid.blocks[0] = to;
  for (Boundary& b : grid.boundaries) {
    const auto [a, c] = along(b.where.side);
    if (a == 1) b.where.high[0] -= gone;
    if (c == 1) b.where.high[1] -= gone;
  }
  return grid;
}

/// First centre at this y+ of the resolved friction; the free stream has Re 5e6 per metre.
PlateResult law_plate(int n, double y_plus, Condition wall_condition, const std::string& model = "sa", double drop = 1e-5) {
  const double height = 2.0 * y_plus / (5e6 * std::sqrt(0.5 * .0027056));
  FlowSetting s = plate_air(model);
  s.march.drop = drop, s.march.max_steps = 600;
  if (model != "sa") s.first_order_model = true, s.march.matrix_free_below = 2.0;
  Case c = plate_case(coarse_at_wall(flat_plate(n), height), s, wall_condition);
  c.run();
  CAPTURE(n, y_plus, model, c.solver->march().steps);
  CHECK(c.solver->march().verdict == Verdict::converged);
  CHECK(!c.solver->march().spent);
  return plate_result(c);
}

}  // namespace

// Each closure has its own law of the wall (wall_layer.hpp). Two references, 5 % to both: the closure's published friction on the
// finest grids (k-omega: that of our own grids, .0026482, .0026881, carried on), and its friction on the same cells above the
// wall, resolved below.
TEST_CASE("a wall function gives a plate's friction and drag on grids whose first cell stands in the logarithmic layer",
          "[flow][fast]") {
  for (const double y_plus : {30.0, 50.0, 100.0}) {
    const PlateResult law = law_plate(2, y_plus, Condition::wall_function);
    CAPTURE(y_plus, law.y_plus, law.friction, law.drag);
    CHECK(law.y_plus == Approx(y_plus).epsilon(0.03));
    CHECK(law.friction == Approx(.0027056).epsilon(0.03));
    CHECK(law.drag == Approx(.0028562).epsilon(0.04));
  }
  CHECK(law_plate(2, 50.0, Condition::no_slip).friction < .0015);  // what the same grid has without it
}

TEST_CASE("a wall function gives friction also with two equations", "[flow][fast]") {
  for (const auto& [model, same, limit] : {std::tuple{"sst_vm", .0026181, .0026909}, {"k_omega", .0026482, .00272}})
    for (const double y_plus : {30.0, 50.0, 100.0}) {
      const PlateResult law = law_plate(2, y_plus, Condition::wall_function, model);
      CAPTURE(model, y_plus, law.y_plus, law.friction, law.drag, law.steps);
      CHECK(law.y_plus == Approx(y_plus).epsilon(0.05));
      CHECK(law.friction == Approx(same).epsilon(0.03));
      CHECK(law.friction == Approx(limit).epsilon(0.045));
    }
}

TEST_CASE("a wall function on a resolved grid is the resolved wall", "[flow][fast]") {
  for (const double y_plus : {0.5, 1.0}) {
    const PlateResult law = law_plate(2, y_plus, Condition::wall_function), wall = law_plate(2, y_plus, Condition::no_slip);
    CAPTURE(y_plus, law.friction, wall.friction);
    CHECK(law.friction == Approx(wall.friction).epsilon(1e-3));
    CHECK(law.drag == Approx(wall.drag).epsilon(1e-3));
  }
  for (const char* model : {"sst_vm", "k_omega"}) {
    // At a drop of 1e-5 turbulence may still grow near the leading edge, with a hundredth of the drag to come.
    const PlateResult law = law_plate(2, 0.5, Condition::wall_function, model, 1e-7),
                      wall = law_plate(2, 0.5, Condition::no_slip, model, 1e-7);
    CAPTURE(model, law.friction, wall.friction);
    CHECK(law.friction == Approx(wall.friction).epsilon(0.01));
    CHECK(law.drag == Approx(wall.drag).epsilon(0.01));
  }
}

TEST_CASE("with two equations a wall function blends into the resolved wall through the buffer layer", "[flow][fast]") {
  for (const auto& [model, same] : {std::pair{"sst_vm", .0026181}, {"k_omega", .0026482}})
    for (const double y_plus : {1.0, 5.0, 11.0}) {
      const PlateResult law = law_plate(2, y_plus, Condition::wall_function, model);
      CAPTURE(model, y_plus, law.friction);
      CHECK(law.friction == Approx(same).epsilon(0.03));
    }
}
