// Buoyancy of shapes in still water against formulas and against each other. SPDX-License-Identifier: Apache-2.0
#include "src/sea/still_water.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

using Shapes = std::vector<sph::BodyShape>;

waves::Wetted wetted(const Shapes& shapes, const Motion& motion, sph::Cut cut = sph::Cut::space, double width = 1.0) {
  return StillWater(std::vector<Shapes>{shapes}, 1.0, cut, width).wetted(0, motion);
}

Motion at(const Eigen::Vector3d& place, double turn = 0.0, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitY()) {
  Motion motion;
  motion.position = place;
  motion.attitude = Eigen::AngleAxisd(turn, axis);
  return motion;
}

Shapes box_of_triangles(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Triangulation t;
  for (int k = 0; k < 8; ++k) t.points.emplace_back(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
  t.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return {Mesh{std::make_shared<const ClosedSurface>(t), {0.3, -0.2, 0.1}}};
}

}  // namespace

TEST_CASE("boxes, spheres and cylinders displace what is under the water", "[sea][fast]") {
  const Shapes box{Box{{0.5, 0.0, 0.0}, {2.0, 3.0, 4.0}}};
  waves::Wetted w = wetted(box, at({7.0, -5.0, 1.5}));
  CHECK(w.volume == Approx(6.0 * 0.5));
  CHECK((w.first_moment / w.volume - Eigen::Vector3d(0.5, 0.0, -1.75)).norm() < 1e-12);
  CHECK(wetted(box, at({0.0, 0.0, -9.0})).volume == Approx(24.0));
  CHECK(wetted(box, at({0.0, 0.0, 9.0})).volume == 0.0);

  const Shapes ball{Sphere{{0.0, 0.4, 0.0}, 2.0}};
  w = wetted(ball, at({0.0, 0.0, 0.0}));
  CHECK(w.volume == Approx(2.0 / 3.0 * pi * 8.0));
  CHECK((w.first_moment / w.volume - Eigen::Vector3d(0.0, 0.4, -0.75)).norm() < 1e-12);  // 3/8 of the radius
  CHECK(wetted(ball, at({0.0, 0.0, 1.0})).volume == Approx(pi / 3.0 * 1.0 * 5.0));
  CHECK(wetted(ball, at({0.0, 0.0, 1.0}, 0.7, Eigen::Vector3d::UnitZ())).first_moment.head<2>().norm() ==
        Approx(0.4 * pi / 3.0 * 5.0));

  const Shapes upright{Cylinder{{0.0, 0.0, -3.0}, {0.0, 0.0, 3.0}, 1.0, 1.0}};
  CHECK(wetted(upright, at({0.0, 0.0, 1.0})).volume == Approx(2.0 * pi));
}

TEST_CASE("a box of triangles is lifted as the box at any attitude", "[sea][fast]") {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  for (const double turn : {0.0, 0.3, 1.2, 2.5})
    for (const double height : {-1.0, 0.0, 0.7}) {
      const Motion motion = at({100.0, 50.0, height}, turn, axis);
      const waves::Wetted triangles = wetted(box_of_triangles({-0.7, -1.2, -0.9}, {1.3, 0.8, 1.1}), motion),
                          box = wetted({Box{{0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}}}, motion);
      CHECK(triangles.volume == Approx(box.volume).margin(1e-12));
      CHECK((triangles.first_moment - box.first_moment).norm() < 1e-10);
    }
}

TEST_CASE("buoyancy is what a small heave or turn gains in potential energy", "[sea][fast]") {
  // The first moment's height is the energy of the displaced water: its derivatives are force and moment.
  const std::vector<Shapes> bodies{{Box{{0.2, 0.1, 0.0}, {2.0, 3.0, 1.0}}, Cylinder{{3.0, 0.0, -2.0}, {3.5, 0.0, 2.0}, 1.0, 0.6}},
                                   {Sphere{{0.0, 1.0, 0.0}, 1.2}, Cylinder{{-4.0, 0.0, 0.0}, {-2.0, 0.0, 0.2}, 0.7, 0.7}}};
  const StillWater water(bodies, 1.0, sph::Cut::space, 1.0);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Motion motion = at({3.0, 4.0, 0.2}, 0.3, Eigen::Vector3d(1.0, 2.0, 0.5).normalized());
    std::vector<Motion> motions(2, motion);
    std::vector<Wrench> wrenches(2);
    water.add_loads(motions, wrenches);
    // Height of the displaced water's centre times its volume, in the earth.
    const auto energy = [&](const Motion& m) {
      const waves::Wetted w = water.wetted(b, m);
      return -(w.first_moment.z() + m.position.z() * w.volume);
    };
    const double step = 1e-5;
    Motion up = motion, down = motion;
    up.position.z() += step, down.position.z() -= step;
    CHECK((energy(down) - energy(up)) / (2.0 * step) == Approx(wrenches[b].force.z()).epsilon(1e-6));
    for (int k = 0; k < 2; ++k) {
      const auto turned = [&](double angle) {
        Motion m = motion;
        m.attitude = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(k)) * motion.attitude;
        return energy(m);
      };
      CHECK((turned(-step) - turned(step)) / (2.0 * step) == Approx(wrenches[b].moment[k]).epsilon(1e-6));
    }
  }
}

TEST_CASE("a body of shapes that overlap displaces their union", "[sea][fast]") {
  const Shapes two{Box{{0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}}, Box{{1.0, 0.0, 0.0}, {2.0, 2.0, 2.0}}},
      one{Box{{0.5, 0.0, 0.0}, {3.0, 2.0, 2.0}}};
  for (const double height : {-2.0, 0.0, 0.4}) {
    const Motion motion = at({0.0, 0.0, height}, 0.2);
    const waves::Wetted a = wetted(two, motion), b = wetted(one, motion);
    CHECK(a.volume == Approx(b.volume).epsilon(2e-3));
    CHECK((a.first_moment - b.first_moment).norm() < 1e-2 * b.volume);
  }
  // A column on a pontoon, which reaches into it.
  const Shapes column{Box{{0.0, 0.0, -1.5}, {6.0, 2.0, 1.0}}, Cylinder{{0.0, 0.0, -2.0}, {0.0, 0.0, 2.0}, 0.9, 0.9}};
  CHECK(wetted(column, at({0.0, 0.0, 0.0})).volume == Approx(12.0 + pi * 0.81 * 1.0).epsilon(2e-3));
}

TEST_CASE("in the plane a body is its section, as wide as the scene, and is not turned out of it", "[sea][fast]") {
  const double width = 2.5;
  const auto volume = [&](const sph::BodyShape& shape, double height) {
    return wetted({shape}, at({0.0, 0.0, height}), sph::Cut::plane, width).volume;
  };
  CHECK(volume(Cylinder{{0.0, -0.5, 0.0}, {0.0, 0.5, 0.0}, 1.0, 1.0}, 0.0) == Approx(0.5 * pi * width));
  CHECK(volume(Sphere{{0.0, 4.0, 0.0}, 1.0}, 0.0) == Approx(0.5 * pi * width));
  CHECK(volume(Box{{0.0, 0.0, 0.0}, {2.0, 9.0, 1.0}}, 0.2) == Approx(2.0 * 0.3 * width));
  CHECK(volume(Cylinder{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.5, 0.5}, 0.0) == Approx(1.0 * width));
  CHECK(volume(Cylinder{{0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}, 0.5, 1.0}, 0.0) == Approx(1.5 * width));
  Mesh mesh = std::get<Mesh>(box_of_triangles({-0.7, -1.2, -0.9}, {1.3, 0.8, 1.1}).front());
  mesh.surface = std::make_shared<const ClosedSurface>(prism_of(outline_of(*mesh.surface, -0.2)));
  CHECK(volume(mesh, 0.3) == Approx(2.0 * 0.7 * width));

  const StillWater water(std::vector<Shapes>{{Box{{0.3, 0.0, 0.0}, {2.0, 1.0, 1.0}}}}, 1.0, sph::Cut::plane, width);
  const Motion motion = at({0.0, 0.0, 0.0}, 0.1, Eigen::Vector3d::UnitX());
  std::vector<Wrench> wrench(1);
  water.add_loads(std::span(&motion, 1), wrench);
  CHECK(wrench[0].moment.x() == 0.0);
  CHECK(wrench[0].moment.y() == Approx(-0.3 * wrench[0].force.z()).epsilon(1e-2));
}
