// The report on grids round walls, on grids whose figures are known, and the stops that name block and cell.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/quality.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/failure.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

/// A box of 4 x 3 x 2 cells, sheared in x by `shear` per z, with a wall at i_min; sizes along i double.
MultiBlockGrid box(double shear) {
  Block b{.name = "box", .ni = 4, .nj = 3, .nk = 2};
  for (int k = 0; k <= 2; ++k)
    for (int j = 0; j <= 3; ++j)
      for (int i = 0; i <= 4; ++i) b.nodes.emplace_back(0.1 * (std::pow(2.0, i) - 1.0) + shear * k, j, k);
  MultiBlockGrid grid;
  grid.blocks.push_back(b);
  grid.boundaries.push_back({{0, Side::i_min, {0, 0}, {3, 2}}, "blade_1"});
  for (const Side s : {Side::i_max}) grid.boundaries.push_back({{0, s, {0, 0}, {3, 2}}, "far"});
  grid.connections.push_back({{0, Side::j_max, {0, 0}, {4, 2}},
                              {0, Side::j_min, {0, 0}, {4, 2}},
                              {1, 2, 3},
                              RigidMap{Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, -3.0, 0.0)}});
  return grid;
}

}  // namespace

TEST_CASE("a sheared box has the angles, growth and first cells it was made with", "[rotor_grid][fast]") {
  const MultiBlockGrid grid = box(0.5);
  const RotorGridQuality q = rotor_grid_quality(grid, {"blade_"});
  CHECK(q.folded == 0);
  CHECK(q.wall_growth.value == Approx(2.0));
  CHECK(q.stretch[0].value == Approx(2.0));
  CHECK(q.stretch[1].value == Approx(1.0));
  CHECK(q.wall_orthogonality.value == Approx(std::atan(0.5) / std::acos(-1.0) * 180.0));
  CHECK(q.first_cell_low == Approx(0.1 * std::cos(std::atan(0.5))));
  CHECK(q.interface_gap < 1e-15);
}

TEST_CASE("a folded, a weak or a torn grid is refused by block and cell", "[rotor_grid][fast]") {
  MultiBlockGrid grid = box(0.0);
  grid.blocks[0].nodes[grid.blocks[0].node(1, 1, 2)].x() += 5.0;
  CHECK_THROWS_WITH(require_quality(grid, rotor_grid_quality(grid, {"blade_"})),
                    Catch::Contains("fold") && Catch::Contains("box ("));
  grid = box(4.0);
  CHECK_THROWS_WITH(require_quality(grid, rotor_grid_quality(grid, {}), {.scaled_jacobian = 0.3}),
                    Catch::Contains("scaled Jacobian 0.24") && Catch::Contains("box ("));
  grid = box(0.0);
  grid.connections[0].periodic->translation.y() = -3.001;
  CHECK_THROWS_WITH(require_quality(grid, rotor_grid_quality(grid, {})), Catch::Contains("0.001 m apart"));
}
