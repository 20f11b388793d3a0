// Closed surfaces: what they enclose, distances from them, what of them is under water, and what is wrong with those that are not
// closed. SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/closed_surface.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/kernels/rigid/surfaces.hpp"

using namespace spindrift;
using namespace spindrift::testing;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

ClosedSurface surface_of(const std::vector<Facet>& facets) {
  Triangulation found = weld(facets);
  REQUIRE_FALSE(why_not_closed(found));
  return ClosedSurface(std::move(found));
}
std::string fault(const std::vector<Facet>& facets) { return why_not_closed(weld(facets)).value_or(""); }

double distance_from_box(const Vector3d& x, const Vector3d& size) {
  const Vector3d out = x.cwiseAbs() - 0.5 * size;
  return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
}

}  // namespace

TEST_CASE("the distance from a box of triangles is that from the box, inside and out, at faces, edges and corners",
          "[rigid][fast]") {
  const Vector3d size(2.0, 1.0, 0.6);
  const ClosedSurface box = surface_of(box_facets(size));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-2.0, 2.0);
  for (int n = 0; n < 20000; ++n) {
    const Vector3d x(within(random), within(random), within(random));
    REQUIRE(box.signed_distance(x) == Approx(distance_from_box(x, size)).margin(1e-14));
  }
  for (const Vector3d& x : {Vector3d(1.5, 0.5, 0.3), Vector3d(1.5, 1.0, 0.8), Vector3d(0.2, 0.1, 0.0), Vector3d(1.0, 0.5, 0.3)})
    CHECK(box.signed_distance(x) == Approx(distance_from_box(x, size)).margin(1e-14));
}

TEST_CASE("distances from a ball and a cylinder of triangles are those of the solids, less the height of their facets' arcs",
          "[rigid][fast]") {
  const double radius = 1.0, half = 0.7;
  const int sectors = 64;
  const ClosedSurface ball = surface_of(sphere_facets(radius, sectors / 2, sectors)),
                      cylinder = surface_of(cylinder_facets(radius, -half, half, sectors));
  const double arc = 1.0 - std::pow(std::cos(pi / sectors), 2);  // of two directions
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(-2.0, 2.0);
  for (int n = 0; n < 5000; ++n) {
    const Vector3d x(within(random), within(random), within(random));
    REQUIRE(ball.signed_distance(x) == Approx(x.norm() - radius).margin(arc));
    const double across = x.head<2>().norm() - radius, along = std::abs(x[2]) - half;
    const double exact = std::hypot(std::max(across, 0.0), std::max(along, 0.0)) + std::min(std::max(across, along), 0.0);
    REQUIRE(cylinder.signed_distance(x) == Approx(exact).margin(arc));
  }
}

// The notch makes edges that point inwards, where the nearest face alone has the wrong sign.
TEST_CASE("points in and round a notch are told apart, brute force as the judge", "[rigid][fast]") {
  std::vector<Facet> facets = sphere_facets(1.0, 12, 18);
  for (Facet& f : facets)
    for (Vector3d& x : f)
      if (x[2] > 0.5) x[2] = 1.0 - x[2];  // the cap is pushed in
  const ClosedSurface dented = surface_of(facets);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> within(-1.2, 1.2);
  for (int n = 0; n < 3000; ++n) {
    const Vector3d x(within(random), within(random), within(random));
    double solid_angle = 0.0;  // van Oosterom & Strackee (1983): 4 pi inside, 0 outside
    for (const Facet& f : facets) {
      const Vector3d a = f[0] - x, b = f[1] - x, c = f[2] - x;
      solid_angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                             b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    REQUIRE((dented.signed_distance(x) < 0.0) == (solid_angle > 2.0 * pi));
  }
}

TEST_CASE("volume, centre and inertia are those of the solid, wherever it is and whichever way its facets run", "[rigid][fast]") {
  const Vector3d size(2.0, 1.0, 0.6), at(300.0, -20.0, 5.0);
  std::vector<Facet> facets = box_facets(size);
  for (Facet& f : facets)
    for (Vector3d& x : f) x += at;
  for (const bool inside_out : {false, true}) {
    if (inside_out)
      for (Facet& f : facets) std::swap(f[0], f[1]);
    const ClosedSurface box = surface_of(facets);
    CHECK(box.was_inside_out() == inside_out);
    CHECK(box.volume() == Approx(1.2).epsilon(1e-12));
    CHECK((box.centre() - at).norm() < 1e-9);
    for (int k = 0; k < 3; ++k)
      CHECK(box.inertia()(k, k) == Approx(1.2 / 12.0 * (size.squaredNorm() - size[k] * size[k])).epsilon(1e-9));
    CHECK(box.signed_distance(at) < 0.0);
  }
  CHECK(surface_of(sphere_facets(1.0, 60, 120)).volume() == Approx(4.0 / 3.0 * pi).epsilon(3e-3));
}

TEST_CASE("what of a shape is under water, and its waterplane, are those of naval architecture", "[rigid][fast]") {
  const ClosedSurface box = surface_of(box_facets({2.0, 1.0, 0.6}));
  const Submerged even = submerged(box, Eigen::Matrix3d::Identity(), {50.0, 7.0, 0.1});
  CHECK(even.volume == Approx(2.0 * 0.2));
  CHECK((even.centre - Vector3d(50.0, 7.0, -0.1)).norm() < 1e-12);
  CHECK(even.area == Approx(2.0));
  CHECK((even.area_centre - Eigen::Vector2d(50.0, 7.0)).norm() < 1e-12);
  CHECK(even.metacentric_radius_roll() == Approx(2.0 * 1.0 / 12.0 / 0.4));
  CHECK(even.metacentric_radius_pitch() == Approx(8.0 / 12.0 / 0.4));
  // Heeled about x by 30 degrees round its middle: half of it is under whatever the angle.
  const Eigen::Matrix3d heel = Eigen::AngleAxisd(pi / 6.0, Vector3d::UnitX()).toRotationMatrix();
  const Submerged leaning = submerged(box, heel, Vector3d::Zero());
  CHECK(leaning.volume == Approx(0.6));
  CHECK(leaning.area == Approx(2.0 * 1.0 / std::cos(pi / 6.0)));  // its breadth is cut between the two sides
  const ClosedSurface ball = surface_of(sphere_facets(1.0, 90, 180));
  const Submerged cap = submerged(ball, Eigen::Matrix3d::Identity(), {0.0, 0.0, 0.4});
  CHECK(cap.volume == Approx(pi * 0.36 * (3.0 - 0.6) / 3.0).epsilon(2e-3));
  CHECK(cap.area == Approx(pi * (1.0 - 0.16)).epsilon(2e-3));
  CHECK(submerged(ball, Eigen::Matrix3d::Identity(), {0.0, 0.0, 2.0}).volume == 0.0);
  CHECK(submerged(ball, Eigen::Matrix3d::Identity(), {0.0, 0.0, -2.0}).volume == Approx(ball.volume()));
  CHECK(submerged(ball, Eigen::Matrix3d::Identity(), {0.0, 0.0, -2.0}).area == Approx(0.0).margin(1e-12));
}

TEST_CASE("a 2-D scene has of a surface the outline in its plane: area, centre and distances are those of the outline",
          "[rigid][fast]") {
  const Vector3d size(2.0, 1.0, 0.6);
  const ClosedSurface box = surface_of(box_facets(size));
  for (const double y : {0.0, 0.3, -0.5}) {  // the last one holds a face
    const Outline outline = outline_of(box, y);
    const ClosedSurface prism = prism_of(outline);
    CHECK_FALSE(prism.was_inside_out());
    CHECK(prism.volume() / prism.box().sizes()[1] == Approx(1.2));
    CHECK((prism.centre() - Vector3d(0.0, y, 0.0)).norm() < 1e-9);
    CHECK(prism.inertia()(1, 1) / prism.volume() == Approx((4.0 + 0.36) / 12.0).epsilon(1e-6));
    double around = 0.0;
    for (const auto& [p, q] : outline.segments)
      around += (outline.points[std::size_t(q)] - outline.points[std::size_t(p)]).norm();
    CHECK(around == Approx(2.0 * (2.0 + 0.6)));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> within(-2.0, 2.0);
    for (int n = 0; n < 2000; ++n) {
      const Vector3d x(within(random), 0.0, within(random));
      REQUIRE(prism.signed_distance(x + y * Vector3d::UnitY()) ==
              Approx(distance_from_box(x, {size[0], 1e9, size[2]})).margin(1e-9));
    }
  }
  CHECK(outline_of(box, 0.51).segments.empty());
  CHECK(outline_of(box, 0.5).segments.empty());  // touched only
}

TEST_CASE("an outline of two rings, one in the other, is hollow, also seen from afar", "[rigid][fast]") {
  std::vector<Facet> facets = cylinder_facets(1.0, -0.5, 0.5, 40);
  for (const Facet& f : cylinder_facets(0.5, -0.25, 0.25, 40)) facets.push_back({f[0], f[2], f[1]});
  const ClosedSurface hollow = surface_of(facets);
  const ClosedSurface prism = prism_of(outline_of(hollow, 0.0));  // through corners
  CHECK(prism.volume() / prism.box().sizes()[1] == Approx(2.0 - 0.5).epsilon(0.01));
  CHECK(prism.signed_distance({0.0, 0.0, 0.0}) == Approx(0.25));
  CHECK(prism.signed_distance({0.0, 0.0, 0.4}) == Approx(-0.1));
  for (const double far : {10.0, 300.0, 1000.0}) CHECK(prism.signed_distance({far, 0.0, 0.5 * far}) > 0.9 * far);
}

TEST_CASE("pieces of a surface are small, and their areas add up to nothing", "[rigid][fast]") {
  const ClosedSurface box = surface_of(box_facets({2.0, 1.0, 0.6}));
  Vector3d sum = Vector3d::Zero();
  double area = 0.0;
  for (const SurfacePiece& p : pieces_of(box, 0.1)) {
    sum += p.area, area += p.area.norm();
    CHECK(p.area.norm() <= 0.005);
    CHECK(std::abs(box.signed_distance(p.place)) < 1e-14);
    CHECK(box.signed_distance(p.place + 1e-3 * p.area.normalized()) > 0.0);
  }
  CHECK(sum.norm() < 1e-12);
  CHECK(area == Approx(2.0 * (2.0 + 1.2 + 0.6)));
}

TEST_CASE("surfaces that are not closed are refused with the place", "[rigid][fast]") {
  const std::vector<Facet> whole = box_facets({2.0, 2.0, 2.0});
  CHECK(fault(whole).empty());
  std::vector<Facet> spoilt = whole;
  spoilt.pop_back();
  CHECK_THAT(fault(spoilt), Contains("3 open edges") && Contains("1, 1)") && Contains("at facet"));
  spoilt = whole;
  spoilt.push_back(whole[4]);
  CHECK_THAT(fault(spoilt), Contains("facet 5 once more as facet 13"));
  spoilt = whole;
  std::swap(spoilt[6][0], spoilt[6][1]);
  CHECK_THAT(fault(spoilt), Contains("7") && Contains("turn opposite ways") && Contains("inside out"));
  spoilt = whole;
  for (const Facet& f : whole) {  // another box that shares an edge
    Facet moved = f;
    for (Vector3d& x : moved) x += Vector3d(2.0, 2.0, 0.0);
    spoilt.push_back(moved);
  }
  CHECK_THAT(fault(spoilt), Contains("4 facets share"));
  CHECK_THAT(fault({}), Contains("no triangle"));
  CHECK_THAT(fault({Facet{Vector3d::Zero(), Vector3d::Zero(), Vector3d::UnitX()}}), Contains("no triangle"));
}

TEST_CASE("parts of a surface may touch and be hollow, but not cut through each other, lie in each other or be inside out alone",
          "[rigid][fast]") {
  const auto with = [](std::vector<Facet> facets, const Vector3d& size, const Vector3d& at, bool inside_out = false) {
    for (Facet f : box_facets(size)) {
      for (Vector3d& x : f) x += at;
      if (inside_out) std::swap(f[1], f[2]);
      facets.push_back(f);
    }
    return surface_of(facets);
  };
  const std::vector<Facet> column = cylinder_facets(1.0, -2.0, 2.0, 12);  // facets 1 to 48
  const Vector3d size(3.0, 0.7, 0.4);
  SECTION("beside, against and in each other as hollows") {
    const ClosedSurface ball = surface_of(sphere_facets(1.0, 12, 24));
    CHECK_FALSE(ball.crossing());
    CHECK_FALSE(ball.misplaced_part());
    for (const ClosedSurface& fine : {with(column, size, {4.0, 0.0, 0.0}), with(column, {0.4, 0.3, 0.3}, {0.0, 0.0, 0.2}, true),
                                      with(box_facets({2.0, 2.0, 2.0}), {2.0, 1.0, 1.0}, {2.0, 0.0, 0.0})}) {
      CHECK_FALSE(fine.crossing());
      CHECK_FALSE(fine.misplaced_part());
    }
  }
  SECTION("through each other") {
    const ClosedSurface through = with(column, size, {0.5, 0.1, 0.03});
    const auto crossing = through.crossing();
    REQUIRE(crossing);
    CHECK(std::min(through.facet(crossing->first), through.facet(crossing->second)) <= 48);
    CHECK(std::max(through.facet(crossing->first), through.facet(crossing->second)) > 48);
    CHECK(std::abs(crossing->place[1] - 0.1) <= 0.3501);
    CHECK(std::abs(crossing->place[2] - 0.03) <= 0.2001);
    CHECK_FALSE(through.misplaced_part());
  }
  SECTION("solid in solid") {
    const auto part = with(column, {0.4, 0.3, 0.3}, {0.0, 0.0, 0.2}).misplaced_part();
    REQUIRE(part);
    CHECK(part->inside);
    CHECK(part->triangle == 48);
  }
  SECTION("inside out beside another") {
    const auto part = with(column, size, {4.0, 0.0, 0.0}, true).misplaced_part();
    REQUIRE(part);
    CHECK_FALSE(part->inside);
    CHECK(part->triangle == 48);
  }
}

TEST_CASE("corners that a file rounds apart are one point, those of small facets are not", "[rigid][fast]") {
  std::vector<Facet> facets = sphere_facets(1.0, 30, 60);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> rounding(-2e-7, 2e-7);
  for (Facet& f : facets)
    for (Vector3d& x : f)
      for (double& c : x) c += rounding(random);
  const Triangulation welded = weld(facets);
  CHECK(welded.points.size() == 29 * 60 + 2);
  CHECK_FALSE(why_not_closed(welded));
}
