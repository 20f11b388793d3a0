// Modified and extrapolated boundaries as sweeps: a wall takes on the linear field of the water beside it, whatever the columns
// and periodic sides between them.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/boundary.hpp"

#include <catch2/catch.hpp>

#include <random>

#include "kernels/base/constants.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double d = 0.1;
constexpr int layers = 4;

/// A basin of water, disordered, with a linear density and uniform velocity, inside modified walls on all sides but the top.
template <int dim>
std::vector<Seed<dim>> basin(std::array<int, dim> cells, std::array<bool, dim> periodic) {
  std::vector<Seed<dim>> seeds;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> displacement(-0.15 * d, 0.15 * d);
  std::array<double, dim> low{}, high;
  std::array<int, dim> first{}, last;
  for (int k = 0; k < dim; ++k) {
    high[k] = cells[k] * d, first[k] = periodic[k] ? 0 : -layers, last[k] = cells[k] + (periodic[k] || k == dim - 1 ? 0 : layers);
  }
  for_lattice<dim>(first, last, [&](const std::array<int, dim>& at) {
    Seed<dim> seed;
    bool water = true;
    for (int k = 0; k < dim; ++k) {
      seed.position[k] = (at[k] + 0.5) * d;
      water = water && at[k] >= 0 && at[k] < cells[k];
    }
    if (water)
      for (int k = 0; k < dim; ++k) seed.position[k] += displacement(random), seed.velocity[k] = k + 1.0;
    seed.owner = water ? 0 : 1;
    seed.deviation = water ? 3.0 + 2.0 * seed.position[dim - 1] + (periodic[0] ? 0.0 : seed.position[0]) : 0.0;
    if (!water) seed.ghost = mirror_in_box<dim>(seed.position, low, high);
    seeds.push_back(seed);
  });
  return seeds;
}

}  // namespace

TEMPLATE_TEST_CASE("modified walls continue a linear density across columns", "[sph][fast]", float, double) {
  Parameters p;
  p.spacing = d, p.h_over_d = 1.5, p.gravity = 0.0;
  const double tolerance = std::is_same_v<TestType, float> ? 2e-3 : 1e-9;
  const auto seeds = basin<2>({30, 12}, {});
  SeaSph<2, TestType> sea(p, Domain<2>{{-1, -1}, {4, 4}}, seeds);
  sea.evaluate();
  const auto after = by_identity(sea.store(), seeds.size(), [&](std::size_t slot) { return sea.store().deviation[slot]; });
  double worst = 0.0;
  for (std::size_t n = 0; n < seeds.size(); ++n)
    if (seeds[n].position[1] < 1.0)
      worst = std::max(worst, std::abs(after[n] - (3.0 + 2.0 * seeds[n].position[1] + seeds[n].position[0])));
  CHECK(worst < tolerance);

  const auto seeds3 = basin<3>({22, 9, 8}, {true, false, false});
  SeaSph<3, TestType> sea3(p, Domain<3>{{0, -1, -1}, {2.2, 2, 2}, {true, false, false}}, seeds3);
  sea3.evaluate();
  const auto after3 = by_identity(sea3.store(), seeds3.size(), [&](std::size_t slot) { return sea3.store().deviation[slot]; });
  worst = 0.0;
  for (std::size_t n = 0; n < seeds3.size(); ++n)
    if (seeds3[n].position[2] < 0.6) worst = std::max(worst, std::abs(after3[n] - (3.0 + 2.0 * seeds3[n].position[2])));
  CHECK(worst < tolerance);
}

TEMPLATE_TEST_CASE("extrapolated walls have the pressure of rest at their depth", "[sph][fast]", float, double) {
  Parameters p;
  p.spacing = d, p.h_over_d = 1.5, p.boundary = BoundaryChoice::extrapolated, p.eos.c0 = 30.0;
  const double tolerance = std::is_same_v<TestType, float> ? 2e-5 : 2e-6;  // of the greatest pressure
  const auto check = [&](auto dimension, auto cells, auto periodic, const auto& domain) {
    constexpr int dim = decltype(dimension)::value;
    const double surface = cells[dim - 1] * d, greatest = p.eos.rho0 * p.gravity * surface;
    auto seeds = basin<dim>(cells, periodic);
    for (auto& seed : seeds) {
      seed.ghost = {};
      if (seed.owner == 0) seed.deviation = p.eos.deviation(p.eos.rho0 * p.gravity * (surface - seed.position[dim - 1]));
    }
    SeaSph<dim, TestType> sea(p, domain, seeds);
    sea.evaluate();
    const auto after = by_identity(sea.store(), seeds.size(), [&](std::size_t slot) { return sea.store().deviation[slot]; });
    double worst = 0.0;
    int wet = 0;
    for (std::size_t n = 0; n < seeds.size(); ++n) {
      double outside = 0.0;  // of the water, beyond which no particle sees it
      for (int k = 0; k < dim; ++k)
        if (!periodic[k]) outside += std::pow(std::max({0.0, -seeds[n].position[k], seeds[n].position[k] - cells[k] * d}), 2);
      const double z = seeds[n].position[dim - 1];
      if (seeds[n].owner == 0 || outside > d * d || z > surface - 0.3) continue;
      // Carried on by the density of the water, which is up to 1 % above rho0.
      worst = std::max(worst, std::abs(p.eos.pressure(after[n]) - p.eos.rho0 * p.gravity * (surface - z)) / greatest), ++wet;
    }
    CHECK(wet > 20);
    CHECK(worst < tolerance + 0.01 * 2.0 * d / surface);
  };
  check(std::integral_constant<int, 2>{}, std::array<int, 2>{30, 12}, std::array<bool, 2>{}, Domain<2>{{-1, -1}, {4, 4}});
  check(std::integral_constant<int, 3>{}, std::array<int, 3>{22, 9, 8}, std::array<bool, 3>{true, false, false},
        Domain<3>{{0, -1, -1}, {2.2, 2, 2}, {true, false, false}});
}

TEST_CASE("ghost nodes turn with their body, and its walls mirror the velocity of the water", "[sph][fast]") {
  Parameters p;
  p.spacing = d, p.h_over_d = 1.5, p.gravity = 0.0;
  const WallChoice wall = GENERATE(WallChoice::still, WallChoice::no_slip, WallChoice::free_slip);
  p.wall = wall;
  std::vector<Seed<2>> seeds;
  for_lattice<2>({0, 0}, {16, 16}, [&](const std::array<int, 2>& at) {
    seeds.push_back({.position = {(at[0] + 0.5) * d, (at[1] + 0.5) * d}, .velocity = {1.0, 2.0}});
  });
  seeds.push_back({.position = {0.85, 1.65}, .owner = 1, .ghost = {0.0, -0.1}});  // over the top of the block
  SeaSph<2, double> sea(p, Domain<2>{{-1, -1}, {4, 4}}, seeds);
  Motion motion;
  motion.position = {0.8, 0.0, 0.8};  // the middle of the block
  sea.add_body(1, motion);
  motion.attitude = Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitY());  // z to x: now beside the right face
  motion.velocity = {0.25, 0.0, 0.0};
  place_body(sea.state(), 1, motion);
  sea.evaluate();
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
    if (sea.store().owner[slot / cluster_size] != 1 || sea.store().id[slot] == no_particle) continue;
    CHECK(sea.store().x[0][slot] == Approx(1.65));
    const double* planes = sea.store().pack_of(slot / cluster_size) + slot % cluster_size;
    const double normal = planes[2 * cluster_size], along = planes[3 * cluster_size];
    CHECK(normal == Approx(wall == WallChoice::still ? 0.25 : 2.0 * 0.25 - 1.0));
    CHECK(along == Approx(wall == WallChoice::still ? 0.0 : wall == WallChoice::no_slip ? -2.0 : 2.0).margin(1e-12));
  }
}
