// Laws of kernels/waves/wetted_cylinder.hpp and wetted_frustum.hpp, against brute-force quadrature and against energy.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/wetted.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/base/random.hpp"
#include "kernels/waves/wetted_cylinder.hpp"
#include "kernels/waves/wetted_frustum.hpp"

using namespace spindrift;
using namespace spindrift::waves;
using Eigen::Vector3d;

namespace {

/// Gauss-Legendre nodes of n points on [-1, 1] by Newton on the Legendre polynomial.
struct Rule {
  std::vector<double> point, weight;
  explicit Rule(int n) {
    for (int i = 1; i <= n; ++i) {
      double x = std::cos(pi * (i - 0.25) / (n + 0.5)), slope = 0.0;
      for (int k = 0; k < 100; ++k) {
        double p = 1.0, before = 0.0;
        for (int j = 1; j <= n; ++j) {
          const double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
          before = p, p = next;
        }
        slope = n * (x * p - before) / (x * x - 1.0);
        x -= p / slope;
      }
      point.push_back(x);
      weight.push_back(2.0 / ((1.0 - x * x) * slope * slope));
    }
  }
};

/// Wetted part by quadrature over cross-sections: each slice is a circular segment, the pieces between slices that change kind
/// are integrated with t = sin^2 u substitution so that the square roots at their ends do no harm.
Wetted by_slices(const Vector3d& start, const Vector3d& end, double r0, double r1, const WaterPlane& surface) {
  static const Rule rule(60);
  const Vector3d axis = (end - start).normalized();
  const double length = (end - start).norm(), rise = surface.normal.dot(axis);
  const Vector3d across = surface.normal - rise * axis;
  const double lean = across.norm(), h0 = surface.height(start), h1 = surface.height(end);
  std::vector<double> cuts = {0.0, 1.0};
  for (const double side : {-1.0, 1.0}) {
    const double a = h0 + side * lean * r0, b = h1 + side * lean * r1;
    if (a * b < 0.0) cuts.push_back(a / (a - b));
  }
  std::sort(cuts.begin(), cuts.end());
  Wetted sum;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    for (std::size_t i = 0; i < rule.point.size(); ++i) {
      const double u = 0.25 * pi * (rule.point[i] + 1.0), s = std::sin(u);
      const double f = cuts[c] + (cuts[c + 1] - cuts[c]) * s * s;
      const double df = (cuts[c + 1] - cuts[c]) * 2.0 * s * std::cos(u) * 0.25 * pi * rule.weight[i];
      const double r = r0 + f * (r1 - r0), h = h0 + f * (h1 - h0);
      double area = 0.0, first = 0.0;  // of the part of the disc with lean x < -h
      if (h <= -lean * r)
        area = pi * r * r;
      else if (h < lean * r) {
        const double d = std::clamp(-h / lean, -r, r), half = std::sqrt(std::max(0.0, r * r - d * d));
        area = r * r * std::acos(-d / r) + d * half;
        first = -2.0 / 3.0 * half * half * half;
      }
      const double dv = area * length * df;
      sum.volume += dv;
      sum.first_moment += dv * (start + f * (end - start));
      if (lean > 0.0) sum.first_moment += first * length * df / lean * across;
    }
  }
  return sum;
}

struct Attitude {
  Vector3d start, end;
  double r0, r1;
  WaterPlane surface;
};

/// A random cylinder or frustum in a random plane; every fourth nearly upright, every fourth nearly lying, some exactly so.
Attitude random_attitude(Random& random, bool tapered) {
  const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  const double length = std::pow(10.0, between(-0.5, 1.5)), radius = std::pow(10.0, between(-0.5, 0.7));
  double tilt = std::acos(between(-1.0, 1.0));
  const int kind = int(8.0 * random.uniform());
  if (kind == 0) tilt = std::pow(10.0, between(-12.0, -1.0));
  if (kind == 1) tilt = pi / 2 + std::pow(10.0, between(-14.0, -1.0));
  if (kind == 2) tilt = random.uniform() < 0.5 ? 0.0 : pi;
  const double yaw = between(0.0, 2.0 * pi);
  Vector3d axis(std::sin(tilt) * std::cos(yaw), std::sin(tilt) * std::sin(yaw), std::cos(tilt));
  if (kind == 3) axis = Vector3d::UnitX();
  const double r1 = tapered ? radius * between(0.0, 2.0) : radius;
  const double reach = 0.5 * length * std::abs(axis.z()) + std::max(radius, r1) * std::hypot(axis.x(), axis.y());
  const Vector3d middle(between(-3, 3), between(-3, 3), 1.05 * reach * between(-1.0, 1.0));
  WaterPlane surface;
  if (random.uniform() < 0.5) {
    surface = tangent_plane(between(-5, 5), between(-5, 5), between(-1, 1), between(-0.5, 0.5), between(-0.5, 0.5));
  }
  return {middle - 0.5 * length * axis, middle + 0.5 * length * axis, radius, r1, surface};
}

Wetted cylinder(const Attitude& a) { return wetted_cylinder(a.start, a.end, a.r0, a.surface); }
Wetted frustum(const Attitude& a) { return wetted_frustum(a.start, a.end, a.r0, a.r1, a.surface); }
Wetted slices(const Attitude& a) { return by_slices(a.start, a.end, a.r0, a.r1, a.surface); }
double full_volume(const Attitude& a) { return pi / 3.0 * (a.end - a.start).norm() * (a.r0 * a.r0 + a.r0 * a.r1 + a.r1 * a.r1); }

/// Largest error of volume and first moment in units of the whole solid's.
double error(const Attitude& a, const Wetted& is, const Wetted& should) {
  const double volume = full_volume(a),
               size = std::max((a.end - a.start).norm(), std::max(a.r0, a.r1)) + a.start.norm() + a.end.norm();
  return std::max(std::abs(is.volume - should.volume) / volume, (is.first_moment - should.first_moment).norm() / (volume * size));
}

}  // namespace

TEST_CASE("the wetted part of a cylinder agrees with brute-force quadrature at any draft and attitude", "[waves][fast]") {
  Random random(1);
  double worst = 0.0;
  int cut = 0;
  for (int i = 0; i < 8000; ++i) {
    const Attitude a = random_attitude(random, false);
    const Wetted w = cylinder(a);
    worst = std::max(worst, error(a, w, slices(a)));
    cut += w.volume > 0.0 && w.volume < 0.999 * full_volume(a);
  }
  CHECK(cut > 4000);
  CHECK(worst < 1e-10);
}

TEST_CASE("the wetted part of a frustum agrees with brute-force quadrature at any draft and attitude", "[waves][fast]") {
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Attitude a = random_attitude(random, true);
    worst = std::max(worst, error(a, frustum(a), slices(a)));
  }
  CHECK(worst < 1e-10);
  worst = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Attitude a = random_attitude(random, false);
    worst = std::max(worst, error(a, frustum(a), cylinder(a)));
  }
  CHECK(worst < 1e-10);
}

TEST_CASE("wet and dry parts add to the whole, and turning the cylinder end for end changes nothing", "[waves][fast]") {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    Attitude a = random_attitude(random, false), under = a, turned = a;
    under.surface = {-a.surface.normal, -a.surface.offset};
    std::swap(turned.start, turned.end);
    const Wetted wet = cylinder(a), dry = cylinder(under);
    Wetted sum = wet;
    sum.volume += dry.volume;
    sum.first_moment += dry.first_moment;
    const double v = full_volume(a);
    REQUIRE(error(a, sum, {v, v * 0.5 * (a.start + a.end)}) < 1e-13);
    REQUIRE(error(a, cylinder(turned), wet) < 1e-13);
  }
}

TEST_CASE("volume and centre are continuous where the kind of cut changes", "[waves][fast]") {
  // A full turn of a half-drowned cylinder passes every kind; across a step of 1e-9 rad nothing may move by more than that.
  const double length = 3.0, radius = 1.0, step = 1e-9;
  for (const double depth : {-1.4, -0.9, -0.3, 0.0, 0.2, 1.0, 1.49}) {
    const auto at = [&](double tilt) {
      const Vector3d axis(std::sin(tilt), 0.0, std::cos(tilt)), middle(0, 0, depth);
      return wetted_cylinder(middle - 0.5 * length * axis, middle + 0.5 * length * axis, radius, {});
    };
    const double edge = std::atan2(2.0 * radius, length);
    std::vector<double> angles = {0.0, pi / 2, pi, edge, pi - edge};
    for (double top : {-1.0, 1.0})  // a rim point touches the surface
      for (double side : {-1.0, 1.0}) {
        const double c = -depth / std::hypot(0.5 * length, radius);
        if (std::abs(c) <= 1.0) angles.push_back(std::acos(c) * top + std::atan2(radius, 0.5 * length) * side);
      }
    for (double angle : angles) {
      const Wetted a = at(angle - step), b = at(angle), c = at(angle + step);
      CHECK(std::abs(a.volume - b.volume) < 20.0 * step);
      CHECK(std::abs(c.volume - b.volume) < 20.0 * step);
      CHECK((a.first_moment - b.first_moment).norm() < 30.0 * step);
      CHECK((c.first_moment - b.first_moment).norm() < 30.0 * step);
    }
  }
}

TEST_CASE("buoyancy is the gradient of the potential energy of the displaced water", "[waves][fast]") {
  // U = -int z dV over the wetted part; dU/dz = -V and dU/d(rotation) = -(first moment x z), for force and moment in units of rho
  // g.
  Random random(4);
  const auto energy = [](const Attitude& a) { return -(a.r0 == a.r1 ? cylinder(a) : frustum(a)).first_moment.z(); };
  for (int i = 0; i < 400; ++i) {
    Attitude a = random_attitude(random, i % 2 == 1);
    a.surface = {};
    const Wetted w = a.r0 == a.r1 ? cylinder(a) : frustum(a);
    const double length = (a.end - a.start).norm(), d = 1e-5, scale = full_volume(a) * (length + a.r0);
    const auto moved = [&](double rise, const Vector3d& turn) {
      const Eigen::AngleAxisd q(turn.norm(), turn.norm() > 0.0 ? Vector3d(turn.normalized()) : Vector3d::UnitX());
      Attitude b = a;
      b.start = q * a.start + Vector3d(0, 0, rise);
      b.end = q * a.end + Vector3d(0, 0, rise);
      return energy(b);
    };
    const Vector3d moment = w.first_moment.cross(Vector3d::UnitZ());
    REQUIRE(-(moved(d, Vector3d::Zero()) - moved(-d, Vector3d::Zero())) / (2 * d) == Approx(w.volume).margin(2e-5 * scale));
    for (int k = 0; k < 3; ++k) {
      const Vector3d turn = d * Vector3d::Unit(k);
      REQUIRE(-(moved(0.0, turn) - moved(0.0, -turn)) / (2 * d) == Approx(moment[k]).margin(2e-4 * scale));
    }
  }
}

TEST_CASE("an upright cylinder has the metacentric height of the textbook and lies down when that is negative", "[waves][fast]") {
  const double radius = 2.0, draft = 3.0, freeboard = 2.0;
  const auto righting_arm = [&](double heel, double gravity_centre) {  // centre of gravity on the axis, above the keel
    const Vector3d axis(std::sin(heel), 0, std::cos(heel)), keel = -draft * axis;
    const Wetted w = wetted_cylinder(keel, keel + (draft + freeboard) * axis, radius, {});
    const Vector3d g = keel + gravity_centre * axis;
    return w.first_moment.x() / w.volume - g.x();  // positive: turns back
  };
  const double metacentre = draft / 2 + radius * radius / (4 * draft);  // KB + I/V
  const double heel = 1e-6;
  CHECK(righting_arm(heel, 1.0) / heel == Approx(metacentre - 1.0).epsilon(1e-8));
  CHECK(righting_arm(heel, metacentre + 0.01) / heel == Approx(-0.01).epsilon(1e-4));
  // Wall-sided formula (Scribanti): GZ = sin(heel) (GM + BM tan^2(heel) / 2), exact until an end is cut.
  const double big = 0.6, bm = radius * radius / (4 * draft);
  CHECK(righting_arm(big, 1.0) ==
        Approx(std::sin(big) * (metacentre - 1.0 + 0.5 * bm * std::pow(std::tan(big), 2))).epsilon(1e-12));
}

TEST_CASE("a full cone and a drowned or dry solid have their textbook volumes", "[waves][fast]") {
  const Wetted cone = wetted_frustum({0, 0, -3}, {0, 0, 0}, 0.0, 1.5, {});  // apex down, just drowned
  CHECK(cone.volume == Approx(pi * 2.25));
  CHECK(cone.first_moment.z() / cone.volume == Approx(-0.75));
  const Wetted part = wetted_frustum({0, 0, -1}, {0, 0, 2}, 0.0, 1.5, {});  // apex one metre down
  CHECK(part.volume == Approx(pi * 0.25 / 3.0));
  CHECK(wetted_cylinder({0, 0, 0}, {0, 0, 2}, 1.0, {}).volume == 0.0);
  CHECK(wetted_cylinder({0, 0, 1}, {4, 0, 1}, 1.0, {}).volume == Approx(0.0).margin(1e-15));
  CHECK(wetted_cylinder({0, 0, 0}, {4, 0, 0}, 1.0, {}).volume == Approx(2.0 * pi));
}
