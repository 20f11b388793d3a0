// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/ghost_links.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr Quantity quantities[] = {Quantity::scalar, Quantity::vector, Quantity::point, Quantity::tensor};
constexpr int components = 16;

struct Fields {
  std::vector<AlignedArray<double>> data;
  std::vector<BoxLayout> layout;
  BoxView<double> operator[](int t) { return {data[t].data(), layout[t]}; }
};

using Values = Eigen::Matrix<double, components, 1>;

Values pack_values(double scalar, const Vector3d& vector, const Vector3d& point, const Matrix3d& tensor) {
  Values v;
  v << scalar, vector, point, tensor.row(0).transpose(), tensor.row(1).transpose(), tensor.row(2).transpose();
  return v;
}

Fields filled(const GridStore& store, const std::function<Values(const Vector3d&)>& at) {
  Fields f;
  for (int t = 0; t < store.tiling().size(); ++t) {
    const Tile& tile = store.tiling().tiles[t];
    f.layout.push_back(cell_layout(tile, state_ghosts, store.tiling().planar));
    f.data.emplace_back(f.layout.back().size(components));
    std::ranges::fill(f.data.back().span(), -7.0);
    const auto centre = store[t].centre();
    for (int k = 0; k < tile.nk; ++k)
      for (int j = 0; j < tile.nj; ++j)
        for (int i = 0; i < tile.ni; ++i) {
          const Values v = at({centre(0, k, j, i), centre(1, k, j, i), centre(2, k, j, i)});
          for (int c = 0; c < components; ++c) f[t](c, k, j, i) = v[c];
        }
  }
  return f;
}

/// Calls check(tile, k, j, i, layer) for every ghost cell a link fills.
template <class Check>
void for_ghost_cells(const GhostLink& l, const Tile& tile, Check&& check) {
  const auto [a, b] = along(l.side);
  for (int layer = 0; layer < state_ghosts; ++layer)
    for (int v = l.low[1]; v < l.high[1]; ++v)
      for (int u = l.low[0]; u < l.high[0]; ++u) {
        Index at{};
        at[a] = u, at[b] = v;
        at[direction_of(l.side)] = at_end(l.side) ? tile.cells()[direction_of(l.side)] + layer : -1 - layer;
        check(at, layer);
      }
}

GridStore whole_store(const MultiBlockGrid& grid, const TilingOptions& options) {
  Tiling tiling = make_tiling(grid, {}, options);
  std::vector<int> ranks(tiling.size(), 0);
  GridStore store(std::move(tiling), std::move(ranks), 0);
  store.build_all(grid);
  return store;
}

}  // namespace

TEST_CASE("ghost cells hold what lies beyond, through tiles, turned blocks and translations", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const unsigned seed = GENERATE(1u, 2u, 3u);
  BoxOptions box{.ni = 13, .nj = 11, .nk = 12, .high = Vector3d(13, 11, 12), .periodic = {true, false, false}};
  const MultiBlockGrid grid = turned_box(planar ? planar_box(box) : cartesian_box(box), seed);
  GridStore store = whole_store(grid, small_tiles);
  const double turn = 2 * std::numbers::pi / 13;
  const auto at = [&](const Vector3d& x) {  // periodic in x but for the point, which is the place itself
    const double s = std::sin(turn * x.x());
    return pack_values(s + x.y() + 2 * x.z(), {s, x.y(), x.z()}, x, s * Matrix3d::Identity() + x.z() * Matrix3d::Ones());
  };
  Fields f = filled(store, at);
  const auto& tiling = store.tiling();
  for (const GhostLink& l : tiling.links) copy_ghosts<double>(l, tiling.periodic, quantities, state_ghosts, f[l.from], f[l.to]);
  for (const GhostLink& l : tiling.links) {
    const Tile& tile = tiling.tiles[l.to];
    const auto centre = std::as_const(store)[l.to].centre();
    // The box is uniform: its index directions are the same everywhere in the tile.
    const auto c = [&](const Index& n) {
      return Vector3d(centre(0, n[2], n[1], n[0]), centre(1, n[2], n[1], n[0]), centre(2, n[2], n[1], n[0]));
    };
    for_ghost_cells(l, tile, [&](const Index& ghost, int) {
      const int d = direction_of(l.side);
      Index inside = ghost, next = ghost;
      inside[d] = at_end(l.side) ? tile.cells()[d] - 1 : 0;
      next[d] = at_end(l.side) ? inside[d] - 1 : inside[d] + 1;
      const Vector3d expected = c(inside) + std::abs(ghost[d] - inside[d]) * (c(inside) - c(next));
      const Values v = at(expected);
      for (int n = 0; n < components; ++n) REQUIRE(f[l.to](n, ghost[2], ghost[1], ghost[0]) == Approx(v[n]).margin(1e-12));
    });
  }
}

TEST_CASE("what comes through a buffer is what is copied, bit for bit", "[aero][grid][fast]") {
  BoxOptions box{.ni = 9, .nj = 8, .nk = 10, .periodic = {true, true, false}};
  MultiBlockGrid grid = turned_box(cartesian_box(box), 4);
  GridStore store = whole_store(grid, small_tiles);
  const auto& tiling = store.tiling();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto any = [&](const Vector3d&) {
    Values v;
    for (double& x : v) x = u(random);
    return v;
  };
  Fields copied = filled(store, any), sent;
  sent.layout = copied.layout;
  for (auto& a : copied.data) {
    sent.data.emplace_back(a.size());
    std::ranges::copy(a.span(), sent.data.back().data());
  }
  for (const GhostLink& l : tiling.links)
    copy_ghosts<double>(l, tiling.periodic, quantities, state_ghosts, copied[l.from], copied[l.to]);
  for (const GhostLink& l : tiling.links) {
    std::vector<double> buffer(packed_size(l, components, state_ghosts));
    double* end = pack<double>(l, components, state_ghosts, sent[l.from], sent.layout[l.to], buffer.data());
    CHECK(end == buffer.data() + buffer.size());
    const double* read = unpack<double>(l, tiling.periodic, quantities, state_ghosts, buffer.data(), sent[l.to]);
    CHECK(read == end);
  }
  for (std::size_t t = 0; t < copied.data.size(); ++t) REQUIRE(std::ranges::equal(copied.data[t].span(), sent.data[t].span()));
}

TEST_CASE("a sector's ghosts are turned onto its other side", "[aero][grid][fast]") {
  // A ring of three sectors about z; one sector with rotational periodicity sees the same neighbours.
  const double sector = 2 * std::numbers::pi / 3;
  const int n = 9;
  MultiBlockGrid grid;
  grid.blocks.push_back(mapped_block("sector", 6, n, 5, [&](double r, double phi, double z) {
    return Vector3d((1 + r) * std::cos(sector * phi), (1 + r) * std::sin(sector * phi), z);
  }));
  RigidMap map;
  map.rotation = Eigen::AngleAxisd(-sector, Vector3d::UnitZ()).toRotationMatrix();
  grid.connections.push_back({{0, Side::j_max, {0, 0}, {6, 5}}, {0, Side::j_min, {0, 0}, {6, 5}}, {1, 2, 3}, map});
  for (const Side s : {Side::i_min, Side::i_max}) grid.boundaries.push_back({{0, s, {0, 0}, {n, 5}}, "r"});
  for (const Side s : {Side::k_min, Side::k_max}) grid.boundaries.push_back({{0, s, {0, 0}, {6, n}}, "z"});
  turn_blocks(grid, GENERATE(1u, 2u));
  GridStore store = whole_store(grid, small_tiles);
  // Axisymmetric fields: swirl plus radial, their gradient (of u = (-y + x, x + y, r^2)), the place itself.
  const auto at = [](const Vector3d& x) {
    Matrix3d gradient;
    gradient << 1, -1, 0, 1, 1, 0, 2 * x.x(), 2 * x.y(), 0;
    return pack_values(x.z(), {x.x() - x.y(), x.x() + x.y(), x.x() * x.x() + x.y() * x.y()}, x, gradient);
  };
  Fields f = filled(store, at);
  const auto& tiling = store.tiling();
  for (const GhostLink& l : tiling.links) copy_ghosts<double>(l, tiling.periodic, quantities, state_ghosts, f[l.from], f[l.to]);
  int through = 0;
  for (const GhostLink& l : tiling.links)
    for_ghost_cells(l, tiling.tiles[l.to], [&](const Index& g, int layer) {
      const auto v = [&](int c) { return f[l.to](c, g[2], g[1], g[0]); };
      const Vector3d place(v(4), v(5), v(6));
      const Values expected = at(place);
      for (int c = 0; c < components; ++c) REQUIRE(v(c) == Approx(expected[c]).margin(1e-13));
      if (l.periodic < 0 || layer > 0) return;
      // The place continues the lines of cells: nearer to the cell inside than half the sector.
      Index inside = g;
      inside[direction_of(l.side)] += at_end(l.side) ? -1 : 1;
      const auto c = std::as_const(store)[l.to].centre();
      const Vector3d here(c(0, inside[2], inside[1], inside[0]), c(1, inside[2], inside[1], inside[0]),
                          c(2, inside[2], inside[1], inside[0]));
      REQUIRE((here - place).norm() < 2.1 * sector / n);
      ++through;
    });
  CHECK(through == 2 * 6 * 5);
}
