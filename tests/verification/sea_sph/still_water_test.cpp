// Water at rest in a tank: pressure rho g depth, no drift, the bottom carries the weight, with dynamic walls and modified ones.
// Of the 0.5 % of rho g H that the pressure is off at c0 = 10 sqrt(g H), 0.2 % are the compression of the column itself.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/rigid/closed_surface.hpp"
#include "src/sea/sph/damping.hpp"
#include "src/sea/sph/gauges.hpp"
#include "src/sea/sph/tank.hpp"
#include "tests/kernels/rigid/surfaces.hpp"
#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift::sph;

namespace {

struct Rest {
  double pressure_rms, mean_height, fastest;  ///< share of rho g H, [m], [m/s]
};
Rest rest_of(const SeaSph<2>& sea, const Tank& tank) {
  Rest rest{};
  int count = 0;
  for_water_of(sea, [&](std::size_t slot) {
    const double z = sea.store().x[1][slot], scale = tank.p.eos.rho0 * tank.p.gravity * tank.depth;
    const double error =
        (tank.p.eos.pressure(sea.store().deviation[slot]) - tank.p.eos.rho0 * tank.p.gravity * (tank.surface() - z)) / scale;
    rest.pressure_rms += error * error, rest.mean_height += z, ++count;
    rest.fastest = std::max(rest.fastest, std::hypot(sea.store().v[0][slot], sea.store().v[1][slot]));
  });
  rest.pressure_rms = std::sqrt(rest.pressure_rms / count), rest.mean_height /= count;
  return rest;
}

void check_rest(const Tank& tank, double duration, long steps_at_least, double tolerance, bool modified = false) {
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  tank.add_walls_to(seeds, tank.columns, tank.rows + 6, modified);
  SeaSph<2> sea(tank.p, {{-1, -1}, {2, 2}}, seeds);
  const double height = rest_of(sea, tank).mean_height;
  while (sea.time() < duration || sea.state().work.steps < steps_at_least) sea.advance(0.5);
  const Rest rest = rest_of(sea, tank);
  CHECK(rest.pressure_rms < tolerance);  // three jittered starts at 0.05 m: 0.5 to 0.7 %, each wall's within 0.1 %
  CHECK(std::abs(rest.mean_height - height) < 0.02 * tank.p.spacing);
  CHECK(rest.fastest < 0.01 * std::sqrt(tank.p.gravity * tank.depth));
  const double weight = tank.p.mass(2) * tank.p.gravity * tank.columns * tank.rows;
  CHECK(-sea.load_on(1, {0, 0, 0}).force[2] == Approx(weight).epsilon(0.01));
  CHECK(sea.store().lost.empty());
}

}  // namespace

TEST_CASE("still water keeps its hydrostatic pressure within 1 % and does not creep", "[verification][sea][fast]") {
  check_rest(Tank(0.05, 1.0, 0.5, 10.0), 1.5, 0, 0.01);
}

TEST_CASE("still water between modified walls, sticking or sliding, is at rest too, and presses on them as it should",
          "[verification][sea][fast]") {
  Tank tank(0.05, 1.0, 0.5, 10.0);
  tank.p.wall = GENERATE(WallChoice::still, WallChoice::no_slip, WallChoice::free_slip);
  check_rest(tank, 1.0, 0, 0.01, true);
}

TEST_CASE("still water between extrapolated walls is at rest too", "[verification][sea][fast]") {
  Tank tank(0.05, 1.0, 0.5, 10.0);
  tank.p.boundary = BoundaryChoice::extrapolated;
  tank.p.wall = GENERATE(WallChoice::still, WallChoice::no_slip);
  check_rest(tank, 1.0, 0, 0.01);
}

TEST_CASE("still water stays still over 1e5 steps", "[verification][sea][nightly]") {
  check_rest(Tank(0.025, 1.0, 0.5, 10.0), 2.0, 100000, 0.01);
  check_rest(Tank(0.025, 1.0, 0.5, 20.0), 4.0, 0, 0.005);
}

TEST_CASE("a round basin of triangles holds its water: none is lost, and the pressure on its floor is hydrostatic",
          "[verification][sea][fast]") {
  const double depth = 0.8;
  spindrift::Triangulation round = spindrift::weld(spindrift::testing::cylinder_facets(0.9, -depth, 1.0, 48));
  REQUIRE_FALSE(why_not_closed(round));
  TankPlan plan;
  plan.x = plan.y = {-1.2, 1.2}, plan.depth = 1.0, plan.top = 0.3;
  const spindrift::testing::Replica replica = spindrift::testing::replica();
  plan.jitter = replica.jitter, plan.jitter_seed = replica.seed;
  plan.walls = {{std::make_shared<const spindrift::ClosedSurface>(std::move(round)), true}};
  Parameters p;
  p.spacing = 0.1, p.h_over_d = 1.5, p.kernel = KernelChoice::quintic, p.boundary = BoundaryChoice::extrapolated;
  p.diffusion = DiffusionChoice::fourtakas, p.alpha = 0.02, p.alpha_solid = 0.0;
  p.eos = {1000.0, 10.0 * std::sqrt(p.gravity * plan.depth)};
  const auto tank = lay_out<3>(plan, p);
  SeaSph<3> sea(p, tank.domain, tank.seeds);
  const std::array<std::array<double, 2>, 3> places{{{0.0, 0.0}, {0.5, 0.1}, {-0.3, -0.4}}};
  double read = 0.0, expected = 0.0;
  while (sea.time() < 0.8) {
    sea.state().damping.everywhere = sea.time() < 0.4 ? 5.0 : 0.0;
    sea.advance(1.0);
    if (sea.time() < 0.6) continue;
    const auto levels = surface_heights<3>(sea.store(), p, tank.domain, std::span<const std::array<double, 2>>(places), 0.0);
    for (std::size_t n = 0; n < places.size(); ++n) {
      read += probe<3>(sea.store(), p, tank.domain, {places[n][0], places[n][1], -depth}).pressure;
      expected += p.eos.rho0 * p.gravity * (levels[n] + depth);
    }
  }
  CAPTURE(read / expected);
  CHECK(read == Approx(expected).epsilon(0.02));  // over five jittered starts the reading differs by 0.1 %
  CHECK(sea.store().lost.empty());
}
