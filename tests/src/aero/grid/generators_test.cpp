// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/quality.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift::aero;
using Eigen::Vector3d;

namespace {

/// Every second node of the finer member is a node of the coarser: one law, sampled.
double family_gap(const Block& coarse, const Block& fine) {
  double worst = 0;
  for (int j = 0; j <= coarse.nj; ++j)
    for (int i = 0; i <= coarse.ni; ++i)
      worst = std::max(worst, (coarse.nodes[coarse.node(0, j, i)] - fine.nodes[fine.node(0, 2 * j, 2 * i)]).norm());
  return worst;
}
/// Departure from 90 degrees between the wall and the first edge off it, in a range of i [deg].
double lean_at_wall(const Block& b, int first, int last) {
  double worst = 0;
  for (int i = first; i < last; ++i) {
    const Vector3d along = b.nodes[b.node(0, 0, i + 1)] - b.nodes[b.node(0, 0, i - 1)];
    const Vector3d off = b.nodes[b.node(0, 1, i)] - b.nodes[b.node(0, 0, i)];
    worst = std::max(worst, std::abs(std::asin(along.dot(off) / along.norm() / off.norm())) * 180 / std::acos(-1.0));
  }
  return worst;
}

}  // namespace

TEST_CASE("boxes of every kind are sound", "[aero][grid][fast]") {
  const BoxOptions box{.ni = 12, .nj = 10, .nk = 8, .periodic = {true, false, true}};
  CHECK(grid_faults(cartesian_box(box)).empty());
  CHECK(grid_faults(planar_box(box)).empty());
  for (const double amplitude : {0.02, 0.06}) {
    CHECK(grid_faults(perturbed(cartesian_box(box), box, amplitude)).empty());
    CHECK(grid_faults(perturbed(planar_box(box), box, amplitude)).empty());
  }
  const MultiBlockGrid thin = thin_sheared_box(8);
  CHECK(grid_faults(thin).empty());
  CHECK(grid_quality(thin).aspect_ratio.value ==
        Approx(1e5 / std::sqrt(3.0)).epsilon(1e-3));  // the leaning edge is longer than the cell is high
}

TEST_CASE("the flat plate is the TMR's grid", "[aero][grid][fast]") {
  std::ifstream file(SPINDRIFT_SOURCE_DIR "/tests/src/aero/grid/data/tmr_plate_34x24.p3d");
  int blocks = 0, ni = 0, nj = 0;
  REQUIRE(file >> blocks >> ni >> nj);
  REQUIRE((ni == 35 && nj == 25));
  std::vector<double> x(2 * ni * nj);
  for (double& v : x) REQUIRE(file >> v);
  const Block plate = flat_plate(1).blocks[0];
  double worst = 0;
  for (int j = 0; j < nj; ++j)
    for (int i = 0; i < ni; ++i) {
      const Vector3d& p = plate.nodes[plate.node(0, j, i)];
      worst = std::max({worst, std::abs(p.x() - x[j * ni + i]), std::abs(p.z() - x[ni * nj + j * ni + i])});
    }
  INFO("largest difference [m] " << worst);
  CHECK(worst < 1e-10);
  for (const int n : {1, 2, 4}) {
    CHECK(grid_faults(flat_plate(n)).empty());
    CHECK(family_gap(flat_plate(n).blocks[0], flat_plate(2 * n).blocks[0]) < 1e-14);
  }
}

TEST_CASE("the cylinder's O-grid closes, in cells as high as long or with the height asked for", "[aero][grid][fast]") {
  const MultiBlockGrid even = cylinder({.around = 64, .outward = 47, .far = 50});
  CHECK(grid_faults(even).empty());
  CHECK(grid_quality(even).aspect_ratio.value < 1.05);
  const MultiBlockGrid fine = cylinder({.around = 128, .outward = 80, .far = 50, .first_cell = 0.01});
  CHECK(grid_faults(fine).empty());
  const Block& b = fine.blocks[0];
  CHECK((b.nodes[b.node(0, 1, 5)] - b.nodes[b.node(0, 0, 5)]).norm() == Approx(0.005).epsilon(0.01));
  CHECK(family_gap(cylinder({.around = 32, .outward = 20, .first_cell = 0.01}).blocks[0],
                   cylinder({.around = 64, .outward = 40, .first_cell = 0.01}).blocks[0]) < 1e-13);
}

TEST_CASE("the NACA 0012 grid is sound at every size, normal to the wall and as fine as the TMR's", "[aero][grid][fast]") {
  for (const int n : {1, 2, 4}) {
    const MultiBlockGrid grid = naca0012({.n = n});
    CHECK(grid_faults(grid).empty());
    const GridQuality q = grid_quality(grid);
    INFO("n = " << n << "\n" << describe(q, grid));
    const Block& b = grid.blocks[0];
    CHECK(b.ni == 112 * n);
    CHECK(b.nj == 32 * n);
    CHECK(q.scaled_jacobian.value > 0.97);
    CHECK(lean_at_wall(b, 28 * n, 84 * n) < (n == 1 ? 1.5 : 0.5));  // away from the trailing edge
    CHECK(lean_at_wall(b, 24 * n + 1, 88 * n) < 5.0);               // beside it: lines turn towards the bisector
    // On the aerofoil, closed and sharp.
    CHECK((b.nodes[b.node(0, 0, 24 * n)] - Vector3d(1, 0, 0)).norm() == 0);
    CHECK((b.nodes[b.node(0, 0, 56 * n)] - Vector3d(0, 0, 0)).norm() < 1e-15);
    for (int i = 56 * n; i < 88 * n; ++i) {
      const Vector3d& x = b.nodes[b.node(0, 0, i)];
      REQUIRE(x.z() == Approx(naca0012_half_thickness(std::max(x.x(), 0.0))).margin(1e-13));
    }
    for (int i = 25 * n; i < 88 * n; ++i)
      REQUIRE((b.nodes[b.node(0, 1, i)] - b.nodes[b.node(0, 0, i)]).norm() == Approx(7.2e-6 / n).epsilon(0.06));
    if (n < 4) CHECK(family_gap(b, naca0012({.n = 2 * n}).blocks[0]) < 1e-12);
  }
  const Block b = naca0012({.n = 2}).blocks[0];
  const auto length = [&](int i) { return (b.nodes[b.node(0, 0, i + 1)] - b.nodes[b.node(0, 0, i)]).norm(); };
  // The TMR's 225x65: 4.27e-4 at the nose, 0.039 in the middle, 4.3e-3 at the trailing edge, 96 at the outflow.
  CHECK(length(112) == Approx(4.27e-4).epsilon(0.15));
  double longest = 0;
  for (int i = 112; i < 176; ++i) longest = std::max(longest, length(i));
  CHECK(longest == Approx(0.039).epsilon(0.15));
  CHECK(length(175) == Approx(4.3e-3).epsilon(0.2));
  CHECK(length(176) == Approx(length(175)).epsilon(0.15));
  CHECK(length(223) == Approx(96).epsilon(0.1));
  CHECK(b.nodes[b.node(0, 64, 112)].x() == Approx(-500).epsilon(5e-3));
  CHECK(b.nodes[b.node(0, 0, 224)].x() == Approx(501).epsilon(1e-3));
}

namespace {
/// NACA 4-digit section: points from the trailing edge along the upper side, nose, lower side; `open` as printed, else closed.
std::vector<Eigen::Vector2d> naca_4_digit(double camber, double at, double thickness, int points, bool open) {
  std::vector<Eigen::Vector2d> outline;
  for (int n = -points; n <= points; ++n) {
    const double x = 1.0 - std::cos(0.5 * std::numbers::pi * std::abs(n) / points), side = n < 0 ? 1.0 : -1.0;
    const double t =
        5.0 * thickness *
        (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - (open ? 0.1015 : 0.1036) * x * x * x * x);
    const double y = x < at ? camber / (at * at) * (2.0 * at * x - x * x)
                            : camber / ((1.0 - at) * (1.0 - at)) * (1.0 - 2.0 * at + 2.0 * at * x - x * x);
    const double slope = 2.0 * camber / (x < at ? at * at : (1.0 - at) * (1.0 - at)) * (at - x), angle = std::atan(slope);
    outline.emplace_back(x - side * t * std::sin(angle), y + side * t * std::cos(angle));
  }
  return outline;
}
}  // namespace

TEST_CASE("a grid goes round any outline: its nodes lie on it, and NACA 0012 by points is that by its formula",
          "[aero][grid][fast]") {
  for (const bool open : {false, true})
    for (const double camber : {0.0, 0.04, 0.06}) {
      const std::vector<Eigen::Vector2d> outline = naca_4_digit(camber, 0.4, 0.15, 60, open);
      const MultiBlockGrid grid = aerofoil(outline, {.n = 1, .far = 100.0, .first_cell = 1e-4});
      INFO("camber " << camber << (open ? ", open" : "") << "\n" << describe(grid_quality(grid), grid));
      CHECK(grid_faults(grid).empty());
      CHECK(grid_quality(grid).scaled_jacobian.value > 0.8);
      const Block& b = grid.blocks[0];
      const std::vector<Eigen::Vector2d> fine = naca_4_digit(camber, 0.4, 0.15, 4000, false);
      for (int i = 24; i <= 88; ++i) {
        const Vector3d& node = b.nodes[b.node(0, 0, i)];
        double nearest = 1.0;
        for (const Eigen::Vector2d& p : fine) nearest = std::min(nearest, (p - Eigen::Vector2d(node.x(), node.z())).norm());
        REQUIRE(nearest < (open ? 3e-3 : 4e-4));
      }
    }
  std::vector<Eigen::Vector2d> points;
  for (int n = -80; n <= 80; ++n) {
    const double x = 1.0 - std::cos(0.5 * std::numbers::pi * std::abs(n) / 80);
    points.emplace_back(x, (n < 0 ? 1.0 : -1.0) * naca0012_half_thickness(x));
  }
  const Block own = aerofoil(points, {.n = 1}).blocks[0], formula = naca0012({.n = 1}).blocks[0];
  for (int i = 0; i <= own.ni; ++i)
    for (int j : {0, 8, 16}) {
      const Vector3d &a = own.nodes[own.node(0, j, i)], &c = formula.nodes[formula.node(0, j, i)];
      REQUIRE((a - c).norm() < 4e-3 * (1.0 + c.norm()));
    }
  CHECK_THROWS_WITH(aerofoil(naca_4_digit(0.0, 0.4, 0.15, 3, false), {.n = 1}), Catch::Contains("nine points"));
  std::vector<Eigen::Vector2d> blunt = naca_4_digit(0.0, 0.4, 0.15, 20, false);
  blunt.front().y() = 0.05;
  CHECK_THROWS_WITH(aerofoil(blunt, {.n = 1}), Catch::Contains("3 % of the chord"));
}

TEST_CASE("an outline that is turned, or has a flap, keeps its shape: the grid goes with the trailing edge",
          "[aero][grid][fast]") {
  const std::vector<Eigen::Vector2d> level = naca_4_digit(0.02, 0.4, 0.12, 80, GENERATE(false, true));
  const AerofoilOptions options{.n = 1, .far = 100.0, .first_cell = 1e-4};
  const double angle = -5.0 * std::numbers::pi / 180.0;  // nose up
  std::vector<Eigen::Vector2d> turned;
  for (const Eigen::Vector2d& p : level)
    turned.emplace_back(std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y());
  const Block flat = aerofoil(level, options).blocks[0], tilted = aerofoil(turned, options).blocks[0];
  for (std::size_t n = 0; n < flat.nodes.size(); ++n) {
    const Vector3d &a = flat.nodes[n], &b = tilted.nodes[n];
    const Vector3d expected(std::cos(angle) * a.x() - std::sin(angle) * a.z(), a.y(),
                            std::sin(angle) * a.x() + std::cos(angle) * a.z());
    REQUIRE((expected - b).norm() < 1e-9 * (1.0 + a.norm()));
  }
  // A plain flap of 10 degrees from x = 0.75, without the points of the lower side that the hinge folds.
  std::vector<Eigen::Vector2d> flapped;
  const double down = -10.0 * std::numbers::pi / 180.0;
  const auto deflected = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (p.x() < 0.75) return p;
    const double x = p.x() - 0.75;
    return {0.75 + std::cos(down) * x - std::sin(down) * p.y(), std::sin(down) * x + std::cos(down) * p.y()};
  };
  for (const Eigen::Vector2d& p : naca_4_digit(0.0, 0.4, 0.12, 100, false))
    if (p.y() >= 0.0 || p.x() < 0.73 || p.x() > 0.77) flapped.push_back(deflected(p));
  const MultiBlockGrid grid = aerofoil(flapped, options);
  CHECK(grid_faults(grid).empty());
  CHECK(grid_quality(grid).scaled_jacobian.value > 0.8);
  const Block& b = grid.blocks[0];
  const double length = flapped.front().norm();
  CHECK((b.nodes[b.node(0, 0, 24)] * length - Vector3d(flapped.front().x(), 0.0, flapped.front().y())).norm() < 1e-12);
  std::vector<Eigen::Vector2d> fine;
  for (const Eigen::Vector2d& p : naca_4_digit(0.0, 0.4, 0.12, 4000, false)) fine.push_back(deflected(p));
  for (int i = 24; i <= 88; ++i) {
    const Vector3d node = b.nodes[b.node(0, 0, i)] * length;
    if (std::abs(node.x() - 0.75) < 0.03) continue;  // a spline rounds the hinge
    double nearest = 1.0;
    for (const Eigen::Vector2d& p : fine) nearest = std::min(nearest, (p - Eigen::Vector2d(node.x(), node.z())).norm());
    INFO(node.transpose());
    CHECK(nearest < 1e-3);
  }
}

TEST_CASE("sides of an outline part at its nose, however many points each has", "[aero][grid][fast]") {
  const auto outline = [](int above, int below) {
    const auto half = [](double x) { return 0.1 * std::sqrt(x) * (1.0 - x) + 0.0145 * x; };  // 2.9 % thick at its edge
    std::vector<Eigen::Vector2d> points;
    for (int n = above; n > 0; --n) {
      const double x = 0.5 * (1.0 - std::cos(std::numbers::pi * n / above));
      points.emplace_back(x, half(x));
    }
    for (int n = 0; n <= below; ++n) {
      const double x = 0.5 * (1.0 - std::cos(std::numbers::pi * n / below));
      points.emplace_back(x, -half(x));
    }
    return points;
  };
  const Block even = aerofoil(outline(150, 150), {.n = 1}).blocks[0], uneven = aerofoil(outline(300, 30), {.n = 1}).blocks[0];
  double worst = 0.0;
  for (int i = 24; i <= 88; ++i)
    worst = std::max(worst, (even.nodes[even.node(0, 0, i)] - uneven.nodes[uneven.node(0, 0, i)]).norm());
  CHECK(worst < 1e-3);  // the spline of few points; a side taken for the other moves by twice its shift, 2e-3
}

TEST_CASE("bump channel and drawn-out wing are sound", "[aero][grid][fast]") {
  const MultiBlockGrid bump = bump_channel({.n = 1});
  CHECK(grid_faults(bump).empty());
  CHECK(family_gap(bump.blocks[0], bump_channel({.n = 2}).blocks[0]) < 1e-12);
  CHECK(grid_quality(bump).volume == Approx((51.5 * 5 - 0.05 * 0.9 * 3 / 8) * 1.0).epsilon(1e-4));  // sin^4 has the mean 3/8
  const MultiBlockGrid wing = extruded(naca0012({.n = 1}), 4, 1.0, true);
  CHECK(grid_faults(wing).empty());
  CHECK(wing.blocks[0].nk == 4);
  const MultiBlockGrid walled = extruded(bump, 3, 0.5, false, "symmetry");
  CHECK(grid_faults(walled).empty());
  CHECK(walled.boundaries.size() == bump.boundaries.size() + 2);
}

TEST_CASE("a stretched axis has its core of equal cells, grows no faster than asked and ends where it should", "[grid][fast]") {
  const double low = GENERATE(-100.0, -50.0, 0.0), high = GENERATE(60.0, 400.0), growth = GENERATE(1.1, 1.3);
  const std::vector<double> x = stretched_nodes(low, 0.0, 60.0, high, 2.9, growth);
  CAPTURE(low, high, growth, x.size());
  CHECK((x.size() - 1) % 4 == 0);
  CHECK(x.front() == Approx(low).margin(1e-12));
  CHECK(x.back() == high);
  double before = 0.0;
  for (std::size_t n = 0; n + 1 < x.size(); ++n) {
    const double size = x[n + 1] - x[n];
    CHECK(size > 0.0);
    if (x[n] > -1e-9 && x[n + 1] < 60.0 + 1e-9) CHECK(size == Approx(60.0 / std::round(60.0 / size)).epsilon(1e-12));
    if (n > 0) CHECK(std::max(size / before, before / size) < growth * (1.0 + 1e-6));
    before = size;
  }
}
