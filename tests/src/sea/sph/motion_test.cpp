// Exact motions that a sea of particles must reproduce, and energy behaviour without walls.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

/// Water at rest on a lattice with zero pressure.
template <int dim>
std::vector<Seed<dim>> still_block(double d, std::array<int, dim> cells, std::array<double, dim> velocity) {
  auto seeds = disordered_block<dim>(d, cells, {}, false);
  for (auto& seed : seeds) seed.velocity = velocity, seed.deviation = 0.0;
  return seeds;
}

}  // namespace

TEMPLATE_TEST_CASE("a block without pressure drifts and falls as one point, exactly", "[sph][fast]", float, double) {
  Parameters p;
  p.spacing = 0.1, p.eos = {1000.0, 20.0};
  const std::array<double, 3> drift{1.5, -0.7, 2.0};
  const auto seeds = still_block<3>(p.spacing, {9, 8, 7}, drift);
  SeaSph<3, TestType> sea(p, Domain<3>{{-5, -5, -5}, {5, 5, 5}}, seeds);
  sea.advance(0.5);
  CHECK(sea.state().work.sorts > 5);
  const double t = sea.time(), fall = -0.5 * p.gravity * t * t;
  CHECK(t == Approx(0.5).epsilon(1e-14));
  double worst = 0.0;
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
    if (sea.store().id[slot] == no_particle) continue;
    const auto& start = seeds[sea.store().id[slot]].position;
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(sea.store().x[k][slot] - start[k] - drift[k] * t - (k == 2 ? fall : 0.0)));
  }
  CHECK(worst < 1e-12);
  CHECK(sea.store().lost.empty());
}

TEST_CASE("momentum of a bursting block stays to round-off of its pairs", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.eos = {1000.0, 20.0}, p.gravity = 0.0;
  auto seeds = disordered_block<2>(p.spacing, {20, 20}, {0, 0}, false);
  SeaSph<2, double> sea(p, Domain<2>{{-20, -20}, {20, 20}}, seeds);
  const auto momentum = [&] {
    std::array<double, 3> m{};
    for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
      if (sea.store().id[slot] == no_particle) continue;
      for (int k = 0; k < 2; ++k) m[k] += sea.store().v[k][slot], m[2] += std::abs(sea.store().v[k][slot]);
    }
    return m;
  };
  const auto before = momentum();
  for (int n = 0; n < 200; ++n) sea.step(1.0);
  const auto after = momentum();
  for (int k = 0; k < 2; ++k) CHECK(std::abs(after[k] - before[k]) < 1e-13 * after[2] * 200);
}

TEST_CASE("steps end exactly at the time asked for", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.1, p.eos = {1000.0, 20.0};
  SeaSph<2, float> sea(p, Domain<2>{{-5, -5}, {5, 5}}, still_block<2>(p.spacing, {8, 8}, {}));
  for (int n = 0; n < 4; ++n) sea.advance(0.01);
  CHECK(sea.time() == Approx(0.04).epsilon(1e-14));
  CHECK(sea.state().work.steps >= 4);
}
