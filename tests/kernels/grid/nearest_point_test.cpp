// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/nearest_point.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <random>

using namespace spindrift;
using Eigen::Vector3d;

TEST_CASE("no point of a triangle is nearer than the nearest point", "[grid][fast]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&] { return Vector3d(u(random), u(random), u(random)); };
  for (int n = 0; n < 300; ++n) {
    const Vector3d a = point(), b = point(), c = point(), p = 2 * point();
    const Vector3d x = nearest_on_triangle(p, a, b, c);
    double sampled = std::numeric_limits<double>::infinity(), gap = sampled;
    constexpr int m = 60;
    for (int i = 0; i <= m; ++i)
      for (int j = 0; i + j <= m; ++j) {
        const Vector3d y = a + double(i) / m * (b - a) + double(j) / m * (c - a);
        sampled = std::min(sampled, (y - p).norm());
        gap = std::min(gap, (y - x).norm());
      }
    CHECK((x - p).norm() <= sampled + 1e-14);
    CHECK(gap < 3.0 / m);  // and it is a point of the triangle
  }
}

TEST_CASE("a point a millionth above a triangle keeps its distance to seven digits", "[grid][fast]") {
  const Vector3d a(80, 3, 1), b(81, 3.5, 1.2), c(80.2, 4, 0.9);
  const Vector3d n = (b - a).cross(c - a).normalized();
  const Vector3d p = (a + b + c) / 3 + 1e-6 * n;
  CHECK((nearest_on_triangle(p, a, b, c) - p).norm() == Approx(1e-6).epsilon(1e-7));  // positions at 80 m are rounded to 1e-14
}

TEST_CASE("triangles without area are segments and points", "[grid][fast]") {
  const Vector3d a(0, 0, 0), b(1, 0, 0), p(0.25, 1, 0);
  CHECK((nearest_on_triangle(p, a, b, a) - Vector3d(0.25, 0, 0)).norm() < 1e-15);
  CHECK((nearest_on_triangle(p, b, b, b) - b).norm() == 0.0);
  CHECK((nearest_on_triangle(p, a, Vector3d(0.5, 0, 0), b) - Vector3d(0.25, 0, 0)).norm() < 1e-15);
}
