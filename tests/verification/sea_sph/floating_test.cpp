// Bodies afloat in 2-D. A box comes to rest at the draft of Archimedes within half a spacing, because its particles displace its
// own volume. A half-immersed cylinder let go above its rest swings with the period of linear theory.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "tests/verification/sea_sph/floater.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

/// Way of the centre in spacings, upwards, from the draft of Archimedes to rest; heave only, with a damper that fades the start.
double rise_to_rest(double spacing, double relative_weight, double duration) {
  const double edge = 0.4;
  const Tank tank(spacing, 1.6, 0.6);
  Floater box{.owner = 2, .motion = {}, .mass = relative_weight * tank.p.eos.rho0 * edge * edge, .inertia = 0.0};
  box.damping = 2.0;
  box.motion.position = {0.5 * (tank.columns - 1) * spacing, 0.0, tank.surface() + edge * (0.5 - relative_weight)};
  const double start = box.motion.position[2];
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  insert_body(seeds, tank, points_in_box({edge, 0.0, edge}, spacing), box.motion, 2,
              [&](double x, double z) { return std::abs(x) < 0.5 * edge && std::abs(z) < 0.5 * edge; });
  tank.add_walls_to(seeds, tank.columns, tank.rows + 10);
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  sea.add_body(2, box.motion, box.mass);
  std::vector<Floater> bodies{box};
  while (sea.time() < duration) step_with(sea, bodies, 1.0);
  CHECK(sea.store().lost.empty());
  CHECK(sea.contacts().empty());
  return (bodies[0].motion.position[2] - start) / spacing;
}

}  // namespace

TEST_CASE("a half-buoyant box floats at half its height within half a spacing", "[verification][sea][fast]") {
  CHECK(std::abs(rise_to_rest(0.05, 0.5, 1.5)) < 0.5);
}

TEST_CASE("light and heavy boxes float at their draft within half a spacing", "[verification][sea][nightly]") {
  const double weight = GENERATE(0.1, 0.5, 0.9);
  CHECK(std::abs(rise_to_rest(0.025, weight, 3.0)) < 0.5);
}

TEST_CASE("a cylinder let go above its rest swings with the period of theory with added mass, at any resolution and with either wall",
          "[verification][sea][nightly]") {
  // Linear potential theory, deep water: added mass and damping from multipoles (Ursell 1949; at omega^2 a/g 0.8 added mass 0.60
  // and damping 0.52 of the displaced mass), then the response to a step as the Fourier integral of the transfer function: first
  // lowest point at 3.72 sqrt(a/g), next highest one at 7.22. Evaluated for this test with two cut-offs and resolutions.
  // The viscosity must be small: with alpha 0.05 at the body too the Reynolds number is 46 and later turns come late or never.
  constexpr double lowest = 3.72, next_highest = 7.22;
  const double particles_per_radius = GENERATE(8.0, 10.0, 14.0);
  const bool modified = GENERATE(false, true);
  const double radius = 0.1, spacing = radius / particles_per_radius, raised = 0.25 * radius, held = 0.2;
  Tank tank(spacing, 2.0, 0.35);
  tank.p.alpha = 0.01, tank.p.alpha_solid = 0.0;
  Floater cylinder{.owner = 2, .motion = {}, .mass = 0.5 * tank.p.eos.rho0 * pi * radius * radius, .inertia = 0.0};
  cylinder.motion.position = {0.5 * (tank.columns - 1) * spacing, 0.0, tank.surface() + raised};
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  insert_body(seeds, tank, points_in_cylinder(radius, 0.0, 1, spacing), cylinder.motion, 2,
              [&](double x, double z) { return x * x + z * z < radius * radius; });
  for (Seed<2>& seed : seeds) {
    const double x = seed.position[0] - cylinder.motion.position[0], z = seed.position[1] - cylinder.motion.position[2];
    const double r = std::hypot(x, z), mirror = 2.0 * (radius - r) / r;
    if (modified && seed.owner == 2 && r > radius - 3.1 * spacing) seed.ghost = {mirror * x, mirror * z};
  }
  tank.add_walls_to(seeds, tank.columns, tank.rows + 10);
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  sea.add_body(2, cylinder.motion, cylinder.mass);
  while (sea.time() < held) sea.step(1.0);
  std::vector<Floater> bodies{cylinder};
  std::vector<double> turns, ways;
  double speed = 0.0;
  while (turns.size() < 2 && sea.time() < held + 1.2) {
    step_with(sea, bodies, 1.0);
    if (speed * bodies[0].motion.velocity[2] < 0.0) {
      turns.push_back((sea.time() - held) * std::sqrt(tank.p.gravity / radius));
      ways.push_back((bodies[0].motion.position[2] - tank.surface()) / raised);
    }
    speed = bodies[0].motion.velocity[2];
  }
  REQUIRE(turns.size() == 2);
  CAPTURE(particles_per_radius, modified, turns[0], turns[1], ways[0], ways[1]);
  CHECK(turns[0] == Approx(lowest).epsilon(0.05));
  CHECK(turns[1] == Approx(next_highest).epsilon(0.05));
}
