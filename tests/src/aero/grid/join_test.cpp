// Cuts moved into the middle of a block: the same cells, whatever lies beside them.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/join.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/split.hpp"
#include "src/aero/grid/tiling.hpp"

using namespace spindrift::aero;

namespace {

/// Middles of all cells, sorted.
std::vector<std::array<double, 3>> middles(const MultiBlockGrid& grid) {
  std::vector<std::array<double, 3>> all;
  for (const Block& b : grid.blocks)
    for (int k = 0; k < b.nk; ++k)
      for (int j = 0; j < b.nj; ++j)
        for (int i = 0; i < b.ni; ++i) {
          Eigen::Vector3d sum = Eigen::Vector3d::Zero();
          for (int corner = 0; corner < 8; ++corner) sum += b.nodes[b.node(k + corner / 4, j + corner / 2 % 2, i + corner % 2)];
          all.push_back({std::round(sum.x() * 1e9), std::round(sum.y() * 1e9), std::round(sum.z() * 1e9)});
        }
  std::ranges::sort(all);
  return all;
}

}  // namespace

TEST_CASE("a C grid's wake becomes one block across its cut, with the same cells and sound connections", "[aero][grid][fast]") {
  const MultiBlockGrid whole = naca0012({.n = 1});
  MultiBlockGrid turned = whole;
  const bool other = GENERATE(false, true);
  if (other) reorient(turned, 0, {-2, 1, 3});  // the cut at a high side
  const MultiBlockGrid joined = join_cuts(turned, 512);
  REQUIRE(joined.blocks.size() == 2);
  require_sound(joined, "joined");
  CHECK(middles(joined) == middles(whole));
  long across = 0;
  for (const Block& b : joined.blocks) across = std::max<long>(across, std::max(b.ni, b.nj));
  CHECK(across == 64);  // of the aerofoil along its wall, and of the wake across
  for (const Connection& c : joined.connections) CHECK(c.from.block != c.to.block);
  // A wake's lines go through the cut, as the wall's beside them.
  const std::vector<std::string> walls{"wall"};
  const Tiling tiling = make_tiling(joined, walls);
  CHECK(std::ranges::count_if(tiling.tiles, [](const Tile& t) { return t.ni == 64; }) > 0);
}

TEST_CASE("grids without a cut, and cuts whose lines would be too long, stay as they are", "[aero][grid][fast]") {
  CHECK(join_cuts(cylinder({.around = 16, .outward = 8}), 512).blocks.size() == 1);
  CHECK(join_cuts(naca0012({.n = 1}), 60).blocks.size() == 1);
}
