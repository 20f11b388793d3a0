// The NACA 0012 wing from the blade's lofter.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/wing.hpp"

#include <catch2/catch.hpp>

#include "src/aero/grid/checks.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

TEST_CASE("a NACA 0012 wing's grid is sound, symmetric, and has the section's area and first cells", "[rotor_grid][fast]") {
  WingSpec spec;
  spec.spacing.round = GENERATE(120, 240);
  spec.layers = spec.spacing.round / 4;
  spec.spacing.leading_edge = 0.48 / spec.spacing.round, spec.spacing.trailing_edge = 0.72 / spec.spacing.round;
  spec.first_cell_chords = 1e-4, spec.chord_m = 2.0, spec.span_chords = 0.5;
  const MultiBlockGrid grid = make_wing_grid(naca_symmetric(0.12), spec);
  CHECK(grid_faults(grid).empty());
  const RotorGridQuality q = rotor_grid_quality(grid, {"wing"});
  INFO(describe_quality(grid, q));
  CHECK(q.folded == 0);
  CHECK(q.general.scaled_jacobian.value > 0.45);
  CHECK(q.wall_orthogonality_median < 1.0);
  CHECK(q.first_cell_high == Approx(2e-4).epsilon(0.05));
  CHECK(q.interface_gap < 1e-12);
  const Block& b = grid.blocks[0];
  double area = 0.0;
  for (int j = 0; j < b.nj; ++j) {
    const Eigen::Vector3d &p = b.nodes[b.node(0, j, 0)], &n = b.nodes[b.node(0, j + 1, 0)];
    area += 0.5 * (n.x() * p.z() - p.x() * n.z());
    CHECK(p.z() == Approx(-b.nodes[b.node(0, b.nj - j, 0)].z()).margin(1e-8));
  }
  CHECK(area / 4.0 == Approx(0.6850 * 0.12).epsilon(0.005));  // integral of the thickness polynomial, blunt edge
}

TEST_CASE("a planar wing has one cell along the span and no conditions there", "[rotor_grid][fast]") {
  const MultiBlockGrid grid = make_wing_grid(naca_symmetric(0.12), {.span_cells = 5, .planar = true});
  CHECK(grid.planar);
  CHECK(grid.blocks[0].nk == 1);
  CHECK(grid_faults(grid).empty());
}
