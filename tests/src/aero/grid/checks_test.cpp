// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/checks.hpp"

#include <catch2/catch.hpp>

#include "src/aero/grid/quality.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {
MultiBlockGrid sound_grid() {
  return turned_box(cartesian_box({.ni = 6, .nj = 6, .nk = 6, .periodic = {true, false, false}}), 3);
}
std::string only_fault(const MultiBlockGrid& grid) {
  const auto faults = grid_faults(grid);
  REQUIRE(faults.size() == 1);
  return faults[0];
}
}  // namespace

TEST_CASE("sound grids have no faults", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const BoxOptions box{.ni = 8, .nj = 7, .nk = 6, .periodic = {true, true, false}};
  const MultiBlockGrid grid = perturbed(planar ? planar_box(box) : cartesian_box(box), box, 0.05);
  CHECK(grid_faults(grid).empty());
  for (unsigned seed = 0; seed < 5; ++seed) CHECK(grid_faults(turned_box(grid, seed)).empty());
  CHECK_NOTHROW(require_sound(grid, "box"));
}

TEST_CASE("each fault is named with its block and cell", "[aero][grid][fast]") {
  MultiBlockGrid grid = sound_grid();
  SECTION("a folded cell") {
    Block& b = grid.blocks[4];
    b.nodes[b.node(1, 1, 1)] += 3.0 * (b.nodes[b.node(2, 2, 2)] - b.nodes[b.node(1, 1, 1)]);
    CHECK_THAT(only_fault(grid), Contains("block 5 \"box-4\"") && Contains("have no positive volume: cells (i, j, k) (1, 1, 1)"));
  }
  SECTION("left-handed indices") {
    for (auto& x : grid.blocks[0].nodes) x = Vector3d(-x.x(), x.y(), x.z());
    CHECK_THAT(grid_faults(grid).back(), Contains("left-handed indices"));
  }
  SECTION("a node that is not finite") {
    grid.blocks[1].nodes[7].y() = NAN;
    CHECK_THAT(only_fault(grid), Contains("block 2") && Contains("is not finite"));
  }
  SECTION("a side without boundary") {
    const Window w = grid.boundaries[2].where;
    grid.boundaries.erase(grid.boundaries.begin() + 2);
    CHECK_THAT(only_fault(grid), Contains("block " + std::to_string(w.block + 1)) && Contains("no connection or boundary"));
  }
  SECTION("a boundary on top of a connection") {
    grid.boundaries.push_back({grid.connections[0].from, "twice"});
    CHECK_THAT(only_fault(grid), Contains("more than one connection or boundary"));
  }
  SECTION("a connection turned the wrong way round") {
    auto& o = grid.connections.back().orientation;  // both directions along the side reversed: still right-handed, wrong nodes
    const int across = direction_of(grid.connections.back().from.side);
    for (int d = 0; d < 3; ++d)
      if (d != across) o[d] = -o[d];
    CHECK_THAT(only_fault(grid), Contains("m from its partner, shortest edge there"));
  }
  SECTION("a connection through a mirror") {
    auto& c = grid.connections.back();
    c.orientation[along(c.from.side)[0]] *= -1;
    CHECK_THAT(only_fault(grid), Contains("left-handed as seen from the other"));
  }
  SECTION("a periodic map that misses") {
    for (Connection& c : grid.connections)
      if (c.periodic) c.periodic->translation.x() *= 1.001;
    CHECK_THAT(grid_faults(grid)[0], Contains("after the periodic map"));
  }
  SECTION("windows of different size") {
    auto& c = grid.connections.back();
    --c.to.high[0];
    CHECK_THAT(grid_faults(grid)[0], Contains(" meet "));
  }
  SECTION("a window beyond its block") {
    grid.boundaries[0].where.high[1] = 99;
    CHECK_THAT(only_fault(grid), Contains("[0, 99)") && Contains("runs from 0 to"));
  }
  SECTION("a block too thin") {
    grid = cartesian_box({.ni = 1, .nj = 3, .nk = 3});
    CHECK_THAT(only_fault(grid), Contains("has 1 cells in i: at least 2 are needed"));
    CHECK_THROWS_AS(require_sound(grid, "aero.grid"), scene::SceneError);
  }
}

TEST_CASE("quality finds the figures of a known grid and where they are", "[aero][grid][fast]") {
  const GridQuality box = grid_quality(cartesian_box({.ni = 4, .nj = 5, .nk = 6, .high = Vector3d(4, 10, 3)}));
  CHECK(box.cells == 120);
  CHECK(box.volume == Approx(120));
  CHECK(box.aspect_ratio.value == Approx(4));
  CHECK(box.skewness.value == Approx(0).margin(1e-12));
  CHECK(box.scaled_jacobian.value == Approx(1));
  CHECK(box.non_orthogonality.value == Approx(0).margin(1e-9));
  CHECK(box.stretch.value == Approx(1));

  MultiBlockGrid leaning = planar_box({.ni = 6, .nj = 6});
  deform(leaning, [](const Vector3d& x) { return Vector3d(x.x() + std::tan(0.5) * x.z(), x.y(), x.z()); });
  const GridQuality q = grid_quality(leaning);
  CHECK(q.skewness.value == Approx(0.5 / (std::acos(-1.0) / 2)));
  CHECK(q.scaled_jacobian.value == Approx(std::cos(0.5)));
  CHECK(q.non_orthogonality.value == Approx(0.5 * 180 / std::acos(-1.0)));

  MultiBlockGrid stretched = cartesian_box({.ni = 4, .nj = 4, .nk = 4});
  deform(stretched, [](const Vector3d& x) { return Vector3d(x.x(), x.y() > 0.6 ? x.y() + 0.75 : x.y(), x.z()); });
  const GridQuality s = grid_quality(stretched);
  CHECK(s.stretch.value == Approx(4));
  CHECK(s.stretch.j == 1);  // between cells 1 and 2
  CHECK(s.volume_ratio.value == Approx(4));
  CHECK_THAT(describe(s, stretched), Contains("largest stretch") && Contains("block 1 \"box\" cell ("));
}
