// The lofted surface: its sections are those of the turbine's tables, it is smooth along the span, closed at the tip, free of
// folds. SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/blade_surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/failure.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

BladeSurface blade(int round = 120, double pitch_deg = 0.0) {
  BladeSettings settings;
  settings.spacing = section_spacing({.round = round, .edge = 4});
  settings.pitch = pitch_deg * radians_per_degree;
  return BladeSurface(dtu(), settings);
}

struct Measured {
  double chord, twist, thickness;
};

/// Of the section on a coaxial surface: from the middle of the trailing edge to the farthest node, and across.
Measured measure(const BladeSurface& b, double r) {
  std::vector<SurfacePoint> p(std::size_t(b.round()));
  b.cut(r, p);
  const Eigen::Vector2d tail(p[0].s, p[0].x);
  Eigen::Vector2d nose = tail;
  for (const SurfacePoint& q : p)
    if ((Eigen::Vector2d(q.s, q.x) - tail).norm() > (nose - tail).norm()) nose = {q.s, q.x};
  const Eigen::Vector2d along = (nose - tail).normalized(), up(-along.y(), along.x());
  double low = 0.0, high = 0.0;
  for (const SurfacePoint& q : p) {
    const double y = (Eigen::Vector2d(q.s, q.x) - tail).dot(up);
    low = std::min(low, y), high = std::max(high, y);
  }
  return {(nose - tail).norm(), std::atan2(-along.y(), along.x()), (high - low) / (nose - tail).norm()};
}

}  // namespace

TEST_CASE("sections of the lofted blade have the chord, twist and thickness of the tables", "[rotor_grid][fast]") {
  const BladeSurface b = blade();
  const Planform& p = dtu().planform;
  for (std::size_t m = 8; m + 6 < p.span.size(); ++m) {
    const double r = std::hypot(p.span[m] * std::cos(dtu().precone), p.sweep[m]) + p.prebend[m] * std::sin(dtu().precone);
    const Measured found = measure(b, r);
    INFO("span " << p.span[m]);
    CHECK(found.chord == Approx(p.chord[m]).epsilon(0.012));
    // The nose and the middle of the edge are not on the chord line; on thick sections the edge hooks down.
    CHECK(found.twist / radians_per_degree == Approx(p.twist[m] / radians_per_degree).margin(p.thickness[m] > 0.45 ? 2.0 : 1.2));
    if (p.thickness[m] < 0.6) CHECK(found.thickness == Approx(p.thickness[m]).margin(0.015));
  }
}

TEST_CASE("the blade ends at the tip radius in a plate a fiftieth of the chord thick", "[rotor_grid][fast]") {
  const BladeSurface b = blade();
  CHECK(b.tip_radius() == Approx(88.935).margin(0.01));  // 89.166 m of span, coned by 2.5 deg, prebent by 3.34 m
  const Measured end = measure(b, b.tip_radius()), before = measure(b, b.tip_radius() - b.closure());
  CHECK(end.chord == Approx(0.8335).epsilon(0.02));
  CHECK(before.thickness == Approx(0.241).margin(0.01));
  std::vector<SurfacePoint> p(120);
  b.cut(b.tip_radius(), p);
  for (int i = 2; i <= 58; ++i) {  // opposite nodes
    const SurfacePoint &low = p[std::size_t(i)], &high = p[std::size_t(120 - i)];
    // The coaxial surface cuts the last millimetres of the closure, the plane of the last section not.
    CHECK(std::hypot(low.s - high.s, low.x - high.x) == Approx(0.02 * 0.8335).epsilon(0.1));
  }
}

TEST_CASE("the surface is smooth along the span: its slopes have no jumps", "[rotor_grid][fast]") {
  const BladeSurface b = blade(40);
  const double step = 0.05;
  std::vector<SurfacePoint> a(40), m(40), c(40);
  double worst = 0.0;
  for (double r = 6.0; r < 84.0; r += 0.1) {
    b.cut(r - step, a), b.cut(r, m), b.cut(r + step, c);
    for (std::size_t i = 0; i < 40; ++i)
      worst = std::max(worst, std::hypot(a[i].s - 2 * m[i].s + c[i].s, a[i].x - 2 * m[i].x + c[i].x) / step);
  }
  CHECK(worst < 0.06);  // change of slope over 5 cm; a kink of 3.4 deg
}

TEST_CASE("pitch turns the section nose into the wind", "[rotor_grid][fast]") {
  const double r = 60.0;
  const double change = measure(blade(120, 20.0), r).twist - measure(blade(120, 0.0), r).twist;
  CHECK(change / radians_per_degree == Approx(20.0).margin(0.3));
}

TEST_CASE("a blade bent back on itself is refused with its span", "[rotor_grid][fast]") {
  Turbine bent = dtu();
  for (std::size_t m = 30; m < bent.planform.span.size(); ++m) bent.planform.prebend[m] = -150.0 * double(m - 29);
  BladeSettings settings;
  settings.spacing = section_spacing({.round = 40, .edge = 2});
  settings.hub_radius = 5.0;
  bent.precone = 0.5;
  CHECK_THROWS_WITH(BladeSurface(bent, settings), Catch::Contains("pass through each other") && Catch::Contains("span"));
}
