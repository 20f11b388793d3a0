// Bodies of particles: placing, loads, and water pushing them as it should.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/solids.hpp"

#include <catch2/catch.hpp>

#include <omp.h>

#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "src/sea/sph/shapes.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

template <int dim>
void add_body(std::vector<Seed<dim>>& seeds, const Points& points, const Motion& motion, std::uint16_t owner) {
  for (const auto& point : points) seeds.push_back({.position = from_earth<dim>(motion.point(point)), .owner = owner});
}

/// Sums over the water of the last evaluation: force, and moment about the origin.
std::pair<Eigen::Vector3d, Eigen::Vector3d> push_on_water(const SeaSph<3, double>& sea) {
  Eigen::Vector3d push = Eigen::Vector3d::Zero(), twist = Eigen::Vector3d::Zero();
  const auto& store = sea.store();
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle || store.owner[slot / cluster_size] != 0) continue;
    const auto s = sums_at(store, slot);
    const Eigen::Vector3d f = std::pow(sea.parameters().mass(3), 2) * Eigen::Vector3d(s[0], s[1], s[2]);
    push += f, twist += Eigen::Vector3d(store.x[0][slot], store.x[1][slot], store.x[2][slot]).cross(f);
  }
  return {push, twist};
}

}  // namespace

TEST_CASE("a body's particles follow its motion and come back exactly", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1;
  auto seeds = disordered_block<3>(p.spacing, {8, 8, 6}, {0, 0, 0}, false);
  Motion start;
  start.position = {0.4, 0.4, 0.9};
  start.attitude = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0).normalized());
  add_body(seeds, points_in_box({0.4, 0.3, 0.2}, p.spacing), start, 1);
  SeaSph<3> sea(p, Domain<3>{{-2, -2, -2}, {3, 3, 3}}, seeds);
  sea.add_body(1, start);
  Motion moved = start;
  moved.position += Eigen::Vector3d(0.5, -0.2, 0.3);
  moved.attitude = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()) * start.attitude;
  moved.velocity = {1, 2, 3}, moved.omega = {0.1, -0.5, 0.2};
  place_body(sea.state(), 1, moved);
  sea.evaluate();  // sorts: the body went more than the drift
  CHECK(sea.state().work.sorts == 1);
  double worst = 0.0;
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
    if (sea.store().id[slot] == no_particle || sea.store().owner[slot / cluster_size] != 1) continue;
    const auto& from = seeds[sea.store().id[slot]].position;
    const Eigen::Vector3d local = start.attitude.conjugate() * (to_earth<3>(from) - start.position);
    const Eigen::Vector3d x = moved.point(local), v = moved.point_velocity(local);
    for (int k = 0; k < 3; ++k)
      worst = std::max({worst, std::abs(x[k] - sea.store().x[k][slot]), std::abs(v[k] - sea.store().v[k][slot])});
  }
  CHECK(worst < 1e-14);
}

TEST_CASE("the load on a body is the opposite of its push on the water, the same for any number of threads", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.gravity = 0.0;
  auto seeds = disordered_block<3>(p.spacing, {9, 9, 9}, {0, 0, 0}, false);
  Motion body;
  body.position = {0.45, 0.45, 1.05};
  add_body(seeds, points_in_sphere(0.25, p.spacing), body, 1);
  const int threads = omp_get_max_threads();
  const auto run = [&](int n) {
    omp_set_num_threads(n);
    SeaSph<3, double> sea(p, Domain<3>{{-2, -2, -2}, {3, 3, 3}}, seeds);
    sea.evaluate();
    const Wrench w = sea.load_on(1, Eigen::Vector3d::Zero());
    const auto [push, twist] = push_on_water(sea);
    CHECK(w.force.norm() > 1.0);
    CHECK((w.force + push).norm() < 1e-11 * w.force.norm());
    CHECK((w.moment + twist).norm() < 1e-11 * w.force.norm());
    return w.force;
  };
  const Eigen::Vector3d one = run(1);
  CHECK(run(3) == one);
  omp_set_num_threads(threads);
}

TEST_CASE("particles of a body that have its own mass push the water by it and are pushed by it", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.gravity = 0.0;
  auto seeds = disordered_block<3>(p.spacing, {9, 9, 9}, {0, 0, 0}, false);
  const Points points = points_in_sphere(0.25, p.spacing);
  Motion body;
  body.position = {0.45, 0.45, 1.05};
  add_body(seeds, points, body, 1);
  struct Loaded {
    Eigen::Vector3d on_body, on_water;
    std::vector<double> sums;
    EnergyFlow energy;
  };
  const auto loaded = [&](bool own_mass, double weight) {
    p.own_mass = own_mass;
    SeaSph<3, double> sea(p, Domain<3>{{-2, -2, -2}, {3, 3, 3}}, seeds);
    Motion moving = body;
    moving.velocity = {0.0, 0.0, -1.0};
    sea.add_body(1, moving, weight * double(points.size()) * p.mass(3));
    place_body(sea.state(), 1, moving);
    sea.evaluate();
    Loaded l{.on_body = sea.load_on(1, Eigen::Vector3d::Zero()).force, .on_water = push_on_water(sea).first};
    for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
      if (sea.store().id[slot] == no_particle) continue;
      const auto s = sums_at(sea.store(), slot);
      l.sums.insert(l.sums.end(), s.begin(), s.end());
    }
    sea.begin_step(1e-5), sea.half_step(), sea.end_step();
    l.energy = sea.state().energy;
    return l;
  };
  const Loaded plain = loaded(false, 0.4), light = loaded(true, 0.4), alike = loaded(true, 1.0);
  CHECK(plain.on_body.norm() > 1.0);
  CHECK((light.on_body - 0.4 * plain.on_body).norm() < 1e-12 * plain.on_body.norm());
  CHECK((light.on_body + light.on_water).norm() < 1e-11 * plain.on_body.norm());
  CHECK(light.sums != plain.sums);
  double apart = 0.0, largest = 0.0;  // of those of water's weight: rounding alone
  for (std::size_t n = 0; n < plain.sums.size(); ++n)
    apart = std::max(apart, std::abs(alike.sums[n] - plain.sums[n])), largest = std::max(largest, std::abs(plain.sums[n]));
  CHECK(apart < 1e-12 * largest);
  CHECK(std::abs(double(light.energy.from_solids) / double(plain.energy.from_solids) - 0.4) < 1e-3);
}

TEST_CASE("a solid without particles, or in two runs of them, is refused", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1;
  auto seeds = disordered_block<2>(p.spacing, {8, 8}, {0, 0}, true);
  std::vector<Seed<2>> twice = seeds;
  twice.insert(twice.end(), seeds.begin(), seeds.end());
  SeaSph<2> sea(p, Domain<2>{{-2, -2}, {3, 3}}, seeds), other(p, Domain<2>{{-2, -2}, {3, 3}}, twice);
  CHECK_THROWS(sea.add_body(2, Motion{}));
  CHECK_THROWS(other.add_body(1, Motion{}));
}

TEST_CASE("a particle that leaves the domain stops the run with its place named", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.gravity = 0.0;
  auto seeds = disordered_block<2>(p.spacing, {8, 8}, {0, 0}, false);
  seeds[7].velocity = {20.0, -20.0};  // a corner of the block
  {
    SeaSph<2> sea(p, Domain<2>{{-1, -1}, {2, 2}}, seeds);
    CHECK_THROWS_WITH(sea.advance(0.5), Catch::Contains("left the tank through its walls") && Catch::Contains(", 7, at ("));
  }
  p.lost_at_most = 64;
  SeaSph<2> sea(p, Domain<2>{{-1, -1}, {2, 2}}, seeds);
  sea.advance(0.1);
  CHECK(sea.store().lost.size() >= 1);
  std::size_t left = 0;
  for (auto id : sea.store().id) left += id != no_particle;
  CHECK(left + sea.store().lost.size() == seeds.size());
}

TEST_CASE(
    "what leaves over the walls' edge or through an open side is counted apart, and too much over the edge is told what to do",
    "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.gravity = 0.0;
  auto seeds = disordered_block<2>(p.spacing, {8, 8}, {0, 0}, false);
  Domain<2> domain{{-1, -1}, {2, 2}};
  const auto gone = [&](std::array<double, 2> velocity) {
    auto thrown = seeds;
    thrown[7].velocity = velocity;  // the lower right corner of the block
    SeaSph<2> sea(p, domain, thrown);
    sea.advance(0.1);
    return sea.state().gone();
  };
  domain.wall_high[0] = 1.2, domain.edge = -0.5;
  CHECK_THROWS_WITH(gone({20.0, -1.0}), Catch::Contains("over the upper edge") && Catch::Contains("sea.tank.over_edge"));
  p.left_at_most = 1;
  CHECK(gone({20.0, -1.0}).over_edge == 1);
  domain.edge = 0.9;  // now the particle is under it: through the wall
  CHECK_THROWS_WITH(gone({20.0, -1.0}), Catch::Contains("through its walls"));
  p.lost_at_most = 1;
  domain.high[0] = 10.0;  // the walls reach farther than it comes: it is between their rows
  CHECK(gone({20.0, -1.0}).lost == 1);
  domain.edge = -0.5;
  CHECK(gone({20.0, -1.0}).over_edge == 1);
  domain.high[0] = 2.0, domain.wall_high = Domain<2>::everywhere(1.0);
  domain.open = {true, false};
  CHECK(gone({20.0, -1.0}).through_open_sides == 1);
  CHECK(gone({20.0, -1.0}).lost == 0);
}

TEST_CASE("a state that is not a number stops the run", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1;
  auto seeds = disordered_block<2>(p.spacing, {8, 8}, {0, 0}, false);
  seeds[5].velocity[0] = std::numeric_limits<double>::quiet_NaN();
  SeaSph<2> sea(p, Domain<2>{{-1, -1}, {2, 2}}, seeds);
  CHECK_THROWS_WITH(sea.step(1.0), Catch::Contains("the stable step fell to"));
}
