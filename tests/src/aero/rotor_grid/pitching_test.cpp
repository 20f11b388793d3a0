// Blade pitch as motion of the grid: blades turn rigidly, interfaces stay one, hub and box hold, no cell folds within the stated
// range. SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/pitching.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "src/aero/rotor_grid/stations.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

BladePitching pitching_of(const MultiBlockGrid& grid, const RotorGridSpec& spec, const std::function<bool(int k)>& needed = {}) {
  BladePitching pitching(grid, surface_radii(grid.blocks[0]), dtu(), spec);
  pitching.add_rows(one_part(grid), needed);
  return pitching;
}

MultiBlockGrid pitched(const MultiBlockGrid& grid, const BladePitching& pitching, double change) {
  MultiBlockGrid moved = grid;
  for (int b = 0; b < int(grid.blocks.size()); ++b)
    if (pitching.moves(b)) pitching.move(moved.blocks[std::size_t(b)], b, change);
  return moved;
}

}  // namespace

TEST_CASE("no change of pitch leaves every node where it is, bit by bit", "[rotor_grid][fast]") {
  const RotorGridSpec spec = spec_of(1.0, 2e-3, 0.0, true);
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  const MultiBlockGrid same = pitched(grid, pitching_of(grid, spec), 0.0);
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) CHECK(same.blocks[b].nodes == grid.blocks[b].nodes);
}

TEST_CASE("blades pitch as rigid bodies; grids stay whole within 15 degrees either way", "[rotor_grid][fast]") {
  const RotorGridSpec spec = spec_of(GENERATE(1.0, 2.04), 5e-4, 0.0, true);
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  const BladePitching pitching = pitching_of(grid, spec);
  const double change = GENERATE(-15.0, -5.0, 5.0, 15.0) * radians_per_degree;
  const MultiBlockGrid moved = pitched(grid, pitching, change);
  const RotorGridQuality q = rotor_grid_quality(moved, blade_walls());
  INFO("scaled Jacobian " << q.general.scaled_jacobian.value);
  CHECK(q.folded == 0);
  CHECK(q.interface_gap < 1e-14);
  CHECK(q.general.scaled_jacobian.value > 0.05);
  CHECK(q.general.volume == Approx(grid_quality(grid).volume).epsilon(1e-5));
  for (const int block : {0, 10, 20}) {
    const Block &before = grid.blocks[std::size_t(block)], &after = moved.blocks[std::size_t(block)];
    const Eigen::AngleAxisd turn(-change, pitching.axis(block));
    double rigid = 0.0, off_hub = 0.0;
    for (int k = 0; k <= spec.sizes.span; ++k)
      for (int j = 0; j <= before.nj; ++j) {
        const Eigen::Vector3d &p = before.nodes[before.node(k, j, 0)], &m = after.nodes[after.node(k, j, 0)];
        // Above the root circle nodes are carried; on it they slide along its straight lines, and stay on its surface.
        if (std::hypot(p.y(), p.z()) > 10.5) rigid = std::max(rigid, (turn * p - m).norm());
        if (k == 0) off_hub = std::max(off_hub, std::abs(std::hypot(m.y(), m.z()) - 5.0));
      }
    CHECK(rigid < 1e-12);
    CHECK(off_hub < 1e-12);
  }
}

TEST_CASE("nodes pitch alike where only the rows of a rank's tiles are known", "[rotor_grid][fast]") {
  const RotorGridSpec spec = spec_of(1.0, 2e-3, 0.0, true);
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  const BladePitching all = pitching_of(grid, spec), some = pitching_of(grid, spec, [](int k) { return k >= 3 && k <= 7; });
  const double change = 5.0 * radians_per_degree;
  for (const int block : {0, 10}) {
    const Block& ring = grid.blocks[std::size_t(block)];
    for (int k = 3; k <= 7; ++k)
      for (int j = 0; j <= ring.nj; ++j)
        for (int i = 0; i <= ring.ni; ++i) {
          const Eigen::Vector3d& x = ring.nodes[ring.node(k, j, i)];
          CHECK(some.node(block, k, j, i, change, x) == all.node(block, k, j, i, change, x));
        }
  }
  CHECK_THROWS(some.share(0, 8, 0, 0));
}

TEST_CASE("a pitched grid has its noses upwind, where a grid made at that pitch has them", "[rotor_grid][fast]") {
  RotorGridSpec spec = spec_of(1.0, 2e-3, 0.0, true);
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  const BladePitching pitching = pitching_of(grid, spec);
  const double change = 8.0 * radians_per_degree;
  const MultiBlockGrid moved = pitched(grid, pitching, change);
  spec.pitch = change;
  const MultiBlockGrid made = make_rotor_grid(dtu(), spec);
  // Of blade 1, which points up and moves towards -y: its foremost node of each section.
  const auto nose = [](const MultiBlockGrid& of, int k) {
    const Block& ring = of.blocks[0];
    Eigen::Vector3d foremost = ring.nodes[ring.node(k, 0, 0)];
    for (int j = 0; j <= ring.nj; ++j)
      if (const Eigen::Vector3d& p = ring.nodes[ring.node(k, j, 0)]; p.y() < foremost.y()) foremost = p;
    return foremost;
  };
  for (const int k : {spec.sizes.span / 3, spec.sizes.span / 2, 3 * spec.sizes.span / 4}) {
    const Eigen::Vector3d before = nose(grid, k), after = nose(moved, k), expected = nose(made, k);
    CAPTURE(k, before.transpose(), after.transpose(), expected.transpose());
    CHECK(after.x() < before.x());
    CHECK((after - expected).norm() < 0.2 * (after - before).norm());
  }
}

TEST_CASE("stations of loads cover the blade and know their directions", "[rotor_grid][fast]") {
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec_of(1.5, 1e-3, 0.0, true));
  std::vector<std::vector<BladeStation>> blades;
  add_stations(one_part(grid), blades);
  REQUIRE(blades.size() == 3);
  for (const auto& blade : blades) {
    double length = 0.0;
    for (const BladeStation& s : blade) {
      length += s.length;
      CHECK(s.normal.dot(s.tangential) == Approx(0.0).margin(1e-12));
      CHECK(s.tangential.norm() == Approx(1.0));
      CHECK(s.tangential.dot(s.chordwise) > 0.9);  // noses point the way the rotor turns
    }
    CHECK(length == Approx(88.935 - 5.0).margin(0.01));
    CHECK(blade[9].wetted_area > 2.0 * 0.97 * blade[9].chord * blade[9].length);
    CHECK(blade[9].wetted_area < 2.4 * blade[9].chord * blade[9].length);
  }
  // Blade 1 points up and moves towards -y; a force of 3 N downwind and 5 N that way.
  const BladeStation& s = blades[0][10];
  const StationLoad load = load_at(s, Eigen::Vector3d(3.0, -5.0, 0.0));
  CHECK(load.normal == Approx(3.0 / s.length));
  CHECK(load.tangential == Approx(5.0 / s.length).epsilon(1e-3));
}
