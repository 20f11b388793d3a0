// A box afloat in 2-D: it comes to rest at the draft of Archimedes, within half a spacing, because its particles displace its
// own volume.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/sea/sph/shapes.hpp"
#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

/// Way of the centre in spacings, upwards, from the draft of Archimedes to rest; heave only, with a damper that fades the start.
double rise_to_rest(double spacing, double relative_weight, double duration) {
  const double edge = 0.4, damping = 2.0;
  const Tank tank(spacing, 1.6, 0.6);
  const double mass = relative_weight * tank.p.eos.rho0 * edge * edge;
  Motion box;
  box.position = {0.5 * (tank.columns - 1) * spacing, 0.0, tank.surface() + edge * (0.5 - relative_weight)};
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  std::erase_if(seeds, [&](const Seed<2>& seed) {
    return std::abs(seed.position[0] - box.position[0]) < 0.5 * edge && std::abs(seed.position[1] - box.position[2]) < 0.5 * edge;
  });
  tank.add_walls_to(seeds, tank.columns, tank.rows + 10);
  for (const Eigen::Vector3d& point : points_in_box({edge, 0.0, edge}, spacing)) {
    const auto x = from_earth<2>(box.point(point));
    seeds.push_back({.position = x,
                     .deviation = tank.p.eos.hydrostatic_deviation(std::max(0.0, tank.surface() - x[1]), tank.p.gravity),
                     .owner = 2});
  }
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  sea.add_body(2, box);
  const double start = box.position[2];
  while (sea.time() < duration) {
    const double dt = sea.begin_step(1.0), z = box.position[2], v = box.velocity[2];
    const auto acceleration = [&] {
      return sea.load_on(2, box.position).force[2] / mass - tank.p.gravity - damping * box.velocity[2];
    };
    const double v_half = v + 0.5 * dt * acceleration();
    box.position[2] = z + 0.5 * dt * v, box.velocity[2] = v_half;
    sea.place_body(2, box);
    sea.half_step();
    box.velocity[2] = v + dt * acceleration();
    box.position[2] = z + 0.5 * dt * (v + box.velocity[2]);
    sea.place_body(2, box);
    sea.end_step();
  }
  CHECK(sea.store().lost.empty());
  return (box.position[2] - start) / spacing;
}

}  // namespace

TEST_CASE("a half-buoyant box floats at half its height within half a spacing", "[verification][sea][fast]") {
  CHECK(std::abs(rise_to_rest(0.05, 0.5, 1.5)) < 0.5);
}

TEST_CASE("light and heavy boxes float at their draft within half a spacing", "[verification][sea][nightly]") {
  const double weight = GENERATE(0.1, 0.5, 0.9);
  CHECK(std::abs(rise_to_rest(0.025, weight, 3.0)) < 0.5);
}
