// The sea of particles far outside its usual range: light and heavy bodies, coarse and fine drops, disorder, dry beds and
// plunging water, bodies that leave, come back, go under and touch; soft and stiff water. Everything stays bounded, no particle
// is lost unaccounted, or the run stops with a reason. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <random>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "tests/verification/sea_sph/floater.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

/// Every number of the state is one, every particle is in the store or on the list of the lost.
template <class Sea>
void check_sound(const Sea& sea, std::size_t seeded, double fastest_allowed) {
  std::size_t present = 0;
  double fastest = 0.0;
  bool finite = true;
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
    if (sea.store().id[slot] == no_particle) continue;
    ++present;
    const double speed = std::hypot(sea.store().v[0][slot], sea.store().v[1][slot]);
    finite = finite && std::isfinite(speed + sea.store().x[0][slot] + sea.store().x[1][slot] + sea.store().deviation[slot]);
    if (sea.store().owner[slot / cluster_size] == 0) fastest = std::max(fastest, speed);
  }
  CHECK(finite);
  CHECK(present + sea.store().lost.size() == seeded);
  CHECK(fastest < fastest_allowed);
}

/// Drops a cylinder of 5.5 cm radius at 2.955 m/s into 0.3 m of water; returns its height over the bottom at the end [m].
double drop(double per_radius, double relative_weight, double duration) {
  const double radius = 0.055, spacing = radius / per_radius;
  Tank tank(spacing, 0.6, 0.3, 20.0);
  tank.p.lost_at_most = 40;  // of the splash, which may jump over the rim
  Floater cylinder{2, {}, relative_weight * 1000.0 * pi * radius * radius, 0.0};
  cylinder.motion.position = {0.5 * (tank.columns - 1) * spacing, 0.0, tank.surface() + radius};
  cylinder.motion.velocity = {0.0, 0.0, -2.955};
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  tank.add_walls_to(seeds, tank.columns, 3 * tank.rows);
  insert_body(seeds, tank, points_in_cylinder(radius, 0.0, 1, spacing), cylinder.motion, 2, [](double, double) { return false; });
  SeaSph<2> sea(tank.p, {{-1, -1}, {2, 4}}, seeds);
  sea.add_body(2, cylinder.motion, cylinder.mass);
  place_body(sea.state(), 2, cylinder.motion);
  std::vector<Floater> bodies{cylinder};
  double lowest = 1e9;
  while (sea.time() < duration) {
    step_with(sea, bodies, 1.0);
    lowest = std::min(lowest, bodies[0].motion.position[2]);
  }
  check_sound(sea, seeds.size(), 40.0);
  CHECK(bodies[0].motion.velocity.norm() < 8.0);
  CHECK(lowest > tank.bottom() + radius - spacing);  // contact holds it off the bottom
  return bodies[0].motion.position[2] - tank.bottom();
}

}  // namespace

TEST_CASE("bodies from cork to stone dropped at five particles per radius stay bounded", "[extremes][sea][fast]") {
  const double light = drop(5.0, 0.01, 0.25), heavy = drop(5.0, 2.0, 0.25);
  CHECK(light > 0.3 - 0.055);  // six jittered starts: 0.3539 to 0.3540
  CHECK(heavy < 0.15);         // 0.057 to 0.059
}

TEST_CASE("bodies of every weight dropped at five particles per radius stay bounded, heavier ones lower",
          "[extremes][sea][nightly]") {
  double above = 1e9;
  for (double weight : {0.01, 0.1, 0.5, 0.99, 1.01, 2.0}) {
    const double height = drop(5.0, weight, 0.25);
    CHECK(height < above + 0.011);  // three jittered starts: each weight's within 0.005
    above = height;
  }
}

TEST_CASE("a cylinder dropped at 25 particles per radius stays bounded", "[extremes][sea][nightly]") { drop(25.0, 0.5, 0.1); }

TEST_CASE("ten times the allowed step is cut to what is allowed", "[extremes][sea][fast]") {
  const Tank tank(0.05, 1.0, 0.5);
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  tank.add_walls_to(seeds, tank.columns, tank.rows + 6);
  SeaSph<2> sea(tank.p, {{-1, -1}, {2, 2}}, seeds);
  const double allowed = sea.step(1e-9) * 0.0 + tank.p.cfl * tank.p.h() / tank.p.eos.c0;
  const double taken = sea.step(10.0 * allowed);
  CHECK(taken <= allowed);
  CHECK(taken > 0.9 * allowed);
  sea.advance(20.0 * allowed);
  check_sound(sea, seeds.size(), 0.5);
}

TEST_CASE("water with a quarter of a spacing of disorder calms down", "[extremes][sea][fast]") {
  const Tank tank(0.05, 1.0, 0.5);
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> displacement(-0.25 * tank.p.spacing, 0.25 * tank.p.spacing);
  for (Seed<2>& seed : seeds)
    for (double& x : seed.position) x += displacement(random);
  tank.add_walls_to(seeds, tank.columns, tank.rows + 6);
  SeaSph<2> sea(tank.p, {{-1, -1}, {2, 2}}, seeds);
  sea.advance(1.5);
  check_sound(sea, seeds.size(), 0.1 * std::sqrt(tank.p.gravity * tank.depth));  // six jittered starts: 0.045 to 0.050 for 0.22
  CHECK(sea.store().lost.empty());
}

TEST_CASE("water runs over a dry bed into corners, plunges, and none of it disappears", "[extremes][sea][fast]") {
  const double spacing = GENERATE(0.1, 0.05);
  Tank tank(spacing, 0.8, 1.2);
  tank.p.lost_at_most = 20;
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  tank.add_walls_to(seeds, 3 * tank.columns, 3 * tank.rows);
  SeaSph<2> sea(tank.p, {{-1, -1}, {4, 6}}, seeds);
  sea.advance(1.6);
  // Six jittered starts: 2.3 to 2.7 m/s at 0.1 m, 4.0 to 6.0 at 0.05, for 14.6.
  check_sound(sea, seeds.size(), 3.0 * std::sqrt(2.0 * tank.p.gravity * tank.depth));
}

TEST_CASE("a body that leaves the water, comes back and goes under is loaded only where it is wet", "[extremes][sea][fast]") {
  const double edge = 0.3, spacing = 0.05;
  const Tank tank(spacing, 1.2, 0.7);
  Motion box;
  box.position = {0.5 * (tank.columns - 1) * spacing, 0.0, tank.surface()};
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  insert_body(seeds, tank, points_in_box({edge, 0.0, edge}, spacing), box, 2,
              [&](double x, double z) { return std::abs(x) < 0.5 * edge && std::abs(z) < 0.5 * edge; });
  tank.add_walls_to(seeds, tank.columns, 2 * tank.rows);
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  sea.add_body(2, box);
  const double way = 0.4, omega = 2.0 * pi;  // up out of the water, back, down under it, and up again
  const Eigen::Vector3d middle = box.position;
  const auto place = [&](double t) {
    box.position = middle + Eigen::Vector3d(0, 0, way * std::sin(omega * t));
    box.velocity = {0, 0, way * omega * std::cos(omega * t)};
    place_body(sea.state(), 2, box);
  };
  double highest_load_in_air = 0.0, load_under = 0.0;
  while (sea.time() < 1.1) {
    const double t = sea.time(), dt = sea.begin_step(1.0), depth = tank.surface() - box.position[2];
    const double load = sea.load_on(2, box.position).force[2];
    CHECK(std::isfinite(load));
    if (t > 0.22 && t < 0.28) highest_load_in_air = std::max(highest_load_in_air, std::abs(load));
    if (depth > 0.5 * edge + 2.0 * spacing) load_under = std::max(load_under, load);
    place(t + 0.5 * dt);
    sea.half_step();
    place(t + dt);
    sea.end_step();
  }
  const double buoyancy = tank.p.eos.rho0 * tank.p.gravity * edge * edge;
  CHECK(highest_load_in_air < 0.1 * buoyancy);  // drops only
  CHECK(load_under > 0.5 * buoyancy);           // six jittered starts: 3.9 to 4.4 of it
  check_sound(sea, seeds.size(), 12.0);         // 4.2 to 4.8
}

TEST_CASE("two bodies dropped on each other in the water touch, are named, and come apart unharmed", "[extremes][sea][fast]") {
  const double edge = 0.3, spacing = 0.05;
  const Tank tank(spacing, 1.2, 0.5);
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  std::vector<Floater> bodies;
  for (int n = 0; n < 2; ++n) {
    Floater body{std::uint16_t(2 + n), {}, 0.4 * 1000.0 * edge * edge, 0.4 * 1000.0 * edge * edge * edge * edge / 6.0, true};
    body.motion.position = {0.5 * (tank.columns - 1) * spacing + 0.06 * n, 0.0, tank.surface() + 0.05 + n * (edge + 0.15)};
    insert_body(seeds, tank, points_in_box({edge, 0.0, edge}, spacing), body.motion, body.owner, [&](double x, double z) {
      return std::abs(x) < 0.5 * edge + 0.5 * spacing && std::abs(z) < 0.5 * edge + 0.5 * spacing;
    });
    bodies.push_back(body);
  }
  tank.add_walls_to(seeds, tank.columns, 3 * tank.rows);
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 4}}, seeds);
  for (const Floater& body : bodies) sea.add_body(body.owner, body.motion, body.mass);
  bool touched = false;
  double nearest = 1e9;
  while (sea.time() < 1.5) {
    step_with(sea, bodies, 1.0);
    for (const Touch& touch : sea.contacts()) touched = touched || (touch.on == 2 && touch.of == 3);
    nearest = std::min(nearest, (bodies[0].motion.position - bodies[1].motion.position).norm());
  }
  CHECK(touched);
  CHECK(nearest > edge - 0.5 * spacing);  // six jittered starts: 0.294 to 0.302 for 0.275
  for (const Floater& body : bodies) CHECK(body.motion.velocity.norm() < 3.0);
  check_sound(sea, seeds.size(), 6.0);
}

TEST_CASE("water from soft to stiff is still at five particles of depth", "[extremes][sea][fast]") {
  for (double ratio : {5.0, 15.0, 40.0}) {
    const Tank tank(0.1, 1.0, 0.5, ratio);
    std::vector<Seed<2>> seeds;
    tank.add_water_to(seeds);
    tank.add_walls_to(seeds, tank.columns, tank.rows + 6);
    SeaSph<2> sea(tank.p, {{-1, -1}, {2, 2}}, seeds);
    sea.advance(0.5);
    check_sound(sea, seeds.size(), 0.1);
    double error2 = 0.0;
    int count = 0;
    for_water_of(sea, [&](std::size_t slot) {
      const double depth = tank.surface() - sea.store().x[1][slot], weight = tank.p.eos.rho0 * tank.p.gravity;
      error2 += std::pow(tank.p.eos.pressure(sea.store().deviation[slot]) / (weight * tank.depth) - depth / tank.depth, 2),
          ++count;
    });
    CHECK(std::sqrt(error2 / count) < 0.022);  // six jittered starts: 1.4 to 1.6, 1.7 to 1.9 and 1.8 to 2.0 %
  }
}

TEST_CASE("a state blown up on purpose stops with a reason, never with a number that is none", "[extremes][sea][fast]") {
  const Tank tank(0.1, 1.0, 0.5);
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  tank.add_walls_to(seeds, tank.columns, tank.rows + 6);
  seeds[12].deviation = 1e9;  // denser than any water
  SeaSph<2> sea(tank.p, {{-1, -1}, {2, 2}}, seeds);
  CHECK_THROWS_AS(sea.advance(0.1), NumericalFailure);
}
