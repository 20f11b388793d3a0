// Rays: lengths of a Bezier curve, thin first steps, normals of polygons.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/ray.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace spindrift;
using Eigen::Vector2d;

TEST_CASE("a straight ray is walked by its length although it speeds up", "[grid][fast]") {
  const Ray ray({Vector2d(0, 0), Vector2d(0.25, 0), Vector2d(35, 0), Vector2d(50, 0)});
  CHECK(ray.length() == Approx(50.0).epsilon(1e-13));
  for (const double s : {1e-7, 1e-5, 1e-3, 0.1, 7.0, 49.0}) CHECK(ray.at_length(s).x() == Approx(s).epsilon(0.15));
  CHECK(ray.at_length(1e-7).x() == Approx(1e-7).epsilon(1e-3));
}

TEST_CASE("a quarter circle's Bezier curve has its length and its steps are equal", "[grid][fast]") {
  const double k = 0.5522847498;
  const Ray ray({Vector2d(1, 0), Vector2d(1, k), Vector2d(k, 1), Vector2d(0, 1)});
  CHECK(ray.length() == Approx(0.5 * pi).epsilon(3e-4));
  for (int m = 0; m <= 10; ++m) {
    const Vector2d p = ray.at_length(ray.length() * m / 10.0);
    CHECK(std::atan2(p.y(), p.x()) == Approx(0.05 * pi * m).margin(3e-4));
  }
}

TEST_CASE("normals of a circle stay under smoothing, a square's corners turn", "[grid][fast]") {
  std::vector<Vector2d> circle, square;
  for (int i = 0; i < 40; ++i) circle.emplace_back(std::cos(2 * pi * i / 40), std::sin(2 * pi * i / 40));
  std::vector<double> angle(40), work(40);
  smoothed_normals(circle, 9, angle, work);
  for (int i = 0; i < 40; ++i)
    CHECK(std::remainder(angle[std::size_t(i)] - 2 * pi * i / 40, 2 * pi) == Approx(0.0).margin(1e-12));
  for (int i = 0; i < 10; ++i) square.emplace_back(i / 10.0, 0.0);
  for (int i = 0; i < 10; ++i) square.emplace_back(1.0, i / 10.0);
  for (int i = 0; i < 10; ++i) square.emplace_back(1.0 - i / 10.0, 1.0);
  for (int i = 0; i < 10; ++i) square.emplace_back(0.0, 1.0 - i / 10.0);
  smoothed_normals(square, 2, angle, work);
  CHECK(angle[10] == Approx(-0.25 * pi));  // the corner (1, 0)
  CHECK(angle[5] == Approx(-0.5 * pi));    // the middle of the lower side
}
