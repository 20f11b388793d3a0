// Contact of bodies with walls and with each other: where, how hard, named, and not counted as load of the water.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/contact.hpp"

#include <catch2/catch.hpp>

#include <omp.h>

#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "src/sea/sph/shapes.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double gap = 0.1, edge = 0.4;

Parameters parameters() {
  Parameters p;
  p.spacing = gap, p.h_over_d = 1.5, p.eos.c0 = 20.0;
  return p;
}

/// A bed of wall particles with its top at z = 0, and boxes with their centres at the given heights above each other.
std::vector<Seed<2>> stack(const std::vector<Motion>& boxes) {
  std::vector<Seed<2>> seeds;
  for_lattice<2>({-10, -3}, {10, 0}, [&](const std::array<int, 2>& at) {
    seeds.push_back({.position = {(at[0] + 0.5) * gap, (at[1] + 0.5) * gap}, .owner = 1});
  });
  std::uint16_t owner = 2;
  for (const Motion& box : boxes) {
    for (const auto& point : points_in_box({edge, 0.0, edge}, gap))
      seeds.push_back({.position = from_earth<2>(box.point(point)), .owner = owner});
    ++owner;
  }
  return seeds;
}
Motion at_height(double z, double x = 0.03) {
  Motion motion;
  motion.position = {x, 0.0, z};
  return motion;
}

}  // namespace

TEST_CASE("a body dropped on a bed in air comes to rest on it, pressed in by its weight over the stiffness", "[sph][fast]") {
  const Parameters p = parameters();
  const double mass = 0.5 * 1000.0 * edge * edge, gravity = p.gravity;
  Motion box = at_height(0.5 * edge + 0.1);
  SeaSph<2> sea(p, {{-2, -2}, {2, 4}}, stack({box}));
  sea.add_body(2, box, mass);
  double lowest = 1e9, energy = 1e9;
  bool fell_freely = true;
  while (sea.time() < 3.0) {
    const double dt = sea.begin_step(2e-3), z = box.position[2], v = box.velocity[2];
    if (sea.time() < 0.1) fell_freely = fell_freely && sea.contacts().empty();
    const auto acceleration = [&] {
      return (sea.load_on(2, box.position) += contact_on(sea.contacts(), 2, box.position)).force[2] / mass - gravity;
    };
    box.velocity[2] = v + 0.5 * dt * acceleration(), box.position[2] = z + 0.5 * dt * v;
    place_body(sea.state(), 2, box);
    sea.half_step();
    box.velocity[2] = v + dt * acceleration(), box.position[2] = z + 0.5 * dt * (v + box.velocity[2]);
    place_body(sea.state(), 2, box);
    sea.end_step();
    lowest = std::min(lowest, box.position[2]);
    const double now = 0.5 * v * v + gravity * box.position[2];
    CHECK(now < 1.02 * gravity * (0.5 * edge + 0.1));  // a bounce never goes higher
    energy = now;
  }
  CHECK(fell_freely);
  CHECK(lowest > 0.5 * edge - 0.4 * gap);
  CHECK(energy == Approx(gravity * box.position[2]).margin(1e-3));
  CHECK(box.position[2] == Approx(0.5 * edge).margin(0.15 * gap));
  CHECK(sea.load_on(2, box.position).force.norm() == 0.0);
  REQUIRE(sea.contacts().size() == 1);
  CHECK(sea.contacts()[0].on == 1);
  CHECK(sea.contacts()[0].of == 2);
  CHECK(contact_on(sea.contacts(), 2, box.position, 1).force[2] == Approx(mass * gravity).epsilon(0.02));
  CHECK(contact_on(sea.contacts(), 1, box.position).force[2] == Approx(-mass * gravity).epsilon(0.02));
  CHECK(contact_on(sea.contacts(), 2, box.position, 3).force.norm() == 0.0);
}

TEST_CASE("bodies press on each other with opposite forces and moments, whatever columns they stand in", "[sph][fast]") {
  Motion lower = at_height(1.0), upper = at_height(1.0 + edge - 0.02, 0.21);
  upper.attitude = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  const auto seeds = stack({lower, upper});
  const int threads = omp_get_max_threads();
  const auto run = [&](int n, bool contact) {
    omp_set_num_threads(n);
    Parameters p = parameters();
    p.contact = contact;
    SeaSph<2> sea(p, {{-2, -2}, {2, 4}}, seeds);
    sea.add_body(2, lower, 80.0);
    sea.add_body(3, upper, 80.0);
    sea.evaluate();
    const Wrench a = contact_on(sea.contacts(), 2, {0, 0, 0}), b = contact_on(sea.contacts(), 3, {0, 0, 0});
    CHECK((a.force + b.force).norm() == 0.0);
    CHECK((a.moment + b.moment).norm() == 0.0);
    CHECK(sea.contacts().size() == (contact ? 1 : 0));
    return b;
  };
  const Wrench one = run(1, true);
  CHECK(one.force[2] > 10.0);
  // All pairs, the obvious way.
  const Contact law = contact_law(parameters(), 2);
  double expected = 0.0;
  for (const auto& i : seeds)
    for (const auto& j : seeds)
      if (i.owner == 3 && j.owner == 2)
        expected += law.force(Vec<double, 2>{i.position[0] - j.position[0], i.position[1] - j.position[1]}, Vec<double, 2>{})[1];
  CHECK(one.force[2] == Approx(expected).epsilon(1e-4));
  CHECK(run(3, true).force == one.force);
  CHECK(run(1, false).force.norm() == 0.0);
  omp_set_num_threads(threads);
}

TEST_CASE("a light body bounds the step, and the bound is named", "[sph][fast]") {
  Motion sheet = at_height(0.55);
  auto seeds = stack({});
  for (const auto& point : points_in_box({edge, 0.0, gap}, gap))
    seeds.push_back({.position = from_earth<2>(sheet.point(point)), .owner = 2});
  SeaSph<2> sea(parameters(), {{-2, -2}, {2, 4}}, seeds), driven(parameters(), {{-2, -2}, {2, 4}}, seeds);
  sea.add_body(2, sheet, 0.01 * 1000.0 * edge * gap);
  driven.add_body(2, sheet);
  CHECK(sea.begin_step(1.0) == Approx(0.5 * step_limit_body(0.01, 1.0, gap, 20.0)).epsilon(1e-6));
  CHECK(std::string(sea.state().plan.limits.name()) == "light body");
  CHECK(driven.begin_step(1.0) > sea.state().plan.limits.body);
  CHECK(std::string(driven.state().plan.limits.name()) == "acoustic");
}
