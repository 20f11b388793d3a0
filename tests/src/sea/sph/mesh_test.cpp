// Bodies and walls whose surfaces are made of triangles: their particles stand for the volume, evenly and half a spacing under
// the surface; a beach from a surface is the beach from a bed's rows. SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/mesh_fill.hpp"

#include <catch2/catch.hpp>

#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/body_shapes.hpp"
#include "src/sea/sph/tank.hpp"
#include "src/sea/sph/tank_count.hpp"
#include "tests/kernels/rigid/surfaces.hpp"

using namespace spindrift;
using namespace spindrift::sph;
using namespace spindrift::testing;
using Eigen::Vector3d;

namespace {

std::shared_ptr<const ClosedSurface> surface_of(const std::vector<Facet>& facets) {
  Triangulation found = weld(facets);
  REQUIRE_FALSE(why_not_closed(found));
  return std::make_shared<const ClosedSurface>(std::move(found));
}

}  // namespace

TEST_CASE("particles of a mesh stand for its volume, evenly, the outermost half a spacing inside", "[sph][fast]") {
  const double d = 0.1;
  const std::pair<const char*, std::vector<Facet>> shapes[] = {{"box", box_facets({1.0, 0.8, 0.6})},
                                                               {"box off the lattice", box_facets({1.07, 0.83, 0.66})},
                                                               {"cylinder", cylinder_facets(0.5, -0.5, 0.5, 48)},
                                                               {"sphere", sphere_facets(0.55, 24, 48)}};
  for (const auto& [name, facets] : shapes) {
    const Mesh mesh{.surface = surface_of(facets), .origin = {0.0, 0.0, 0.0}};
    const Points points = fill_mesh<3>(mesh, d);
    CHECK(std::abs(double(points.size()) * d * d * d - mesh.volume()) <= 0.5 * d * d * d);
    double nearest = 1e300, least_depth = 1e300, depth_of_outer = 0.0;
    int outer = 0;
    Vector3d centre = Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double depth = -mesh.surface->signed_distance(points[i]);
      least_depth = std::min(least_depth, depth), centre += points[i] / double(points.size());
      if (depth < d) depth_of_outer += depth, ++outer;
      for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (points[i] - points[j]).norm());
    }
    depth_of_outer /= outer;
    INFO(name << ": nearest " << nearest / d << ", least depth " << least_depth / d << ", of the outermost layer "
              << depth_of_outer / d << ", centre off by " << centre.norm() / d << " spacings");
    CHECK(nearest > 0.6 * d);
    CHECK(least_depth > 0.24 * d);
    CHECK(depth_of_outer == Approx(0.5 * d).margin(0.1 * d));
    CHECK(centre.norm() < 0.05 * d);
  }
}

TEST_CASE("particles of a mesh in the plane stand for its outline's area, evenly, the outermost half a spacing inside",
          "[sph][fast]") {
  const double d = 0.1;
  std::vector<Facet> lying = cylinder_facets(0.5, -0.4, 0.4, 64);
  for (Facet& f : lying)
    for (Vector3d& x : f) x = Vector3d(x[0], x[2], -x[1]);
  for (const auto& [facets, area] : {std::pair(box_facets({1.07, 0.8, 0.63}), 1.07 * 0.63), std::pair(lying, pi * 0.25)}) {
    const Mesh mesh{.surface = std::make_shared<const ClosedSurface>(prism_of(outline_of(*surface_of(facets), 0.1))),
                    .origin = {0.0, 0.1, 0.0}};
    CHECK(volume_of(mesh, Cut::plane) == Approx(area));
    const Points points = fill_body(std::vector<BodyShape>{mesh}, d, Cut::plane);
    CHECK(std::abs(double(points.size()) * d * d - area) <= 0.5 * d * d);
    double nearest = 1e300, depth_of_outer = 0.0;
    int outer = 0;
    Vector3d centre = Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double depth = -signed_distance(mesh, points[i], Cut::plane);
      CHECK(points[i][1] == Approx(0.0).margin(1e-12));
      CHECK(depth > 0.24 * d);
      centre += points[i] / double(points.size());
      if (depth < d) depth_of_outer += depth, ++outer;
      for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (points[i] - points[j]).norm());
    }
    CAPTURE(area, nearest / d, depth_of_outer / outer / d, centre.norm() / d);
    CHECK(nearest > 0.6 * d);
    CHECK(depth_of_outer / outer == Approx(0.5 * d).margin(0.1 * d));
    CHECK(centre.norm() < 0.05 * d);
  }
}

TEST_CASE("particles of a mesh go with its place, and are the same at every call", "[sph][fast]") {
  std::vector<Facet> facets = sphere_facets(0.5, 12, 24), moved = facets;
  for (Facet& f : moved)
    for (Vector3d& x : f) x += Vector3d(3.0, -2.0, 1.0);
  const Mesh here{.surface = surface_of(facets)}, there{.surface = surface_of(moved), .origin = {3.0, -2.0, 1.0}};
  const Points a = fill_mesh<3>(here, 0.1), b = fill_mesh<3>(there, 0.1), again = fill_mesh<3>(here, 0.1);
  CHECK(a == again);
  REQUIRE(a.size() == b.size());
  for (std::size_t n = 0; n < a.size(); ++n) CHECK((a[n] - b[n]).norm() < 1e-6);
  CHECK(signed_distance(there, Vector3d(0.0, 0.0, 0.6), Cut::space) ==
        Approx(signed_distance(here, Vector3d(0.0, 0.0, 0.6), Cut::space)));
}

TEST_CASE("distances of a lattice are exact where they are asked for and on the right side elsewhere", "[sph][fast]") {
  const auto ball = surface_of(sphere_facets(0.5, 12, 24));
  const Vector3d origin(-1.0, -1.0, -1.0), edges(0.1, 0.11, 0.09);
  for_distances(*ball, origin, edges, {20, 20, 22}, -0.2, 0.15, [&](const std::array<int, 3>& n, double distance) {
    const double exact = ball->signed_distance(origin + edges.cwiseProduct(Vector3d(n[0], n[1], n[2])));
    if (exact >= -0.2 && exact <= 0.15)
      REQUIRE(distance == exact);
    else
      REQUIRE((exact < -0.2 ? distance < -0.2 && distance >= exact : distance > 0.15 && distance <= exact));
  });
}

TEST_CASE("a beach of triangles is the beach of the bed's rows, particle by particle", "[sea][sph][fast]") {
  const auto wall_x = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) { return Facet{a, b, c}; };
  const auto at = [](double x, double y, double z) { return Vector3d(x, y, z); };
  // From (2.03, -1) up to (5, 0.5): a prism that goes on under the bed and beyond the tank.
  const std::array<std::array<double, 2>, 4> outline{{{2.03, -1.0}, {2.03, -2.0}, {6.0, -2.0}, {6.0, 1.0050505}}};
  std::vector<Facet> facets;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &p = outline[k], &q = outline[(k + 1) % 4];
    facets.push_back(wall_x(at(p[0], -3, p[1]), at(q[0], -3, q[1]), at(q[0], 3, q[1])));
    facets.push_back(wall_x(at(p[0], -3, p[1]), at(q[0], 3, q[1]), at(p[0], 3, p[1])));
  }
  for (const double y : {-3.0, 3.0})
    for (const std::size_t k : {1u, 2u}) {
      Facet cap{at(outline[0][0], y, outline[0][1]), at(outline[k][0], y, outline[k][1]),
                at(outline[k + 1][0], y, outline[k + 1][1])};
      if (y < 0.0) std::swap(cap[1], cap[2]);
      facets.push_back(cap);
    }
  TankPlan by_rows{.x = {0.0, 5.0}, .y = {0.0, 1.0}, .depth = 1.0, .top = 0.6};
  TankPlan by_surface = by_rows;
  by_rows.bed = {{2.03, -1.0}, {5.0, 0.5}};
  by_surface.walls = {{surface_of(facets), false}};
  Parameters p;
  p.spacing = 0.1, p.h_over_d = 1.5, p.eos = {1000.0, 10.0 * std::sqrt(9.81)};
  const auto rows = lay_out<3>(by_rows, p), surface = lay_out<3>(by_surface, p);
  CHECK(rows.water == surface.water);
  const TankCount counted = count_tank<3>(by_surface, p);
  CHECK(counted.water == Approx(double(surface.water)).epsilon(0.02));
  CHECK(counted.walls == Approx(double(surface.walls)).epsilon(0.1));
  const auto water = [](const TankParticles<3>& t) {
    std::vector<std::array<double, 3>> places;
    for (const Seed<3>& s : t.seeds.all())
      if (s.owner == water_owner) places.push_back(s.position);
    return places;
  };
  CHECK(water(rows) == water(surface));
  // What water feels of it is there in both: every wall within two spacings of water.
  const auto felt = [&](const TankParticles<3>& t) {
    std::vector<std::array<double, 3>> places;
    for (const Seed<3>& s : t.seeds.all())
      if (s.owner == wall_owner && s.position[0] > 0.0 && s.position[0] < 5.0 && s.position[1] > 0.0 && s.position[1] < 1.0 &&
          s.position[2] > -1.0 && s.position[2] > by_rows.bed_at(s.position[0]) - 0.2)
        places.push_back(s.position);
    return places;
  };
  CHECK(felt(rows).size() > 100);
  CHECK(felt(rows) == felt(surface));
}

TEST_CASE("a basin of triangles holds water inside and is solid around", "[sea][sph][fast]") {
  TankPlan plan{.x = {-1.2, 1.2}, .y = {-1.2, 1.2}, .depth = 1.0, .top = 0.4};
  plan.walls = {{surface_of(cylinder_facets(1.0, -2.0, 1.0, 96)), true}};
  Parameters p;
  p.spacing = 0.1, p.h_over_d = 1.5, p.eos = {1000.0, 10.0 * std::sqrt(9.81)};
  const auto tank = lay_out<3>(plan, p);
  CHECK(double(tank.water) * 1e-3 == Approx(pi).epsilon(0.02));
  const TankCount counted = count_tank<3>(plan, p);
  CHECK(counted.water == Approx(double(tank.water)).epsilon(0.02));
  CHECK(counted.walls == Approx(double(tank.walls)).epsilon(0.1));
  for (const Seed<3>& s : tank.seeds.all()) {
    const double r = std::hypot(s.position[0], s.position[1]);
    if (s.owner == water_owner) REQUIRE(r < 1.0);
    if (s.owner == wall_owner && s.position[2] > -1.0) REQUIRE(r > 0.99);
  }
}
