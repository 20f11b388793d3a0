// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/store.hpp"

#include <catch2/catch.hpp>

#include <utility>
#include <vector>

#include "kernels/rigid/rotation.hpp"
#include "runtime/partition/block_graph.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Eigen::Vector3d;

namespace {

GridStore make_store(const MultiBlockGrid& grid, bool moving) {
  Tiling tiling = make_tiling(grid, {}, small_tiles);
  GridStore store(tiling, std::vector<int>(tiling.size(), 0), 0);
  store.build_all(grid, moving);
  return store;
}

template <class Check>
void for_cells(const Tile& t, Check&& check) {
  for (int k = 0; k < t.nk; ++k)
    for (int j = 0; j < t.nj; ++j)
      for (int i = 0; i < t.ni; ++i) check(k, j, i);
}

/// By tile, with ghosts.
std::vector<std::vector<double>> volumes(const GridStore& store) {
  std::vector<std::vector<double>> all;
  for (const int t : store.owned()) all.emplace_back(store[t].volume_data.span().begin(), store[t].volume_data.span().end());
  return all;
}

/// Largest |sum of rates through a cell's faces - rate of change of its volume| over the sum of what all its faces sweep per
/// time. `before`: volumes one, two and three steps ago.
double gcl_error(GridStore& store, const std::array<std::vector<std::vector<double>>, 3>& before, TimeWeights w, double dt,
                 bool planar) {
  double worst = 0;
  for (const int t : store.owned()) {
    TileGeometry& g = store[t];
    const auto past = [&](std::size_t n) { return BoxView<const double>{before[n][std::size_t(t)].data(), g.cell_box}; };
    const BoxView<const double> v = g.volume(), old = past(0), older = past(1), oldest = past(2);
    for_cells(store.tiling().tiles[t], [&](int k, int j, int i) {
      double sum = 0, size = 1e-300;
      for (int d = 0; d < (planar ? 2 : 3); ++d) {
        const auto s = g.speed(d);
        const double low = s(0, k, j, i), high = s(0, k + (d == 2), j + (d == 1), i + (d == 0));
        sum += high - low, size += std::abs(high) + std::abs(low);
      }
      const double rate = (w.now * v(0, k, j, i) + w.old * old(0, k, j, i) + w.older * older(0, k, j, i) +
                           (w.oldest != 0.0 ? w.oldest * oldest(0, k, j, i) : 0.0)) /
                          dt;
      worst = std::max(worst, std::abs(rate - sum) / (size + std::abs(w.old) * v(0, k, j, i) / dt));
    });
  }
  return worst;
}

}  // namespace

TEST_CASE("face vectors of every cell cancel and volumes fill the box, in tiles of turned blocks", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const BoxOptions box{.ni = 11, .nj = 12, .nk = 10, .high = Vector3d(2, 3, 4)};
  const MultiBlockGrid grid = turned_box(perturbed(planar ? planar_box(box) : cartesian_box(box), box, 0.05), 7);
  GridStore store = make_store(grid, false);
  double volume = 0, open = 0;
  for (const int t : store.owned())
    for_cells(store.tiling().tiles[t], [&](int k, int j, int i) {
      Vector3d sum = Vector3d::Zero();
      double size = 0;
      for (int d = 0; d < (planar ? 2 : 3); ++d) {
        const auto s = store[t].face(d);
        const Vector3d low(s(0, k, j, i), s(1, k, j, i), s(2, k, j, i));
        const int kh = k + (d == 2), jh = j + (d == 1), ih = i + (d == 0);
        const Vector3d high(s(0, kh, jh, ih), s(1, kh, jh, ih), s(2, kh, jh, ih));
        sum += high - low, size += low.norm() + high.norm();
      }
      open = std::max(open, sum.norm() / size);
      volume += store[t].volume()(0, k, j, i);
    });
  CHECK(open < 4e-16);
  CHECK(volume == Approx(24).epsilon(1e-13));
}

TEST_CASE("two tiles see the same face, opposite cells and one another's volumes", "[aero][grid][fast]") {
  const BoxOptions box{.ni = 11, .nj = 12, .nk = 10, .periodic = {true, false, false}};
  const MultiBlockGrid grid = turned_box(perturbed(cartesian_box(box), box, 0.05), 8);
  GridStore store = make_store(grid, false);
  const Tiling& tiling = store.tiling();
  for (const GhostLink& l : tiling.links) {
    TileGeometry &to = store[l.to], &from = store[l.from];
    const int d = direction_of(l.side);
    const auto [a, b] = along(l.side);
    for (int v = l.low[1]; v < l.high[1]; ++v)
      for (int u = l.low[0]; u < l.high[0]; ++u) {
        Index ghost{}, face{};
        ghost[a] = face[a] = u, ghost[b] = face[b] = v;
        face[d] = at_end(l.side) ? tiling.tiles[l.to].cells()[d] : 0;
        ghost[d] = at_end(l.side) ? face[d] : -1;
        const Index donor = l.donor(ghost);
        REQUIRE(to.volume()(0, ghost[2], ghost[1], ghost[0]) == from.volume()(0, donor[2], donor[1], donor[0]));
        const auto s = to.face(d);
        const Vector3d mine =
            Vector3d(s(0, face[2], face[1], face[0]), s(1, face[2], face[1], face[0]), s(2, face[2], face[1], face[0]));
        const auto c = to.centre();
        Index inside = ghost;
        inside[d] += at_end(l.side) ? -1 : 1;
        const Vector3d across = Vector3d(c(0, ghost[2], ghost[1], ghost[0]) - c(0, inside[2], inside[1], inside[0]),
                                         c(1, ghost[2], ghost[1], ghost[0]) - c(1, inside[2], inside[1], inside[0]),
                                         c(2, ghost[2], ghost[1], ghost[0]) - c(2, inside[2], inside[1], inside[0]));
        REQUIRE((at_end(l.side) ? 1 : -1) * mine.dot(across) > 0.5 * mine.norm() * across.norm());
        REQUIRE(across.norm() < 0.2);
      }
  }
}

TEST_CASE("a moving and deforming grid conserves volume to round-off under BDF1, BDF2 and BDF3", "[aero][grid][fast]") {
  const int which = GENERATE(0, 1, 2), order = GENERATE(2, 3);
  const bool planar = which == 1;
  const BoxOptions box{.ni = 8, .nj = 9, .nk = 7};
  MultiBlockGrid grid = which == 2 ? thin_sheared_box(6, 1e-5)
                        : planar   ? turned_box(perturbed(planar_box(box), box, 0.05), 1)
                                   : turned_box(perturbed(cartesian_box(box), box, 0.05), 2);
  GridStore store = make_store(grid, true);
  if (order == 3)
    for (const int t : store.owned()) keep_third_step(store[t]);
  double previous = 0, long_previous = 0, time = 0, worst = 0;
  std::array<std::vector<std::vector<double>>, 3> past{volumes(store), volumes(store), volumes(store)};
  for (int step = 0; step < 5; ++step) {
    const double dt = 0.1 * (1 + 0.3 * step);
    time += dt;
    past[2] = std::exchange(past[1], std::exchange(past[0], volumes(store)));
    for (const int t : store.owned()) {
      begin_step(store[t]);
      if (which == 2) {  // rigid: a turn and a flight
        move_rigidly(store[t],
                     {attitude(Vector3d(0.3 * time, 0.1 * time, -0.5 * time)).toRotationMatrix(), Vector3d(time, 2 * time, 0)});
      } else {
        move_nodes(store[t], [&](const Vector3d& x) {
          const double c = std::cos(0.4 * time), s = std::sin(0.4 * time);
          const Vector3d y(x.x() + 0.05 * std::sin(time + 3 * x.z()), planar ? x.y() : x.y() * (1 + 0.1 * time),
                           x.z() + 0.1 * time * x.x() * x.z());
          return Vector3d(c * y.x() + s * y.z(), y.y(), -s * y.x() + c * y.z());
        });
      }
      update_metrics(store[t], planar);
      update_sweeps(store[t], planar);
    }
    const TimeWeights w = step == 0                 ? bdf1
                          : step == 1 || order == 2 ? bdf2(dt / previous)
                                                    : bdf3(dt / previous, previous / long_previous);
    for (const int t : store.owned()) update_speeds(store[t], w, dt, planar);
    worst = std::max(worst, gcl_error(store, past, w, dt, planar));
    long_previous = std::exchange(previous, dt);
  }
  INFO("GCL error " << worst << " grid " << which);
  CHECK(worst < 1e-14);
}

TEST_CASE("boundary ghosts mirror the cell inside", "[aero][grid][fast]") {
  const MultiBlockGrid grid = cartesian_box({.ni = 4, .nj = 4, .nk = 4});
  GridStore store = make_store(grid, false);
  for (const TileBoundary& b : store.tiling().boundaries)
    if (b.side == Side::k_max) {
      const auto c = store[b.tile].centre();
      const int k = store.tiling().tiles[b.tile].nk;
      CHECK(c(2, k, 0, 0) == Approx(2 * 1.0 - c(2, k - 1, 0, 0)));
      CHECK(c(0, k, 0, 0) == Approx(c(0, k - 1, 0, 0)));
      CHECK(store[b.tile].volume()(0, k, 0, 0) == Approx(1.0 / 64));
    }
}

TEST_CASE("tiles gathered into blocks and scattered again are the same numbers", "[aero][grid][fast]") {
  const MultiBlockGrid grid = turned_box(cartesian_box({.ni = 9, .nj = 10, .nk = 11}), 6);
  GridStore store = make_store(grid, false);
  const Tiling& tiling = store.tiling();
  std::vector<std::vector<double>> blocks;
  for (const Block& b : grid.blocks) blocks.emplace_back(std::size_t(b.ni) * b.nj * b.nk, -1.0);
  for (const int t : store.owned()) gather_cells(tiling, t, store[t].centre(), 1, blocks[tiling.tiles[t].block]);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = grid.blocks[b];
    for (int k = 0; k < block.nk; ++k)
      for (int j = 0; j < block.nj; ++j)
        for (int i = 0; i < block.ni; ++i) {
          double y = 0;
          for (int n = 0; n < 8; ++n) y += block.nodes[block.node(k + n / 4, j + n / 2 % 2, i + n % 2)].y() / 8;
          REQUIRE(blocks[b][(std::size_t(k) * block.nj + j) * block.ni + i] == Approx(y));
        }
  }
  for (const int t : store.owned()) {
    AlignedArray<double> back(store[t].cell_box.size(1));
    const BoxView<double> view{back.data(), store[t].cell_box};
    scatter_cells(tiling, t, blocks[tiling.tiles[t].block], 0, view);
    const Tile& tile = tiling.tiles[t];
    REQUIRE(view(0, tile.nk - 1, 0, tile.ni - 1) == store[t].centre()(1, tile.nk - 1, 0, tile.ni - 1));
  }
}

TEST_CASE("a tile for output holds its nodes and cells with the numbers of one place together", "[aero][grid][fast]") {
  const MultiBlockGrid grid = turned_box(cartesian_box({.ni = 6, .nj = 7, .nk = 5}), 6);
  GridStore store = make_store(grid, false);
  for (const int t : store.owned()) {
    const Tile& tile = store.tiling().tiles[t];
    std::vector<double> points(3 * (tile.ni + 1) * (tile.nj + 1) * (tile.nk + 1)), cells(2 * tile.count());
    copy_points(store[t], points);
    copy_cells(store[t].centre(), 1, 2, cells);
    const auto x = store[t].nodes();
    const auto c = store[t].centre();
    REQUIRE(points[3 * ((tile.nj + 1 + 1) * (tile.ni + 1) + 1) + 2] == x(2, 1, 1, 1));
    REQUIRE(cells[2 * (tile.nj * tile.ni + tile.ni + 1) + 1] == c(2, 1, 1, 1));
  }
}

TEST_CASE("a sector that flies and tilts keeps its periodic neighbours", "[aero][grid][fast]") {
  const double sector = 2 * std::acos(-1.0) / 3;
  MultiBlockGrid grid;
  grid.blocks.push_back(mapped_block("sector", 4, 6, 4, [&](double r, double phi, double z) {
    return Vector3d((1 + r) * std::cos(sector * phi), (1 + r) * std::sin(sector * phi), z);
  }));
  RigidMap turn;
  turn.rotation = Eigen::AngleAxisd(-sector, Vector3d::UnitZ()).toRotationMatrix();
  grid.connections = {{{0, Side::j_max, {0, 0}, {4, 4}}, {0, Side::j_min, {0, 0}, {4, 4}}, {1, 2, 3}, turn}};
  for (const Side s : {Side::i_min, Side::i_max}) grid.boundaries.push_back({{0, s, {0, 0}, {6, 4}}, "r"});
  for (const Side s : {Side::k_min, Side::k_max}) grid.boundaries.push_back({{0, s, {0, 0}, {4, 6}}, "z"});
  GridStore still = make_store(grid, false), store = make_store(grid, true);
  const RigidMap motion{attitude(Vector3d(0.2, -0.4, 0.3)).toRotationMatrix(), Vector3d(5, -3, 2)};
  for (const int t : store.owned()) move_rigidly(store[t], motion), update_metrics(store[t], false);
  store.fill_local_geometry(moved_maps(store.tiling().periodic, motion));
  double gap = 0;
  for (const GhostLink& l : store.tiling().links) {
    const auto [a, b] = along(l.side);
    Index ghost{};
    ghost[a] = l.low[0], ghost[b] = l.low[1];
    ghost[direction_of(l.side)] = at_end(l.side) ? store.tiling().tiles[l.to].cells()[direction_of(l.side)] : -1;
    const auto at = [&](GridStore& s) {
      const auto c = s[l.to].centre();
      return Vector3d(c(0, ghost[2], ghost[1], ghost[0]), c(1, ghost[2], ghost[1], ghost[0]), c(2, ghost[2], ghost[1], ghost[0]));
    };
    gap = std::max(gap, (motion.rotation * at(still) + motion.translation - at(store)).norm());
  }
  CHECK(gap < 1e-14);
}

TEST_CASE("what the store holds per cell is as documented, and a rank without tiles holds nothing", "[aero][grid][fast]") {
  const MultiBlockGrid grid = cartesian_box({.ni = 64, .nj = 64, .nk = 16});
  const std::vector<std::string> walls{"i_min"};
  Tiling tiling = make_tiling(grid, walls);
  CHECK(tile_graph(tiling).blocks() == tiling.size());
  const double cells = 64 * 64 * 16;
  GridStore still(tiling, std::vector<int>(tiling.size(), 0), 0),
      moving = GridStore(tiling, std::vector<int>(tiling.size(), 0), 0);
  still.build_all(grid, false), moving.build_all(grid, true);
  INFO(still.bytes() / cells << " bytes per cell; moving " << moving.bytes() / cells);
  CHECK(still.bytes() / cells < 200);
  CHECK(moving.bytes() / cells < 400);
  GridStore empty(tiling, std::vector<int>(tiling.size(), 0), 1);
  empty.build_all(grid, true);
  CHECK(empty.bytes() == 0);
}
