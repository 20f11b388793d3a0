// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/wall_distance.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "kernels/grid/nearest_point.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Eigen::Vector3d;

namespace {

GridStore store_with_distance(const MultiBlockGrid& grid, std::vector<std::string> walls) {
  Tiling tiling = make_tiling(grid, walls);
  GridStore store(tiling, std::vector<int>(tiling.size(), 0), 0);
  store.build_all(grid);
  const WallSurface wall = wall_surface(grid, walls);
  for (const int t : store.owned()) fill_wall_distance(store[t], wall);
  return store;
}

template <class Check>
void for_cells(GridStore& store, Check&& check) {
  for (const int t : store.owned()) {
    const auto d = store[t].wall_distance();
    const auto c = store[t].centre();
    for (int k = 0; k < d.layout.nk; ++k)
      for (int j = 0; j < d.layout.nj; ++j)
        for (int i = 0; i < d.layout.ni; ++i) check(d(0, k, j, i), Vector3d(c(0, k, j, i), c(1, k, j, i), c(2, k, j, i)));
  }
}

}  // namespace

TEST_CASE("above a plane wall the distance is the height, past its end the distance to the edge", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const BoxOptions box{.ni = 12, .nj = 9, .nk = 8, .low = Vector3d(-1, 0, 0), .high = Vector3d(2, 0.5, 1)};
  const MultiBlockGrid whole = planar ? planar_box(box) : cartesian_box(box);
  const std::array<std::vector<int>, 3> cuts{{{4}, {}, {}}};  // x < 0 is no wall
  MultiBlockGrid grid = split_at(whole, std::span(&cuts, 1));
  const std::string floor = planar ? "j_min" : "k_min";
  for (Boundary& b : grid.boundaries)
    if (b.patch == floor && b.where.block == 1) b.patch = "wall";
  turn_blocks(grid, 9);
  GridStore store = store_with_distance(grid, {"wall"});
  for_cells(store,
            [](double d, const Vector3d& x) { REQUIRE(d == Approx(std::hypot(std::min(x.x(), 0.0), x.z())).epsilon(1e-14)); });
}

TEST_CASE("round a cylinder the distance converges to the radius outside, and the tree finds what a search of all finds",
          "[aero][grid][fast]") {
  std::vector<double> errors;
  for (const int n : {16, 32, 64}) {
    MultiBlockGrid grid;
    grid.blocks.push_back(mapped_block("ring", 6, n, 4, [](double r, double phi, double z) {
      const double angle = 2 * std::numbers::pi * phi;
      return Vector3d((1 + r * r) * std::cos(angle), (1 + r * r) * std::sin(angle), z);
    }));
    grid.connections.push_back({{0, Side::j_max, {0, 0}, {6, 4}}, {0, Side::j_min, {0, 0}, {6, 4}}, {1, 2, 3}, {}});
    grid.boundaries = {{{0, Side::i_min, {0, 0}, {n, 4}}, "wall"},
                       {{0, Side::i_max, {0, 0}, {n, 4}}, "far"},
                       {{0, Side::k_min, {0, 0}, {6, n}}, "sides"},
                       {{0, Side::k_max, {0, 0}, {6, n}}, "sides"}};
    GridStore store = store_with_distance(grid, {"wall"});
    const WallSurface wall = wall_surface(grid, std::vector<std::string>{"wall"});
    double error = 0;
    for_cells(store, [&](double d, const Vector3d& x) {
      error = std::max(error, std::abs(d - (std::hypot(x.x(), x.y()) - 1)));
      if (n > 32) return;
      double least = 1e9;
      for (const auto& f : wall.faces()) {
        const Vector3d m = 0.25 * (f[0] + f[1] + f[2] + f[3]);
        for (int e = 0; e < 4; ++e) least = std::min(least, (nearest_on_triangle(x, f[e], f[(e + 1) % 4], m) - x).norm());
      }
      REQUIRE(d == Approx(least).epsilon(1e-12));
    });
    errors.push_back(error);
  }
  CHECK(errors[0] / errors[1] == Approx(4).epsilon(0.1));  // the sagitta of the wall's faces
  CHECK(errors[1] / errors[2] == Approx(4).epsilon(0.1));
}

TEST_CASE("where periods meet, the wall beyond the corner counts", "[aero][grid][fast]") {
  const bool three = GENERATE(false, true);
  const MultiBlockGrid grid = cartesian_box({.ni = 4, .nj = 4, .nk = 4, .periodic = {true, true, three}});
  // A quarter by a quarter in one corner of the box.
  const std::vector<WallSurface::Face> faces{
      {Vector3d(0, 0, 0), Vector3d(0.25, 0, 0), Vector3d(0.25, 0.25, 0), Vector3d(0, 0.25, 0)}};
  const WallSurface wall = wall_surface(faces, grid.connections);
  const auto aside = [](double x) { return std::max(0.0, std::min(x - 0.25, 1.0 - x)); };
  for (const double x : {0.1, 0.5, 0.6, 0.7, 0.95})
    for (const double y : {0.1, 0.5, 0.6, 0.8, 0.99})
      for (const double z : {0.05, 0.4, 0.9}) {
        const double up = three ? std::min(z, 1.0 - z) : z;
        REQUIRE(wall.distance({x, y, z}) == Approx(Vector3d(aside(x), aside(y), up).norm()).epsilon(1e-13));
      }
}

TEST_CASE("the wall beyond a periodic side counts; without walls the distance is infinite", "[aero][grid][fast]") {
  BoxOptions box{.ni = 10, .nj = 4, .nk = 4, .periodic = {true, false, false}};
  const MultiBlockGrid whole = cartesian_box(box);
  const std::array<std::vector<int>, 3> cuts{{{2}, {}, {}}};
  MultiBlockGrid grid = split_at(whole, std::span(&cuts, 1));
  for (Boundary& b : grid.boundaries)
    if (b.patch == "k_min" && b.where.block == 0) b.patch = "wall";  // x in [0, 0.2], and again from x = 1
  GridStore store = store_with_distance(grid, {"wall"});
  for_cells(store, [](double d, const Vector3d& x) {
    const double aside = std::max(0.0, std::min(x.x() - 0.2, 1.0 - x.x()));
    REQUIRE(d == Approx(std::hypot(aside, x.z())).epsilon(1e-13));
  });
  GridStore none = store_with_distance(grid, {"no such patch"});
  for_cells(none, [](double d, const Vector3d&) { REQUIRE(std::isinf(d)); });
}
