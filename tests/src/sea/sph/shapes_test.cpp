// Laws of bodies filled with particles: volume, symmetry, distance from the surface and from each other.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/shapes.hpp"

#include <catch2/catch.hpp>

#include "src/sea/sph/body_shapes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

double nearest(const Points& points) {
  double best = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) best = std::min(best, (points[i] - points[j]).norm());
  return best;
}

}  // namespace

TEST_CASE("particles of a body stand for its volume within a per cent", "[sph][fast]") {
  const double d = 0.1;
  CHECK(points_in_box({1.0, 0.7, 0.4}, d).size() == 280);
  CHECK(points_in_box({1.0, 0.0, 0.4}, d).size() == 40);
  for (double radius : {0.3, 0.5, 0.9, 2.5})
    CHECK(points_in_cylinder(radius, 0.0, 1, d).size() * d * d ==
          Approx(pi * radius * radius).epsilon(radius < 0.4 ? 0.02 : 1e-2));
  CHECK(points_in_cylinder(0.9, 0.5, 2, d).size() * d * d * d == Approx(pi * 0.81 * 0.5).epsilon(5e-3));
  for (double radius : {0.5, 0.9})
    CHECK(points_in_sphere(radius, d).size() * d * d * d == Approx(4.0 / 3.0 * pi * std::pow(radius, 3)).epsilon(5e-3));
}

TEST_CASE("the outermost particles of a body stand about half a spacing inside its surface", "[sph][fast]") {
  const double d = 0.1;
  double far = 0.0, top = 0.0;
  for (const auto& x : points_in_cylinder(0.9, 0.5, 2, d)) far = std::max(far, std::hypot(x[0], x[1])), top = std::max(top, x[2]);
  CHECK(far == Approx(0.85).margin(0.002));
  CHECK(top == Approx(0.2));
  far = 0.0;
  for (const auto& x : points_in_sphere(0.9, d)) far = std::max(far, x.norm());
  CHECK(far == Approx(0.85).margin(0.002));
}

TEST_CASE("particles of a body keep apart and balance about its centre", "[sph][fast]") {
  const double d = 0.1;
  for (const Points& points :
       {points_in_cylinder(0.55, 0.0, 1, d), points_in_sphere(0.5, d), points_in_box({0.5, 0.3, 0.4}, d)}) {
    CHECK(nearest(points) > 0.5 * d);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& x : points) centre += x / double(points.size());
    CHECK(centre.norm() < 0.05 * d);
  }
}

TEST_CASE("half of a symmetrical body is filled to half its volume, as far from its image as from each other", "[sph][fast]") {
  const double d = 0.1;
  using Body = std::vector<BodyShape>;
  const Body body = GENERATE(Body{Sphere{{0.2, 0.0, 0.1}, 0.5}}, Body{Cylinder{{0, 0, -1}, {0, 0, 0.5}, 0.45, 0.45}},
                             Body{Cylinder{{-1, 0, 0}, {0.5, 0, 0.3}, 0.4, 0.3}},
                             Body{Cylinder{{0.1, -0.7, 0}, {0.1, 0.7, 0}, 0.35, 0.35}}, Body{Box{{0.1, 0, 0}, {0.6, 0.5, 0.4}}},
                             Body{Cylinder{{0, 1, -1}, {0, 1, 0.5}, 0.4, 0.4}, Cylinder{{0, -1, -1}, {0, -1, 0.5}, 0.4, 0.4}});
  const Points points = fill_body(body, d, Cut::half);
  double volume = 0.0, across = 1e300;
  for (const BodyShape& shape : body) volume += volume_of(shape, Cut::half);
  CHECK(double(points.size()) * d * d * d == Approx(volume).epsilon(0.01));
  for (const auto& x : points) across = std::min(across, x.y());
  CHECK(2.0 * across > 0.5 * d);
  CHECK(nearest(points) > 0.5 * d);
  double along = 0.0;  // of the whole fill, whose centre is that of both halves
  for (const auto& x : points) along += x.x() / double(points.size());
  double whole = 0.0;
  const Points all = fill_body(body, d, Cut::space);
  for (const auto& x : all) whole += x.x() / double(all.size());
  CHECK(along == Approx(whole).margin(0.1 * d));
}
