// Nodes on outlines: the edge where it belongs, nodes on the curve, spacing kept, self-crossing found.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/aerofoil.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using Eigen::Vector2d;

namespace {

/// An ellipse of chord 1 cut off at x = `end`, from the lower end of the edge round the nose to the upper.
struct Outline {
  Outline(double thickness, double end, int n) : store(6, std::vector<double>(std::size_t(2 * n + 1))) {
    const double last = std::acos(1.0 - 2.0 * end);
    for (int m = -n; m <= n; ++m) {
      const double a = last * m / n;
      store[1][std::size_t(m + n)] = 0.5 * (1.0 - std::cos(a)), store[2][std::size_t(m + n)] = 0.5 * thickness * std::sin(a);
    }
    curve = {store[0], store[1], store[2], store[3], store[4], store[5]};
    make_curve(curve);
  }
  std::vector<std::vector<double>> store;
  PlaneCurve curve;
};

double off_ellipse(const Vector2d& p, double thickness) { return std::hypot(2.0 * p.x() - 1.0, 2.0 * p.y() / thickness) - 1.0; }

}  // namespace

TEST_CASE("nodes on a blunt outline lie on it, symmetric, with the edge and the nose where they belong", "[grid][fast]") {
  const auto round = GENERATE(40, 120, 166);
  const SectionSpacing spacing{.round = round, .edge = 4, .leading_edge = 0.48 / round, .trailing_edge = 0.72 / round};
  const Outline o(0.24, 0.97, 60);
  std::vector<Vector2d> nodes(static_cast<std::size_t>(round));
  resample(o.curve, spacing, 0.0, nodes);
  CHECK((nodes[0] - 0.5 * (o.curve(0.0) + o.curve(o.curve.total()))).norm() < 1e-14);
  CHECK((nodes[2] - o.curve(0.0)).norm() < 1e-14);
  CHECK(nodes[std::size_t(round / 2)].norm() < 1e-4);
  CHECK(signed_area(nodes) < 0.0);  // clockwise in (chordwise, up): counter-clockwise on a blade, whose s runs forward
  for (int i = 3; i < round / 2; ++i) {
    CHECK(std::abs(off_ellipse(nodes[std::size_t(i)], 0.24)) < 2e-5);
    CHECK((nodes[std::size_t(i)] - Vector2d(nodes[std::size_t(round - i)].x(), -nodes[std::size_t(round - i)].y())).norm() <
          1e-7);
  }
  const double nose = (nodes[std::size_t(round / 2 + 1)] - nodes[std::size_t(round / 2)]).norm();
  CHECK(nose == Approx(spacing.leading_edge).epsilon(0.2));
}

TEST_CASE("a rounded trailing edge is half a circle that meets the outline", "[grid][fast]") {
  const Outline o(0.24, 0.97, 60);
  const SectionSpacing spacing{.round = 80, .edge = 8, .round_off = true};
  std::vector<Vector2d> nodes(80);
  resample(o.curve, spacing, 0.0, nodes);
  const Vector2d middle = 0.5 * (o.curve(0.0) + o.curve(o.curve.total()));
  const double radius = 0.5 * (o.curve(o.curve.total()) - o.curve(0.0)).norm();
  for (const int i : {0, 1, 2, 3, 4, 76, 77, 78, 79})
    CHECK((nodes[std::size_t(i)] - middle).norm() == Approx(radius).epsilon(1e-12));
  CHECK(nodes[0].x() > middle.x());
}

TEST_CASE("nodes slide along a closed outline and stay on it", "[grid][fast]") {
  Outline o(1.0, 1.0, 200);
  const SectionSpacing spacing{.round = 80, .edge = 2};
  std::vector<Vector2d> nodes(80), slid(80);
  resample(o.curve, spacing, 0.0, nodes);
  resample(o.curve, spacing, 0.04, slid);
  for (std::size_t i = 0; i < 80; ++i) {
    CHECK(std::abs(off_ellipse(slid[i], 1.0)) < 1e-6);
    const double turned = std::atan2(slid[i].y(), slid[i].x() - 0.5) - std::atan2(nodes[i].y(), nodes[i].x() - 0.5);
    CHECK(std::remainder(turned + 0.04 * 2.0 * pi, 2.0 * pi) == Approx(0.0).margin(1e-3));
  }
}

TEST_CASE("an outline's thickness is measured, its crossing found", "[grid][fast]") {
  const std::vector<Vector2d> square{{0, 0}, {1, 0}, {1, 0.3}, {0, 0.3}};
  CHECK(outline_thickness(square) == Approx(0.3));
  CHECK(signed_area(square) == Approx(0.3));
  CHECK(first_crossing(square).first == -1);
  const std::vector<Vector2d> bow{{0, 0}, {1, 0.3}, {1, 0}, {0, 0.3}};
  const SegmentPair crossing = first_crossing(bow);
  CHECK(crossing.first == 0);
  CHECK(crossing.second == 2);
}
