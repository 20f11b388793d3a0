// Filters and shifting as sweeps: a uniform or linear density is kept, disorder shrinks, and Verlet's step goes where the
// symplectic one goes.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

constexpr double spacing = 0.1;

/// One step of no length and then the filter, which sees the density of the seeds.
template <int dim, class Real>
std::vector<double> filtered(FilterChoice filter, const std::vector<Seed<dim>>& seeds) {
  Parameters p;
  p.spacing = spacing, p.h_over_d = 1.5, p.filter = filter, p.filter_every = 1;
  SeaSph<dim, Real> sea(p, domain_around<dim>({}, 4.0), seeds);
  sea.step(1e-12);
  return by_identity(sea.store(), seeds.size(), [&](std::size_t slot) { return sea.store().deviation[slot]; });
}

template <int dim>
std::vector<Seed<dim>> linear_block(std::array<int, dim> cells) {
  auto seeds = disordered_block<dim>(spacing, cells, {}, true);
  for (auto& seed : seeds) seed.velocity = {}, seed.deviation = 20.0 - 5.0 * seed.position[0] - 4.0 * seed.position[dim - 1];
  return seeds;
}

template <int dim>
double worst_change(const std::vector<Seed<dim>>& seeds, const std::vector<double>& after) {
  double worst = 0.0;
  for (std::size_t n = 0; n < seeds.size(); ++n)
    if (seeds[n].owner == 0) worst = std::max(worst, std::abs(after[n] - seeds[n].deviation));
  return worst;
}

}  // namespace

TEST_CASE("the MLS sweep keeps a linear density, the Shepard sweep a constant one, up to the surface", "[sph][fast]") {
  auto seeds2 = linear_block<2>({20, 14});
  auto seeds3 = linear_block<3>({9, 8, 7});
  CHECK(worst_change(seeds2, filtered<2, double>(FilterChoice::mls, seeds2)) < 1e-8);
  CHECK(worst_change(seeds3, filtered<3, double>(FilterChoice::mls, seeds3)) < 1e-8);
  CHECK(worst_change(seeds3, filtered<3, float>(FilterChoice::mls, seeds3)) < 1e-3);
  CHECK(worst_change(seeds3, filtered<3, double>(FilterChoice::shepard, seeds3)) > 0.05);
  for (auto& seed : seeds3) seed.deviation = 7.0;
  CHECK(worst_change(seeds3, filtered<3, double>(FilterChoice::shepard, seeds3)) < 1e-8);
  CHECK(worst_change(seeds3, filtered<3, float>(FilterChoice::shepard, seeds3)) < 1e-5);
}

TEST_CASE("shifting evens out disorder inside the water", "[sph][fast]") {
  Parameters p;
  p.spacing = spacing, p.gravity = 0.0, p.eos.c0 = 20.0, p.h_over_d = 1.5;
  auto seeds = disordered_block<2>(spacing, {30, 30}, {0, 0}, false);
  for (auto& seed : seeds) seed.velocity = {1.0, 0.0}, seed.deviation = 0.0;
  const auto disorder = [&](double shifting) {  // spread of the nearest-partner distance in the middle
    p.shifting = shifting;
    SeaSph<2, double> sea(p, Domain<2>{{-3, -3}, {9, 9}}, seeds);
    for (int n = 0; n < 150; ++n) sea.step(1.0);
    const auto x = by_identity(sea.store(), seeds.size(), [&](std::size_t s) {
      return std::array<double, 2>{sea.store().x[0][s], sea.store().x[1][s]};
    });
    double nearest_sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::abs(seeds[i].position[0] - 1.5) > 0.9 || std::abs(seeds[i].position[1] - 1.5) > 0.9) continue;
      double nearest = 1e300;
      for (std::size_t j = 0; j < x.size(); ++j)
        if (j != i) nearest = std::min(nearest, std::hypot(x[i][0] - x[j][0], x[i][1] - x[j][1]));
      nearest_sum += nearest, ++count;
    }
    return nearest_sum / count;
  };
  CHECK(disorder(4.0) > 1.05 * disorder(0.0));
}

TEST_CASE("Verlet's step and the symplectic one agree better the smaller the step", "[sph][fast]") {
  auto seeds = disordered_block<2>(spacing, {12, 12}, {0, 0}, false);
  for (auto& seed : seeds)
    for (double& v : seed.velocity) v *= 0.05;
  for (auto& seed : seeds) seed.deviation = 0.0;
  const auto end = [&](StepChoice step, double dt) {
    Parameters p;
    p.spacing = spacing, p.h_over_d = 1.5, p.step = step;
    SeaSph<2, double> sea(p, Domain<2>{{-2, -2}, {4, 4}}, seeds);
    for (int n = 0; n < int(std::lround(0.02 / dt)); ++n) sea.step(dt);
    CHECK(sea.time() == Approx(0.02));
    return by_identity(sea.store(), seeds.size(), [&](std::size_t s) { return sea.store().x[1][s]; });
  };
  const auto difference = [&](double dt) {
    const auto a = end(StepChoice::verlet, dt), b = end(StepChoice::symplectic, dt);
    double worst = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) worst = std::max(worst, std::abs(a[n] - b[n]));
    return worst;
  };
  const double coarse = difference(4e-4), fine = difference(1e-4);
  CHECK(coarse < 1e-3 * spacing);
  CHECK(fine < 0.5 * coarse);
}
