// Vortex segments against closed solutions: lines, rings, cores, the cylinder beyond a wake.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/vortex_filament.hpp"

#include <catch2/catch.hpp>

#include "tests/order.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

Vector3d velocity(const VortexFilaments& filaments, const Vector3d& at) {
  Vector3d v = Vector3d::Zero();
  filaments.add_velocities(std::span(&at, 1), std::span(&v, 1));
  return v;
}

void add_ring(VortexFilaments& all, double x, double radius, int segments, double circulation, double core = 0.0) {
  const auto at = [&](int i) {
    const double angle = 2.0 * pi * i / segments;
    return Vector3d(x, radius * std::cos(angle), radius * std::sin(angle));
  };
  all.begin(at(0));
  for (int i = 1; i <= segments; ++i) all.extend(at(i), circulation, core);
}

}  // namespace

TEST_CASE("a straight vortex has the velocity of its closed solution, a half-infinite one half of a line's", "[rotor][fast]") {
  VortexFilaments segment, half_line;
  segment.begin({0, 0, -1}), segment.extend({0, 0, 3}, 5.0, 0.0);
  const Vector3d v = velocity(segment, {2, 0, 0});  // Gamma / (4 pi h) (cos a - cos b), about the segment by the right hand
  CHECK(v.y() == Approx(5.0 / (8.0 * pi) * (1.0 / std::sqrt(5.0) + 3.0 / std::sqrt(13.0))).epsilon(1e-13));
  CHECK(std::hypot(v.x(), v.z()) < 1e-15);
  half_line.begin({0, 0, 0}), half_line.extend({0, 0, 1e7}, 5.0, 0.0);
  CHECK(velocity(half_line, {0.7, 0, 0}).y() == Approx(5.0 / (4.0 * pi * 0.7)).epsilon(1e-7));
  for (const Vector3d& on : {Vector3d(0, 0, -1), Vector3d(0, 0, 1), Vector3d(0, 0, 7)})
    CHECK(velocity(segment, on) == Vector3d::Zero());
}

TEST_CASE("a ring of segments has the exact velocity of its polygon, and tends to a circle's at second order", "[rotor][fast]") {
  std::vector<double> h, error;
  for (int n : {8, 16, 32}) {
    VortexFilaments ring;
    add_ring(ring, 0.0, 2.0, n, 3.0);
    CHECK(velocity(ring, Vector3d::Zero()).x() == Approx(n * 3.0 * std::tan(pi / n) / (4.0 * pi)).epsilon(1e-13));
    const double exact = 3.0 * 4.0 / (2.0 * std::pow(4.0 + 1.0, 1.5));  // on the axis, 1 m away
    h.push_back(1.0 / n), error.push_back(std::abs(velocity(ring, {1, 0, 0}).x() - exact));
  }
  CHECK(observed_order(h, error) == Approx(2.0).margin(0.1));
}

TEST_CASE("a ring of segments carries itself with the speed of a circle with its core, however short they are", "[rotor][fast]") {
  const double radius = 2.0, circulation = 3.0;
  for (const double core : {0.02, 0.1})
    for (const int n : {12, 24, 48, 96, 192}) {
      VortexFilaments ring;
      add_ring(ring, 0.0, radius, n, circulation, core);
      std::vector<Vector3d> ends;
      const auto at = [&](int i) {
        const double angle = 2.0 * pi * i / n;
        return Vector3d(0.0, radius * std::cos(angle), radius * std::sin(angle));
      };
      CHECK(Bend::through(at(-1), at(0), at(1)).radius == Approx(radius));
      const int half = n / 2;
      for (int i = -half; i <= half; ++i) ends.push_back(at(i));
      const std::vector<double> strengths(std::size_t(2 * half), circulation), cores(std::size_t(2 * half), core);
      const Vector3d v = velocity(ring, at(0)) + self_induction({ends, strengths, cores}, std::size_t(half));
      const double exact = circulation / (4.0 * pi * radius) * (std::log(8.0 * radius / core) - 0.5);
      CAPTURE(core, n, v.transpose(), exact);
      CHECK(v.x() == Approx(exact).epsilon(0.02));
      CHECK(std::hypot(v.y(), v.z()) < 1e-12);
      CHECK(velocity(ring, at(0)).x() < 0.8 * exact);  // the segments alone
    }
  const std::vector<Vector3d> line{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  CHECK(self_induction({line, std::vector{1.0, 1.0}, std::vector{0.1, 0.1}}, 1) == Vector3d::Zero());
}

TEST_CASE("the core is that of Vatistas, and grows by the published law", "[rotor][fast]") {
  VortexFilaments line;
  line.begin({0, 0, -1e5}), line.extend({0, 0, 1e5}, 7.0, 0.5);
  for (double r : {0.01, 0.3, 0.5, 2.0})
    CHECK(velocity(line, {r, 0, 0}).y() == Approx(7.0 / (2.0 * pi) * r / std::sqrt(r * r * r * r + 0.0625)).epsilon(1e-8));
  // r_c^2 = r_0^2 + 4 alpha (nu + a_1 Gamma) t, Bhagwat & Leishman (2002).
  CHECK(core_radius(0.5, 10.0, 50.0, 1.5e-5) == Approx(std::sqrt(0.25 + 4.0 * 1.25643 * (1.5e-5 + 2e-4 * 50.0) * 10.0)));
}

TEST_CASE("a point has the same bits of velocity whatever points stand beside it", "[rotor][fast]") {
  VortexFilaments ring;
  add_ring(ring, 0.3, 2.0, 13, 3.0);
  std::vector<Vector3d> points, velocities;
  for (int i = 0; i < 11; ++i) points.push_back({0.1 * i, 1.0 - 0.3 * i, 0.7}), velocities.push_back(Vector3d::Zero());
  ring.add_velocities(points, velocities);
  for (std::size_t i = 0; i < points.size(); ++i) CHECK(velocity(ring, points[i]) == velocities[i]);
}

TEST_CASE("the tail of a wake stands for rings that go on without end", "[rotor][fast]") {
  VortexFilaments rings;
  const double spacing = 0.05, circulation = -0.4;
  for (int i = 0; i < 8000; ++i) add_ring(rings, 10.0 + (i + 0.5) * spacing, 2.0, 40, circulation);
  const double area = 0.5 * 40 * 4.0 * std::sin(2.0 * pi / 40);
  const VortexTail tail{{10, 0, 0}, 2.0, circulation / spacing * area};
  for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(0, 2, 0), Vector3d(5, 0, 1)}) {
    INFO(at.transpose());
    CHECK((tail.velocity(at) - velocity(rings, at)).norm() < 0.03 * velocity(rings, at).norm());
  }
}
