// Sensors where the answer is known: points of surfaces, hydrostatic pressure over a patch, means over time.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sensors.hpp"

#include <catch2/catch.hpp>

#include "src/sea/sph/sea_sph.hpp"
#include "src/sea/sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

TEST_CASE("points of a sensor lie on the surface inside its box, about a spacing apart", "[sea][sph][sensor][fast]") {
  const std::vector<BodyShape> shapes{Sphere{.centre = {0, 0, 0}, .radius = 1.0},
                                      Cylinder{.start = {0, 0, 0}, .end = {0, 0, 2}, .start_radius = 0.5, .end_radius = 0.5}};
  const Eigen::Vector3d low(-2, -2, -2), high(2, 2, 0.5);
  const double d = 0.1;
  const Points particles = fill_body(shapes, d, Cut::space);
  const Points points = points_of_surface(particles, shapes, low, high, d, Cut::space);
  for (const Eigen::Vector3d& x : points) {
    CHECK(std::abs(signed_distance(shapes, x, Cut::space)) < 1e-3 * d);
    CHECK(x[2] <= 0.5);
  }
  const double area = 2.0 * pi * 1.5;  // of the cap under z = 0.5
  CHECK(double(points.size()) * d * d == Approx(area).epsilon(0.15));
  CHECK(points_of_surface(particles, shapes, {3, 3, 3}, {4, 4, 4}, d, Cut::space).empty());
  const Points rectangle = points_of_rectangle({0, 1, 0}, {0.4, 1, 0.3}, d, Cut::space);
  CHECK(rectangle.size() == 12);
  for (const Eigen::Vector3d& x : rectangle) CHECK(x[1] == 1.0);
}

TEST_CASE("a sensor's mean is over its time, with the shares of steps that reach into it", "[sea][sph][sensor][fast]") {
  PatchRecord record(0.3);
  CHECK(record.mean().pressure == 0.0);
  record.add(0.0, {7.0, {0, 0, 0}});
  CHECK(record.mean().pressure == 7.0);
  for (const double p : {1.0, 2.0, 3.0}) record.add(0.2, {p, {p, 0, -p}});
  CHECK(record.mean().pressure == Approx((0.2 * 3.0 + 0.1 * 2.0) / 0.3));
  CHECK(record.mean().force[2] == Approx(-(0.2 * 3.0 + 0.1 * 2.0) / 0.3));
  std::vector<double> packed;
  record.pack(packed);
  CHECK(packed.size() == 1 + 2 * PatchRecord::numbers);  // the oldest step is of no more use
  PatchRecord again(0.3);
  again.unpack(std::span<const double>(packed).subspan(1));
  record.add(0.05, {9.0, {}}), again.add(0.05, {9.0, {}});
  CHECK(again.mean().pressure == record.mean().pressure);
}

TEST_CASE("patches in still water read the pressure at their middle within 1 % of the depth's, and share out the load on a body",
          "[sea][sph][sensor][fast]") {
  TankPlan plan;
  plan.x = {-1.0, 1.0}, plan.depth = 1.0, plan.top = 0.3;
  const BodyShape hull = Box{.centre = {0, 0, 0}, .size = {0.6, 1.0, 0.6}};
  plan.bodies = {{"box", {hull}, {.position = {0.013, 0.0, -0.1}}}};
  Parameters p;
  p.spacing = 0.05, p.h_over_d = 1.5, p.diffusion = DiffusionChoice::fourtakas, p.alpha = p.alpha_solid = 0.02;
  p.eos = {1000.0, 10.0 * std::sqrt(p.gravity)}, p.boundary = BoundaryChoice::extrapolated, p.contact = false;
  const auto tank = lay_out<2>(plan, p);
  SeaSph<2> sea(p, tank.domain, tank.seeds);
  sea.add_body(tank.bodies[0], plan.bodies[0].motion);
  const std::uint16_t owner = tank.bodies[0];
  const auto rectangle = [&](Eigen::Vector3d low, Eigen::Vector3d high) {
    return Patch{.owner = wall_owner, .low = low, .high = high, .points = points_of_rectangle(low, high, 0.025, Cut::plane)};
  };
  Patch side = rectangle({1.0, 0, -0.7}, {1.0, 0, -0.3}), bed = rectangle({-0.2, 0, -1.0}, {0.2, 0, -1.0});
  side.low[0] -= p.reach(), side.high[0] += p.reach(), bed.low[2] -= p.reach(), bed.high[2] += p.reach();
  sea.add_sensor(side), sea.add_sensor(bed);
  for (const auto& [low, high] : {std::pair{-9.0, 0.0}, {0.0, 9.0}}) {
    const Eigen::Vector3d from(-9, -9, low), to(9, 9, high);
    sea.add_sensor(patch_of_body(sea.state().solids.back(), std::vector{hull}, from, to, p, Cut::plane));
  }
  const Eigen::Vector3d from(-0.2, -9, -0.31), to(0.2, 9, -0.29);  // thinner than a row of particles, away from the edges
  sea.add_sensor(patch_of_body(sea.state().solids.back(), std::vector{hull}, from, to, p, Cut::plane));
  CHECK_THROWS_AS(sea.add_sensor({.owner = owner, .low = from, .high = to}), std::invalid_argument);  // nothing says which count
  sea.set_bodies([](const HalfStep&, std::span<const Wrench>, std::span<Motion>) {});
  sea.set_step_control({.steps_per_check = 1});
  sea.advance(0.6);
  const auto read = [&](std::size_t n) { return sea.state().records[n].mean(); };
  const double weight = 1000.0 * p.gravity;
  CHECK(read(0).pressure == Approx(0.5 * weight).margin(0.01 * weight));
  CHECK(read(0).force[0] == Approx(0.5 * weight * 0.4).epsilon(0.05));
  CHECK(read(1).pressure == Approx(weight).margin(0.01 * weight));
  CHECK(read(1).force[2] == Approx(-weight * 0.4).epsilon(0.03));
  // Of the lower half of the box: its bottom at a depth of 0.4 m, its sides at 0.25 m.
  CHECK(read(2).pressure == Approx(0.325 * weight).margin(0.03 * weight));
  // Of the bottom alone the whole force on its area, though the box holds none of its particles.
  CHECK(read(4).pressure == Approx(0.4 * weight).margin(0.02 * weight));
  CHECK(read(4).force[2] == Approx(0.4 * weight * 0.4).epsilon(0.03));
  const Wrench load = sea.load_on(owner, Eigen::Vector3d::Zero());
  CHECK(read(2).force[2] + read(3).force[2] == Approx(load.force[2]).epsilon(1e-9));
  CHECK(read(2).force[0] + read(3).force[0] == Approx(load.force[0]).margin(1e-6 * weight));
}

TEST_CASE("patches share out the load on a body whose particles have its own mass", "[sea][sph][sensor][fast]") {
  TankPlan plan;
  plan.x = {-1.0, 1.0}, plan.depth = 1.0, plan.top = 0.3;
  const BodyShape hull = Box{.centre = {0, 0, 0}, .size = {0.6, 1.0, 0.6}};
  plan.bodies = {{"box", {hull}, {.position = {0.013, 0.0, -0.1}}}};
  Parameters p;
  p.spacing = 0.1, p.h_over_d = 1.5, p.eos = {1000.0, 10.0 * std::sqrt(p.gravity)}, p.own_mass = true;
  const auto tank = lay_out<2>(plan, p);
  SeaSph<2> sea(p, tank.domain, tank.seeds);
  sea.add_body(tank.bodies[0], plan.bodies[0].motion, 0.4 * double(tank.body_points[0].size()) * p.mass(2));
  for (const auto& [low, high] : {std::pair{-9.0, 0.0}, {0.0, 9.0}}) {
    const Eigen::Vector3d from(-9, -9, low), to(9, 9, high);
    sea.add_sensor(patch_of_body(sea.state().solids.back(), std::vector{hull}, from, to, p, Cut::plane));
  }
  sea.evaluate();
  read_sensors(sea.state(), MPI_COMM_SELF);
  const Wrench load = sea.load_on(tank.bodies[0], Eigen::Vector3d::Zero());
  CHECK(load.force[2] > 100.0);
  CHECK(sea.state().records[0].mean().force[2] + sea.state().records[1].mean().force[2] == Approx(load.force[2]).epsilon(1e-9));
}
