// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/tiling.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <set>

#include "runtime/partition/partition.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift::aero;

TEST_CASE("index maps compose, invert and know their handedness", "[aero][grid][fast]") {
  int right = 0;
  for (const Index& axes : right_handed_axes(false)) {
    const IndexMap map{axes, {3, -1, 4}};
    ++right;
    CHECK(map.inverse()(map({5, 7, 11})) == Index{5, 7, 11});
    const IndexMap other{{-2, 1, 3}, {1, 2, 3}};
    CHECK(other.after(map)({5, 7, 11}) == other(map({5, 7, 11})));
  }
  CHECK(right == 24);
  CHECK(IndexMap{{2, 1, 3}, {}}.handedness() == -1);
}

TEST_CASE("tiles cover every cell of every block once, whatever the blocks' orientation", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const BoxOptions box{.ni = 23, .nj = 37, .nk = 19};
  const MultiBlockGrid grid = turned_box(planar ? planar_box(box) : cartesian_box(box), 3);
  const std::vector<std::string> walls{"j_min"};
  const Tiling tiling =
      make_tiling(grid, walls, {.across_j = 7, .across_k = 5, .planar_across = 6, .normal = 9, .planar_normal = 9});
  std::vector<std::vector<int>> count(grid.blocks.size());
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) count[b].resize(grid.blocks[b].ni * grid.blocks[b].nj * grid.blocks[b].nk);
  for (int t = 0; t < tiling.size(); ++t) {
    const Tile& tile = tiling.tiles[t];
    CHECK(tile.to_block.handedness() == 1);
    for (int k = 0; k < tile.nk; ++k)
      for (int j = 0; j < tile.nj; ++j)
        for (int i = 0; i < tile.ni; ++i) {
          const Index at = tile.to_block({i, j, k});
          const Index n = tiling.block_cells[tile.block];
          ++count[tile.block].at((at[2] * n[1] + at[1]) * n[0] + at[0]);
        }
  }
  for (const auto& block : count)
    for (const int c : block) REQUIRE(c == 1);
}

TEST_CASE("tiles have no more cells than they may, and lines from a wall are whole", "[aero][grid][fast]") {
  const MultiBlockGrid grid = cartesian_box({.ni = 24, .nj = 32, .nk = 64});
  const std::vector<std::string> walls{"j_min"};
  for (const int most : {8192, 2048, 600}) {
    const Tiling tiling = make_tiling(grid, walls, {.max_cells = most});
    for (const Tile& tile : tiling.tiles) {
      CHECK(tile.count() <= most);
      CHECK(tile.ni == 32);
    }
    CHECK(tiling.size() >= 24 * 32 * 64 / most);
    CHECK(tiling.size() <= 4 * 24 * 32 * 64 / most);
  }
  // Where there are no walls, and in the plane.
  for (const bool planar : {false, true})
    for (const int most : {4096, 300}) {
      const MultiBlockGrid open = planar ? planar_box({.ni = 200, .nk = 150}) : cartesian_box({.ni = 70, .nj = 24, .nk = 40});
      const Tiling tiling = make_tiling(open, {}, {.max_cells = most});
      for (const Tile& tile : tiling.tiles) CHECK(tile.count() <= most);
    }
}

TEST_CASE("every face of a tile's sides has one neighbour or one boundary", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  BoxOptions box{.ni = 13, .nj = 17, .nk = 11};
  box.periodic = {false, true, false};
  const MultiBlockGrid grid = turned_box(planar ? planar_box(box) : cartesian_box(box), 5);
  const Tiling tiling =
      make_tiling(grid, {}, {.across_j = 4, .across_k = 3, .planar_across = 4, .normal = 5, .planar_normal = 5});
  for (int t = 0; t < tiling.size(); ++t)
    for (int s = 0; s < (planar ? 4 : 6); ++s) {
      std::map<std::pair<int, int>, int> met;
      const auto add = [&](const auto& w) {
        if (w.side != Side(s)) return;
        for (int v = w.low[1]; v < w.high[1]; ++v)
          for (int u = w.low[0]; u < w.high[0]; ++u) ++met[{u, v}];
      };
      for (const auto& l : tiling.into(t)) add(l);
      for (const auto& b : tiling.boundary(t)) add(b);
      const auto [a, b] = along(Side(s));
      REQUIRE(int(met.size()) == tiling.tiles[t].cells()[a] * tiling.tiles[t].cells()[b]);
      for (const auto& [face, times] : met) REQUIRE(times == 1);
    }
}

TEST_CASE("the lines of a wall are whole, also in blocks beside it, and lie along i", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  BoxOptions box{.ni = 40, .nj = 200, .nk = 20};
  const MultiBlockGrid whole = planar ? planar_box(box) : cartesian_box(box);
  // Half of the lower side is a wall; the other half, in a block of its own, is not.
  const std::array<std::vector<int>, 3> cuts{{{20}, {}, {}}};
  MultiBlockGrid grid = split_at(whole, std::span(&cuts, 1));
  for (Boundary& b : grid.boundaries)
    if (b.patch == "j_min" && b.where.block == 0) b.patch = "wall";
  turn_blocks(grid, 11);
  const std::vector<std::string> walls{"wall"};
  const Tiling tiling = make_tiling(grid, walls);
  CHECK(tiling.size() >= 2);
  for (const Tile& tile : tiling.tiles) {
    CHECK(tile.ni == 200);
    CHECK(tile.count() <= TilingOptions{}.max_cells);
  }
  for (int t = 0; t < tiling.size(); ++t)
    for (const TileBoundary& b : tiling.boundary(t)) {
      const std::string& patch = tiling.patches[b.patch];
      CHECK((direction_of(b.side) == 0) == (patch == "wall" || patch == "j_min" || patch == "j_max"));
    }
}

TEST_CASE("cutting a grid along its tiles leaves the tiles as they are", "[aero][grid][fast]") {
  const MultiBlockGrid one = cartesian_box({.ni = 64, .nj = 64, .nk = 32});
  const std::vector<std::string> walls{"i_min"};
  const Tiling before = make_tiling(one, walls);
  for (const int parts : {2, 4, 8, 16}) {
    const MultiBlockGrid many = split(one, parts, walls);
    CHECK(int(many.blocks.size()) == parts);
    const Tiling after = make_tiling(many, walls);
    REQUIRE(after.size() == before.size());
    for (const Tile& t : after.tiles) CHECK(t.cells() == before.tiles[0].cells());
    CHECK(after.links.size() == before.links.size());
  }
}

TEST_CASE("rows along a section's wall are the same however its grid is cut, and on both sides of a face", "[aero][grid][fast]") {
  const MultiBlockGrid one = naca0012({.n = 1});
  const std::vector<std::string> walls{"wall"};
  const TilingOptions options{.sticky = walls};
  REQUIRE(one.blocks.size() == 1);
  REQUIRE((one.blocks[0].ni == 112 && one.blocks[0].nj == 32));
  const std::array<std::vector<int>, 3> none, into_wake_and_layers{{{6, 50, 106}, {10, 20}, {}}};
  for (const int seed : {1, 2, 3, 4, 5}) {
    MultiBlockGrid grid = split_at(one, std::span(seed == 1 ? &none : &into_wake_and_layers, 1));
    turn_blocks(grid, seed);
    const Tiling tiling = make_tiling(grid, walls, options);
    for (const Tile& t : tiling.tiles)
      for (int d = 0; d < 3; ++d) {
        const int cells = grid.blocks[std::size_t(t.block)].cells()[std::size_t(t.to_block.target(d))];
        const bool round = d < 2 && (cells == 112 || cells == 6 || cells == 44 || cells == 56);
        CHECK(t.along_wall[std::size_t(d)] == round);
        CHECK(t.ends_along_wall[std::size_t(2 * d)] == round);
        CHECK(t.ends_along_wall[std::size_t(2 * d + 1)] == round);
      }
    const Tiling smooth = make_tiling(grid, walls);
    for (const Tile& t : smooth.tiles) CHECK(t.along_wall == std::array{false, false, false});
  }
  // A corner of two walls: rows end at one of them.
  MultiBlockGrid corner = planar_box({.ni = 16, .nj = 16, .nk = 16});
  const std::vector<std::string> both{corner.boundaries[0].patch, corner.boundaries[2].patch};
  REQUIRE(direction_of(corner.boundaries[0].where.side) != direction_of(corner.boundaries[2].where.side));
  const Tiling tiling = make_tiling(corner, both, {.sticky = both});
  for (const Tile& t : tiling.tiles) CHECK(t.along_wall == std::array{false, false, false});
}

TEST_CASE("tiles shared out among ranks keep to their fair shares, and ranks may stay empty", "[aero][grid][fast]") {
  const MultiBlockGrid grid = cartesian_box({.ni = 64, .nj = 64, .nk = 32});
  const Tiling tiling = make_tiling(grid, {}, {.across_j = 8, .across_k = 8, .normal = 16});
  const auto shared = spindrift::runtime::partition_blocks(tile_graph(tiling), {.ranks = 4});
  CHECK(shared.within_tolerance);
  CHECK(shared.quality.empty_ranks == 0);
  CHECK(shared.quality.cut < 0.35 * shared.quality.edges);
  const Tiling few = make_tiling(grid, {}, {.across_j = 64, .across_k = 32, .normal = 64, .max_cells = 1 << 20});
  REQUIRE(few.size() == 1);
  const auto lone = spindrift::runtime::partition_blocks(tile_graph(few), {.ranks = 3});
  CHECK(lone.quality.empty_ranks == 2);
}

TEST_CASE("one rank's messages are another's", "[aero][grid][fast]") {
  const MultiBlockGrid grid = turned_box(cartesian_box({.ni = 16, .nj = 16, .nk = 16, .periodic = {true, false, false}}), 2);
  const Tiling tiling = make_tiling(grid, {}, {.across_j = 4, .across_k = 4, .normal = 4});
  std::vector<int> rank_of_tile;
  for (int t = 0; t < tiling.size(); ++t) rank_of_tile.push_back(t * 7 % 3);  // ranks 0 ... 2; rank 3 stays empty
  std::size_t links = 0;
  for (int rank = 0; rank < 4; ++rank) {
    const LinkPlan plan = link_plan(tiling, rank_of_tile, rank);
    links += plan.local.size();
    for (const auto& send : plan.sends) {
      links += send.links.size();
      const LinkPlan other = link_plan(tiling, rank_of_tile, send.rank);
      const auto receive =
          std::find_if(other.receives.begin(), other.receives.end(), [&](const auto& m) { return m.rank == rank; });
      REQUIRE(receive != other.receives.end());
      CHECK(receive->links == send.links);
    }
  }
  CHECK(links == tiling.links.size());
  CHECK(link_plan(tiling, rank_of_tile, 3).sends.empty());
}
