// A scene's tank filled with particles: counts, mass, where walls stand, what bodies displace.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/tank.hpp"

#include <omp.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "kernels/sph/kernel_wendland.hpp"
#include "kernels/waves/stokes.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/tank_count.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

TankPlan tank(double length, double width, double depth) {
  return {.x = {0.0, length}, .y = {0.0, width}, .depth = depth, .top = 0.5 * depth};
}
Parameters particles(double spacing, double depth) {
  Parameters p;
  p.spacing = spacing, p.h_over_d = 1.5, p.eos = {1000.0, 10.0 * std::sqrt(9.81 * depth)};
  return p;
}
template <int dim, class Visit>
void for_owner(const TankParticles<dim>& t, std::uint16_t owner, Visit&& visit) {
  for (const Seed<dim>& seed : t.seeds.all())
    if (seed.owner == owner) visit(seed);
}

}  // namespace

TEST_CASE("the water of a tank has the mass of water at rest, also where spacings do not divide its sides", "[sea][sph][fast]") {
  const double spacing = GENERATE(0.1, 0.13);
  const TankPlan plan = tank(2.0, 1.0, 1.0);
  Parameters p = particles(spacing, 1.0);
  const auto t = lay_out<3>(plan, p);
  CHECK(double(t.water) * p.mass(3) == Approx(2.0 * 1.0 * p.eos.column_mass(1.0, p.gravity)).epsilon(1e-12));
  double heaviest = 0.0;
  for_owner(t, water_owner, [&](const Seed<3>& seed) {
    CHECK(seed.position[2] < 0.0);
    CHECK(seed.position[2] > -1.0);
    heaviest = std::max(heaviest, seed.deviation);
  });
  CHECK(heaviest < p.eos.hydrostatic_deviation(1.0, p.gravity));
}

TEST_CASE("walls stand outside the water on all sides and under it, open at the top", "[sea][sph][fast]") {
  const TankPlan plan = tank(1.0, 0.6, 0.5);
  Parameters p = particles(0.1, 0.5);
  const auto t = lay_out<3>(plan, p);
  std::array<double, 3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for_owner(t, wall_owner, [&](const Seed<3>& seed) {
    const auto& x = seed.position;
    const bool inside = x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[1] < 0.6 && x[2] > -0.5;
    CHECK_FALSE(inside);
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  });
  CHECK(t.walls == (14 * 10 * (2 + 8) - 10 * 6 * 8));  // two layers round 10 x 6 cells, 5 deep and 3 up: water meets no third
  CHECK(low[2] == Approx(-0.65));
  CHECK(high[2] == Approx(0.25));
}

TEST_CASE("a slope keeps water above it and has walls under it", "[sea][sph][fast]") {
  TankPlan plan = tank(4.0, 0.0, 1.0);
  plan.bed = {{1.0, -1.0}, {4.0, 0.4}};
  Parameters p = particles(0.1, 1.0);
  const auto t = lay_out<2>(plan, p);
  for_owner(t, water_owner, [&](const Seed<2>& s) { CHECK(s.position[1] > plan.bed_at(s.position[0]) - 0.01); });
  int under = 0;
  for_owner(t, wall_owner, [&](const Seed<2>& s) {
    if (!(s.position[0] > 0.0 && s.position[0] < 4.0)) return;
    CHECK(s.position[1] < plan.bed_at(s.position[0]) + 1e-9);
    ++under;
  });
  CHECK(under > 2 * 40);
  CHECK(plan.bed_at(2.5) == Approx(-0.3));
  CHECK(plan.bed_at(-1.0) == -1.0);
}

TEST_CASE("sides that repeat have no walls and the domain's exact length", "[sea][sph][fast]") {
  TankPlan plan = tank(2.0, 1.0, 0.5);
  plan.periodic = {true, true};
  Parameters p = particles(0.1, 0.5);
  const auto t = lay_out<3>(plan, p);
  for_owner(t, wall_owner, [&](const Seed<3>& s) { CHECK(s.position[2] < -0.5); });
  CHECK(t.domain.periodic[0]);
  CHECK(t.domain.high[0] - t.domain.low[0] == 2.0);
  CHECK(t.domain.high[1] - t.domain.low[1] == 1.0);
}

TEST_CASE("a union of shapes displaces its volume, and water leaves it room", "[sea][sph][fast]") {
  const double d = 0.1;
  const std::vector<BodyShape> shapes{Cylinder{.start = {0, 0, -1}, .end = {0, 0, 1}, .start_radius = 0.5, .end_radius = 0.5},
                                      Box{.centre = {0.9, 0, 0}, .size = {1.2, 0.4, 0.4}}};
  TankPlan plan = tank(6.0, 4.0, 3.0);
  plan.bodies = {{"buoy", shapes, Motion{.position = {3.0, 2.0, -1.0}}}};
  Parameters p = particles(d, 3.0);
  const auto t = lay_out<3>(plan, p);
  // The box of 0.192 m3 reaches 0.2 m into the cylinder along its axis; its cross-section there is nearly inside it as a whole.
  const double overlap =
      0.4 * 0.4 * 0.2 - 0.4 * (0.5 * 0.5 * std::asin(0.4) - 0.2 * std::sqrt(0.21) - 0.4 * (0.5 - std::sqrt(0.21)));
  const double volume = pi * 0.25 * 2.0 + 0.192 - overlap;
  CHECK(double(t.body_points[0].size()) * d * d * d * t.cell_volume == Approx(volume).epsilon(0.02));
  for_owner(t, water_owner, [&](const Seed<3>& s) {
    const Eigen::Vector3d x(s.position[0] - 3.0, s.position[1] - 2.0, s.position[2] + 1.0);
    CHECK(signed_distance(shapes, x, Cut::space) > 0.0);  // nearest in the corner between the two shapes
  });
  const double cell = d * d * d * t.cell_volume, wet = pi * 0.25 * 2.0 + 0.192 - overlap;
  CHECK(double(60 * 40 * 30) - double(t.water) == Approx(wet / cell).epsilon(0.01));  // all of it is under water
}

TEST_CASE("shapes that overlap have the particles of their union wherever the boundary cuts their layers", "[sea][sph][fast]") {
  const double d = GENERATE(0.08, 0.1, 0.11, 0.125, 0.14, 0.2);
  CAPTURE(d);
  // A column through a pontoon.
  const std::vector<BodyShape> pontoon{Box{.centre = {0, 0, -0.7}, .size = {2.4, 2.0, 0.8}},
                                       Box{.centre = {0, 0, -0.3}, .size = {1.6, 1.6, 1.6}}};
  const Points both = fill_body(pontoon, d, Cut::space);
  const double column = double(fill_shape(pontoon[1], d, Cut::space).size()),
               base = double(fill_shape(pontoon[0], d, Cut::space).size());
  // Of the column's 1.6 m half is in the pontoon.
  CHECK(double(both.size()) == Approx(base + 0.5 * column).margin(1.0));
  for (std::size_t n = 0; n < both.size(); ++n) CHECK(signed_distance(pontoon, both[n], Cut::space) < 0.0);
  // Flush shapes lose nothing.
  const std::vector<BodyShape> flush{Box{.centre = {0, 0, -0.7}, .size = {2.4, 2.0, 0.8}},
                                     Box{.centre = {0, 0, 0.1}, .size = {1.6, 1.6, 0.8}}};
  const auto alone = [&](std::size_t n) { return fill_shape(flush[n], d, Cut::space).size(); };
  CHECK(fill_body(flush, d, Cut::space).size() == alone(0) + alone(1));
}

TEST_CASE("water is fitted to a body: as much is missing as it displaces, and what is left stands evenly beside it",
          "[sea][sph][fast]") {
  const double d = 0.1, radius = 0.5, offset = GENERATE(0.0, 0.03, 0.05);
  TankPlan plan = tank(4.0, 0.0, 2.0);
  plan.bodies = {{"disc",
                  {Cylinder{.start = {0, -1, 0}, .end = {0, 1, 0}, .start_radius = radius, .end_radius = radius}},
                  Motion{.position = {2.0 + offset, 0.0, -1.0 + 0.7 * offset}}}};
  Parameters p = particles(d, 2.0);
  const auto t = lay_out<2>(plan, p);
  CHECK(40.0 * 20.0 - double(t.water) == Approx(pi * radius * radius / (d * d)).margin(0.51));
  const KernelWendland<2> kernel(1.5 * d);
  const std::vector<Seed<2>> seeds = t.seeds.all();
  for (const Seed<2>& i : seeds) {
    const double from = std::hypot(i.position[0] - 2.0 - offset, i.position[1] + 1.0 - 0.7 * offset);
    if (i.owner != water_owner || from > radius + 2.0 * d) continue;
    double concentration = 0.0;
    for (const Seed<2>& j : seeds) {
      const double x = i.position[0] - j.position[0], z = i.position[1] - j.position[1];
      concentration += d * d * kernel.value(std::max(x * x + z * z, 1e-30));
    }
    CHECK(concentration == Approx(1.0).margin(0.06));
    CHECK(i.deviation == Approx(p.eos.hydrostatic_deviation(-i.position[1], p.gravity)).epsilon(0.02));
  }
}

TEST_CASE("water is fitted to a body over sides that repeat as in the middle of the tank", "[sea][sph][fast]") {
  TankPlan plan = tank(3.0, 2.0, 1.0);
  plan.periodic = {true, true};
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.4}}, {}}};
  const auto laid_out = [&](double x, double y) {  // a whole number of places from the middle
    plan.bodies[0].motion.position = {x, y, -0.1};
    Parameters p = particles(0.1, 1.0);
    std::vector<std::array<double, 3>> water;
    for_owner(lay_out<3>(plan, p), water_owner, [&](const Seed<3>& seed) {
      water.push_back({std::remainder(seed.position[0] - x, 3.0), std::remainder(seed.position[1] - y, 2.0), seed.position[2]});
    });
    return water;
  };
  const auto middle = laid_out(1.537, 1.021);  // no two places are as far from the ball
  const auto [x, y] =
      GENERATE(std::pair{0.037, 1.021}, std::pair{2.637, 0.121}, std::pair{1.537, 1.621}, std::pair{2.937, 0.021});
  const auto beside = laid_out(x, y);
  REQUIRE(beside.size() == middle.size());
  double farthest = 0.0;
  for (const auto& a : beside) {
    if (std::hypot(a[0], a[1], a[2] + 0.1) > 0.8) continue;
    double nearest = 1e300;
    for (const auto& b : middle) nearest = std::min(nearest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    farthest = std::max(farthest, nearest);
  }
  CHECK(farthest < 1e-3);
}

TEST_CASE("seeds made anew are the same at every visit, water moved aside by bodies too", "[sea][sph][fast]") {
  TankPlan plan;
  plan.x = {-3.0, 3.0}, plan.depth = 2.0, plan.top = 1.0;
  plan.bodies = {{"ball", {Cylinder{.start = {0, -1, 0}, .end = {0, 1, 0}, .start_radius = 0.8, .end_radius = 0.8}}, Motion{}}};
  Parameters p = particles(0.1, 2.0);
  const auto t = lay_out<2>(plan, p);
  const std::vector<Seed<2>> once = t.seeds.all();
  REQUIRE(once.size() == t.seeds.size());
  CHECK(once.size() == t.water + t.walls + t.body_points.at(0).size());
  std::size_t next = 0, differing = 0, off_lattice = 0;
  t.seeds.for_each([&](std::size_t id, const Seed<2>& seed) {
    differing += id != next || seed.position != once[next].position || seed.deviation != once[next].deviation ||
                 seed.owner != once[next].owner;
    const double column = (seed.position[0] + 3.0) / 0.1 - 0.5;
    off_lattice += seed.owner == water_owner && std::abs(column - std::round(column)) > 1e-9;
    ++next;
  });
  CHECK(next == once.size());
  CHECK(differing == 0);
  CHECK(off_lattice > 50);  // moved aside by the body
}

TEST_CASE("water moved aside by a body has the same bits on any number of threads", "[sea][sph][fast]") {
  TankPlan plan = tank(3.0, 2.0, 1.0);
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.4}}, {}}};
  plan.bodies[0].motion.position = {1.5, 1.0, -0.1};
  const int threads = omp_get_max_threads();
  std::vector<std::vector<Seed<3>>> laid_out;
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    Parameters p = particles(0.1, 1.0);
    laid_out.push_back(lay_out<3>(plan, p).seeds.all());
  }
  omp_set_num_threads(threads);
  CHECK(std::ranges::equal(laid_out[0], laid_out[1], {}, &Seed<3>::position, &Seed<3>::position));
  CHECK(std::ranges::equal(laid_out[0], laid_out[1], {}, &Seed<3>::deviation, &Seed<3>::deviation));
}

namespace {

/// Every part by itself is that of the whole, in its box; parts are dealt out to ranks once each.
template <int dim>
void check_parts(const TankPlan& plan, Parameters p, std::size_t least_parts) {
  const auto t = lay_out<dim>(plan, p);
  const std::vector<Seed<dim>> whole = t.seeds.all();
  REQUIRE(whole.size() == t.seeds.size());
  std::size_t next = 0, parts = 0, differing = 0, outside = 0, ghosts = 0;
  t.seeds.for_each([](std::size_t, const Seed<dim>&) {},
                   [&](const SeedPart<dim>& part) {
                     CHECK(part.first == next);
                     t.seeds.for_each(
                         [&](std::size_t id, const Seed<dim>& seed) {
                           differing += id != next || seed.position != whole[next].position ||
                                        seed.deviation != whole[next].deviation || seed.velocity != whole[next].velocity ||
                                        seed.owner != whole[next].owner || seed.ghost != whole[next].ghost;
                           for (int k = 0; k < dim - 1; ++k)
                             outside += seed.position[k] < part.low[k] || seed.position[k] > part.high[k];
                           outside += seed.owner > part.largest_owner;
                           ghosts += !part.has_ghosts && seed.ghost != std::array<double, dim>{};
                           ++next;
                         },
                         [&](const SeedPart<dim>& other) { return other.first == part.first; });
                     CHECK(part.last == next);
                     ++parts;
                     return false;
                   });
  CHECK(next == whole.size());
  CHECK(parts >= least_parts);
  CHECK(differing == 0);
  CHECK(outside == 0);
  CHECK(ghosts == 0);
  for (const int ranks : {1, 5}) {
    std::vector<int> visits(whole.size(), 0);
    std::size_t most = 0;
    for (int rank = 0; rank < ranks; ++rank) {
      std::size_t mine = 0;
      t.seeds.for_each_of_rank(rank, ranks, [&](std::size_t id, const Seed<dim>&) { ++visits[id], ++mine; });
      most = std::max(most, mine);
    }
    CHECK(std::ranges::count(visits, 1) == std::ptrdiff_t(whole.size()));
    if (dim == 3) CHECK(double(most) < 1.3 * double(whole.size()) / ranks);
  }
  CHECK(t.seeds.owners() == 2 + int(plan.paddle.has_value()) + int(plan.bodies.size()));
}

}  // namespace

TEST_CASE("a tank is laid out in parts that each rank may visit by themselves", "[sea][sph][fast]") {
  TankPlan plan = tank(6.0, 4.0, 1.0);
  plan.y = {-2.0, 2.0};
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.4}}, {}}};
  plan.bodies[0].motion.position = {2.0, 0.0, 0.1};
  SECTION("with waves, a body and jitter") {
    plan.waves = {{.wave_number = 1.7, .angular_frequency = 4.0, .speed_amplitude = 0.3, .phase = 0.5, .direction = 0.3}};
    plan.jitter = 0.2;
    check_parts<3>(plan, particles(0.1, 1.0), 60);
    check_parts<2>(plan, particles(0.1, 1.0), 4);
  }
  SECTION("with modified walls, an obstacle and boxes of water") {
    plan.modified_walls = true;
    plan.water = {{{0.0, -2.0, -1.0}, {3.2, 2.0, 0.1}}, {{4.0, -1.5, -1.0}, {5.6, 1.5, -0.4}}};
    plan.obstacles = {{{4.5, -0.5, -1.0}, {5.3, 0.5, -0.2}}};
    check_parts<3>(plan, particles(0.1, 1.0), 60);
  }
  SECTION("with a slope and a paddle") {
    plan.bed = {{1.0, -1.0}, {6.0, 0.3}};
    plan.paddle = Paddle{.flap = true, .x = 0.0, .hinge = -0.6, .bed = -1.0}, plan.paddle_reach = 0.35;
    check_parts<3>(plan, particles(0.13, 1.0), 60);
    check_parts<2>(plan, particles(0.05, 1.0), 4);
  }
}

TEST_CASE("jitter moves the water alone, evenly within its bound, by seed and identity", "[sea][sph][fast]") {
  TankPlan plan;
  plan.x = {-3.0, 3.0}, plan.depth = 2.0, plan.top = 1.0;
  plan.bodies = {{"ball", {Cylinder{.start = {0, -1, 0}, .end = {0, 1, 0}, .start_radius = 0.8, .end_radius = 0.8}}, Motion{}}};
  const auto laid = [&plan](double jitter, std::uint64_t seed) {
    plan.jitter = jitter, plan.jitter_seed = seed;
    Parameters p = particles(0.1, 2.0);
    return lay_out<2>(plan, p).seeds.all();
  };
  const std::vector<Seed<2>> lattice = laid(0.0, 1), once = laid(0.1, 1), again = laid(0.1, 1), other = laid(0.1, 2);
  REQUIRE(once.size() == lattice.size());
  double sum = 0.0, squares = 0.0, largest = 0.0;
  std::size_t values = 0, moved_solids = 0, unlike = 0, alike = 0;
  for (std::size_t n = 0; n < once.size(); ++n) {
    unlike += once[n].position != again[n].position;
    const bool water = once[n].owner == water_owner;
    moved_solids += !water && once[n].position != lattice[n].position;
    if (!water) continue;
    alike += once[n].position == other[n].position;
    for (int k = 0; k < 2; ++k) {
      const double way = (once[n].position[k] - lattice[n].position[k]) / 0.01;  // of the bound
      sum += way, squares += way * way, largest = std::max(largest, std::abs(way)), ++values;
    }
  }
  CHECK(moved_solids == 0);
  CHECK(unlike == 0);
  CHECK(alike == 0);
  CHECK(largest <= 1.0 + 1e-9);
  CHECK(std::abs(sum / double(values)) < 0.05);
  CHECK(squares / double(values) == Approx(1.0 / 3.0).epsilon(0.1));
}

TEST_CASE("an obstacle is as thick as water feels it", "[sea][sph][fast]") {
  TankPlan plan = tank(4.0, 2.0, 1.0);
  plan.obstacles = {{{1.0, 0.5, -1.0}, {3.0, 1.5, 0.4}}};
  Parameters p = particles(0.1, 1.0);
  const auto hollow = lay_out<3>(plan, p);
  int core = 0;
  for_owner(hollow, wall_owner, [&](const Seed<3>& s) {
    const auto& x = s.position;
    core += x[0] > 1.2 && x[0] < 2.8 && x[1] > 0.7 && x[1] < 1.3 && x[2] > -0.8 && x[2] < 0.2;
  });
  CHECK(core == 0);
  plan.obstacles.clear();
  CHECK(hollow.walls - lay_out<3>(plan, p).walls == 20 * 10 * 14 - 16 * 6 * 10);
}

TEST_CASE("the static draft of a discrete body is Archimedes' within a hundredth of its height, to round-off for a box",
          "[sea][sph][fast]") {
  const auto rise = [](const BodyShape& shape, double height, double share) {
    const double d = 0.1;
    const std::vector<BodyShape> shapes{shape};
    const Points points = fill_body(shapes, d, Cut::space);
    const Motion start{.position = {0.0, 0.0, height}};
    return rise_to_float(points, start, d * d * d, d, share * volume_of(shape, Cut::space));
  };
  for (double share : {0.1, 0.5, 0.9}) {
    CHECK(rise(Box{.centre = {0, 0, 0}, .size = {1.0, 0.7, 0.6}}, 0.02, share).value() ==
          Approx(0.3 - 0.6 * share - 0.02).margin(1e-9));
    const Cylinder upright{.start = {0, 0, -1}, .end = {0, 0, 1}, .start_radius = 0.55, .end_radius = 0.55};
    CHECK(rise(upright, 0.0, share).value() == Approx(1.0 - 2.0 * share).margin(0.02));
  }
  CHECK(rise(Sphere{.centre = {0, 0, 0}, .radius = 0.5}, 0.3, 0.5).value() == Approx(-0.3).margin(0.01));
  CHECK_FALSE(rise(Box{.centre = {0, 0, 0}, .size = {1.0, 0.7, 0.6}}, 0.0, 1.1).has_value());
}

TEST_CASE("in a 2-D scene a cylinder across the plane is a disc and one in it a rectangle", "[sea][sph][fast]") {
  const Cylinder across{.start = {0, -1, 0}, .end = {0, 1, 0}, .start_radius = 0.5, .end_radius = 0.5};
  const Cylinder upright{.start = {0, 0, -1}, .end = {0, 0, 1}, .start_radius = 0.5, .end_radius = 0.5};
  CHECK(double(fill_shape(across, 0.05, Cut::plane).size()) * 0.0025 == Approx(pi * 0.25).epsilon(0.005));
  CHECK(double(fill_shape(upright, 0.05, Cut::plane).size()) * 0.0025 == Approx(2.0).epsilon(1e-12));
  CHECK(signed_distance(BodyShape(across), {0.3, 5.0, 0.4}, Cut::plane) == Approx(0.0).margin(1e-12));
  CHECK(signed_distance(BodyShape(upright), {0.6, 3.0, 0.0}, Cut::plane) == Approx(0.1));
  CHECK(volume_of(BodyShape(across), Cut::plane) == Approx(pi * 0.25));
}

TEST_CASE("water that starts in a wave follows its surface and its velocity", "[sea][sph][fast]") {
  TankPlan plan = tank(10.0, 0.0, 2.0);
  plan.periodic = {true, false};
  const double k = 2.0 * pi / 10.0, omega = std::sqrt(9.81 * k * std::tanh(k * 2.0)), a = 0.1;
  plan.waves = {{.wave_number = k,
                 .angular_frequency = omega,
                 .amplitude = a,
                 .speed_amplitude = a * omega,
                 .phase = 0.0,
                 .direction = 0.0}};
  Parameters p = particles(0.1, 2.0);
  const auto t = lay_out<2>(plan, p);
  double crest = -1e9, trough_top = -1e9, fastest = 0.0;
  for_owner(t, water_owner, [&](const Seed<2>& s) {
    if (std::abs(s.position[0] - 10.0) < 0.1 || s.position[0] < 0.1) crest = std::max(crest, s.position[1]);
    if (std::abs(s.position[0] - 5.0) < 0.1) trough_top = std::max(trough_top, s.position[1]);
    fastest = std::max(fastest, s.velocity[0]);
    // Of where it is, not of where it was at rest; above still water in a straight line.
    const double under = k * (std::min(s.position[1], 0.0) + 2.0), over = k * std::max(s.position[1], 0.0),
                 psi = k * s.position[0];
    const double even = std::cosh(under) + over * std::sinh(under), odd = std::sinh(under) + over * std::cosh(under);
    CHECK(s.velocity[0] == Approx(a * omega * even / std::sinh(k * 2.0) * std::cos(psi)).margin(1e-12));
    CHECK(s.velocity[1] == Approx(a * omega * odd / std::sinh(k * 2.0) * std::sin(psi)).margin(1e-12));
  });
  CHECK(crest - trough_top == Approx(2.0 * a).epsilon(0.05));
  CHECK(fastest == Approx(a * omega * std::cosh(k * (2.0 + a)) / std::sinh(k * 2.0)).epsilon(0.05));
}

TEST_CASE("water that starts in a wave has its pressure, at the bed and in the middle of the depth", "[sea][sph][fast]") {
  constexpr double depth = 2.0, length = 10.0, a = 0.02, k = 2.0 * pi / length;
  TankPlan plan = tank(length, 0.0, depth);
  plan.periodic = {true, false};
  const double omega = std::sqrt(9.81 * k * std::tanh(k * depth));
  plan.waves = {{.wave_number = k, .angular_frequency = omega, .amplitude = a, .speed_amplitude = a * omega, .phase = 0.7}};
  Parameters p = particles(0.1, depth);
  const auto t = lay_out<2>(plan, p);
  const double highest = p.eos.rho0 * p.gravity * a;
  int at_bed = 0, in_middle = 0;
  for (const Seed<2>& s : t.seeds.all()) {
    const double z = s.position[1], share = std::cosh(k * std::max(z + depth, 0.0)) / std::cosh(k * depth);
    const bool water = s.owner == water_owner, bed = water && z < 0.1 - depth, middle = water && std::abs(z + 0.5 * depth) < 0.1;
    if (!bed && !middle && (water || z > -depth)) continue;
    at_bed += bed, in_middle += middle;
    const double over_rest = p.eos.pressure(s.deviation) - p.eos.pressure(p.eos.hydrostatic_deviation(-z, p.gravity));
    CAPTURE(s.position[0], z);
    CHECK(over_rest == Approx(highest * share * std::cos(k * s.position[0] + 0.7)).margin(0.02 * highest));
  }
  CHECK(at_bed == 100);
  CHECK(in_middle >= 100);
}

namespace {

/// Of the line through the uppermost particles of a 2-D sea between sides that repeat, over its height at rest [m].
double mean_of_surface(const TankPlan& plan) {
  Parameters p = particles(0.1, plan.depth);
  TankPlan still = plan;
  still.waves.clear();
  const auto rest = lay_out<2>(still, p).seeds.all(), moved = lay_out<2>(plan, p).seeds.all();
  double highest = -1e9, area = 0.0;
  for (const Seed<2>& s : rest)
    if (s.owner == water_owner) highest = std::max(highest, s.position[1]);
  std::vector<std::array<double, 2>> line;
  for (std::size_t n = 0; n < rest.size(); ++n)
    if (rest[n].owner == water_owner && rest[n].position[1] > highest - 1e-6) line.push_back(moved[n].position);
  const double length = plan.x[1] - plan.x[0];
  line.push_back({line.front()[0] + length, line.front()[1]});
  for (std::size_t n = 1; n < line.size(); ++n) area += 0.5 * (line[n][1] + line[n - 1][1]) * (line[n][0] - line[n - 1][0]);
  return area / length - highest;
}

}  // namespace

TEST_CASE("the mean level of water that starts in waves is that of rest to third order", "[sea][sph][fast]") {
  constexpr double depth = 1.5, length = 10.0, a = 0.2, k = 2.0 * pi / length;
  TankPlan plan = tank(length, 0.0, depth);
  plan.periodic = {true, false};
  const waves::Component wave{.wave_number = k,
                              .angular_frequency = std::sqrt(9.81 * k * std::tanh(k * depth)),
                              .amplitude = a,
                              .speed_amplitude = a * std::sqrt(9.81 * k * std::tanh(k * depth))};
  SECTION("a Stokes wave") { plan.waves = {wave, waves::stokes_second(wave, depth)}; }
  SECTION("a standing wave at its highest and half way to level water") {
    const double phase = GENERATE(0.0, 1.0);
    plan.waves = {wave, wave};
    plan.waves[0].phase = phase, plan.waves[1].phase = phase, plan.waves[1].direction = pi;
    for (waves::Component& c : plan.waves) c.amplitude *= 0.5, c.speed_amplitude *= 0.5;
  }
  const double mean = mean_of_surface(plan);
  CHECK(std::abs(mean) < k * k * a * a * a);  // before second order: k a^2 coth(k h) / 2, 0.017 m
}

TEST_CASE("between walls a wave brings in as much water as it takes out, whatever its phase", "[sea][sph][fast]") {
  const double phase = GENERATE(0.0, 0.5 * pi, pi, 4.0);
  TankPlan plan = tank(10.0, 0.0, 2.0);
  Parameters p = particles(0.1, 2.0);
  const auto still = lay_out<2>(plan, p).water;
  const double k = 2.0 * pi / 10.0, omega = std::sqrt(9.81 * k * std::tanh(k * 2.0)), a = 0.3;
  plan.waves = {{.wave_number = k, .angular_frequency = omega, .amplitude = a, .speed_amplitude = a * omega, .phase = phase}};
  CHECK(double(lay_out<2>(plan, p).water) == Approx(double(still)).epsilon(0.003));
}

TEST_CASE("ghost nodes of modified walls lie in the water, as far from the face as their particle", "[sea][sph][fast]") {
  TankPlan plan = tank(2.0, 1.0, 1.0);
  plan.modified_walls = true;
  plan.obstacles.push_back({{0.8, 0.4, -1.0}, {1.2, 0.6, 0.3}});
  Motion motion;
  motion.position = {1.5, 0.5, -0.3};
  motion.attitude = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  plan.bodies.push_back({"ball", {Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.2}}, motion});
  Parameters p = particles(0.05, 1.0);
  const auto t = lay_out<3>(plan, p);
  int tank_nodes = 0, obstacle_nodes = 0, body_nodes = 0;
  for (const Seed<3>& seed : t.seeds.all()) {
    if (seed.owner == water_owner) {
      CHECK(seed.ghost == std::array<double, 3>{});
      continue;
    }
    std::array<double, 3> node;
    double length = 0.0;
    for (int k = 0; k < 3; ++k) node[k] = seed.position[k] + seed.ghost[k], length += seed.ghost[k] * seed.ghost[k];
    length = std::sqrt(length);
    if (seed.owner == t.bodies[0]) {
      const double from = (Eigen::Vector3d(node[0], node[1], node[2]) - motion.position).norm();
      const double at = (to_earth<3>(seed.position) - motion.position).norm();
      if (at < 0.2 - 2.0 * 0.05) continue;  // too deep for water to see
      CHECK(0.5 * (from + at) == Approx(0.2).epsilon(1e-6));
      CHECK(length == Approx(from - at).epsilon(1e-6));
      ++body_nodes;
      continue;
    }
    const bool obstacle = seed.position[0] > 0.0 && seed.position[0] < 2.0 && seed.position[1] > 0.0 && seed.position[1] < 1.0 &&
                          seed.position[2] > -1.0;
    ++(obstacle ? obstacle_nodes : tank_nodes);
    if (obstacle) CHECK_FALSE((node[0] > 0.8 && node[0] < 1.2 && node[1] > 0.4 && node[1] < 0.6 && node[2] < 0.3));
    const bool inside = node[0] > 0.0 && node[0] < 2.0 && node[1] > 0.0 && node[1] < 1.0 && node[2] > -1.0;
    CHECK(inside);
    CHECK(length > 0.0);
  }
  CHECK(tank_nodes > 1000);
  CHECK(obstacle_nodes > 100);
  CHECK(body_nodes > 100);
}

namespace {

/// Counted and laid out, of each kind: walls without bodies.
template <int dim>
void check_count(const TankPlan& plan, Parameters p, double of_water, double of_walls) {
  const TankCount counted = count_tank<dim>(plan, p);
  const auto t = lay_out<dim>(plan, p);
  double walls = double(t.seeds.size() - t.water);
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    walls -= double(t.body_points[b].size());
    CHECK(counted.bodies[b].particles == Approx(double(t.body_points[b].size())).epsilon(0.01));
  }
  CHECK(counted.water == Approx(double(t.water)).epsilon(of_water));
  CHECK(counted.walls == Approx(walls).epsilon(of_walls));
  CHECK(counted.mass_factor == Approx(p.mass_factor).epsilon(1e-12));
}

}  // namespace

TEST_CASE("a tank of boxes, a slope or a paddle is counted to the particle without laying it out", "[sea][sph][fast]") {
  const double spacing = GENERATE(0.1, 0.13);
  const Parameters p = particles(spacing, 1.0);
  TankPlan plan = tank(4.0, 1.0, 1.0);
  check_count<3>(plan, p, 0.0, 0.0);
  plan.open = {true, false}, plan.periodic = {false, true};
  check_count<3>(plan, p, 0.0, 0.0);
  plan.open = plan.periodic = {};
  plan.bed = {{1.0, -1.0}, {4.0, 0.3}};
  check_count<2>(plan, p, 0.0, 0.0);
  check_count<3>(plan, p, 0.0, 0.0);
  plan.paddle = Paddle{.flap = true, .x = 0.0, .hinge = -0.6, .bed = -1.0}, plan.paddle_reach = 0.35;
  check_count<2>(plan, p, 0.0, 0.0);
  check_count<3>(plan, p, 0.0, 0.0);
}

TEST_CASE("boxes of water and obstacles are counted to the particle", "[sea][sph][fast]") {
  TankPlan plan = tank(4.0, 2.0, 1.0);
  plan.water = {{{0.0, 0.0, -1.0}, {1.2, 2.0, 0.1}}, {{3.0, 0.5, -1.0}, {3.6, 1.5, -0.4}}};
  plan.obstacles = {{{0.5, 0.5, -1.0}, {3.3, 1.5, -0.2}}};
  check_count<2>(plan, particles(0.1, 1.0), 0.0, 0.0);
  check_count<3>(plan, particles(0.1, 1.0), 0.0, 0.0);
}

TEST_CASE("water round bodies and surfaces is counted within a hundredth, their walls within a tenth", "[sea][sph][fast]") {
  TankPlan plan = tank(3.0, 2.0, 1.0);
  const Parameters p = particles(0.06, 1.0);
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.4}}, {}},
                 {"box", {Box{Eigen::Vector3d::Zero(), {0.5, 0.6, 0.7}}, Sphere{{0.2, 0.0, 0.3}, 0.3}}, {}}};
  plan.bodies[0].motion.position = {0.8, 1.0, 0.1}, plan.bodies[1].motion.position = {2.2, 1.0, -0.1};
  check_count<3>(plan, p, 0.01, 0.0);
}

TEST_CASE("a lattice of 1e12 places is counted in a moment", "[sea][sph][fast]") {
  const Parameters p = particles(2e-4, 1.0);
  const TankPlan plan = tank(4.0, 2.0, 1.0);
  const TankCount counted = count_tank<3>(plan, p);
  CHECK(counted.water == Approx(1e12).epsilon(1e-6));
  // Two layers: the bed with its margin, and the sides up to the top.
  CHECK(counted.walls == Approx(2.0 * (20000.0 * 10000.0 + 60000.0 * 7500.0)).epsilon(1e-3));
  CHECK(lattice_places<3>(plan, p) == Approx(1.5e12).epsilon(0.01));
}

TEST_CASE("beside a plane of symmetry half a tank has half the particles, no wall and half its bodies", "[sea][sph][fast]") {
  TankPlan plan = tank(3.0, 2.0, 1.0), half = plan;
  Parameters p = particles(0.1, 1.0), of_half = p;
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.4}}, {}}};
  plan.bodies[0].motion.position = {1.5, 1.0, -0.1};
  half.bodies = plan.bodies, half.y = {1.0, 2.0}, half.mirrored = true;
  check_count<3>(half, p, 0.01, 0.0);
  const auto whole = lay_out<3>(plan, p), t = lay_out<3>(half, of_half);
  CHECK(2.0 * double(t.water) == Approx(double(whole.water)).margin(2.0));
  CHECK(2 * t.walls == whole.walls);
  CHECK(2.0 * double(t.body_points[0].size()) == Approx(double(whole.body_points[0].size())).margin(2.0));
  CHECK(of_half.mass_factor == p.mass_factor);
  CHECK(t.domain.mirrored);
  CHECK(t.domain.low[1] == 1.0);
  for (const Seed<3>& seed : t.seeds.all()) REQUIRE(seed.position[1] > 1.0);
  // The water beside the body stands as evenly as away from the plane: images push too.
  const KernelWendland<3> kernel(1.5 * 0.1);
  std::vector<std::array<double, 3>> all;
  for (const Seed<3>& seed : t.seeds.all())
    all.push_back(seed.position), all.push_back({seed.position[0], 2.0 - seed.position[1], seed.position[2]});
  double least = 1e300, most = 0.0;
  for_owner(t, water_owner, [&](const Seed<3>& seed) {
    const auto& x = seed.position;
    if (std::hypot(x[0] - 1.5, x[2] + 0.1) > 0.7 || x[1] > 1.2 || x[2] > -0.4) return;
    double sum = 0.0;
    for (const auto& y : all) {
      const double r2 = std::pow(x[0] - y[0], 2) + std::pow(x[1] - y[1], 2) + std::pow(x[2] - y[2], 2);
      if (r2 < std::pow(2.0 * kernel.h(), 2)) sum += 1e-3 * kernel.value(r2);
    }
    least = std::min(least, sum), most = std::max(most, sum);
  });
  CHECK(least > 0.93);
  CHECK(most < 1.07);
}
