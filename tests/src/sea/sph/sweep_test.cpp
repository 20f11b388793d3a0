// The fast pair sweep against all pairs in double, and the laws of mechanics it must keep to round-off.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sweep_pairs.hpp"

#include <catch2/catch.hpp>

#include <omp.h>

#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "kernels/sph/viscosity_artificial.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

/// All pairs, in double, straight from the seeds: the obvious way.
template <class Kernel, class Diffusion>
auto all_pairs(const std::vector<Seed<Kernel::dimensions>>& seeds, const Parameters& p, const Diffusion& diffusion,
               const std::array<double, Kernel::dimensions>& period = {}) {
  constexpr int dim = Kernel::dimensions;
  const LawMotion<Kernel, ViscosityArtificial<>, Diffusion, double> water{
      Kernel(p.h()), {p.alpha, p.eos.c0, p.h()}, diffusion, p.eos.rho0};
  const LawMotion<Kernel, ViscosityArtificial<>, DensityDiffusionNone, double> solid{
      Kernel(p.h()), {p.alpha_solid, p.eos.c0, p.h()}, {}, p.eos.rho0};
  const auto state = [&](const Seed<dim>& seed) {
    PairState<double, dim> s;
    for (int k = 0; k < dim; ++k) s.x[k] = seed.position[k], s.v[k] = seed.velocity[k];
    s.deviation = seed.owner == 0 ? seed.deviation : std::max(seed.deviation, 0.0);
    const double rho = p.eos.rho0 + s.deviation;
    s.p_rho2 = p.eos.pressure(s.deviation) / (rho * rho);
    return s;
  };
  std::vector<std::array<double, dim + 1>> sums(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (seeds[i].owner != 0 && seeds[j].owner != 0) continue;
      Vec<double, dim + 1> to_i{}, to_j{};
      PairState<double, dim> si = state(seeds[i]);
      const PairState<double, dim> sj = state(seeds[j]);
      for (int k = 0; k < dim; ++k)
        if (period[k] > 0.0) si.x[k] -= period[k] * std::round((si.x[k] - sj.x[k]) / period[k]);
      if (seeds[i].owner == 0 && seeds[j].owner == 0)
        water(si, sj, to_i, to_j);
      else
        solid(si, sj, to_i, to_j);
      for (int k = 0; k <= dim; ++k) sums[i][k] += to_i[k], sums[j][k] += to_j[k];
    }
  }
  return sums;
}

template <int dim>
Parameters parameters_for(KernelChoice kernel, DiffusionChoice diffusion) {
  Parameters p;
  p.spacing = 0.1, p.h_over_d = dim == 2 ? 1.4 : 1.3, p.eos = {1000.0, 30.0};
  p.kernel = kernel, p.diffusion = diffusion, p.alpha_solid = 0.02;
  return p;
}

/// Largest difference over all particles, relative to the root mean square of each component.
template <std::size_t n>
double worst_difference(const std::vector<std::array<double, n>>& a, const std::vector<std::array<double, n>>& b) {
  double worst = 0.0;
  for (std::size_t c = 0; c < n; ++c) {
    double scale = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      scale += b[i][c] * b[i][c];
      difference = std::max(difference, std::abs(a[i][c] - b[i][c]));
      if (!std::isfinite(a[i][c])) return 1e300;
    }
    worst = std::max(worst, difference / std::sqrt(scale / double(a.size())));
  }
  return worst;
}

template <int dim, class Real>
auto sweep_sums(const Parameters& p, const Domain<dim>& domain, const std::vector<Seed<dim>>& seeds) {
  SeaSph<dim, Real> sea(p, domain, seeds);
  sea.evaluate();
  return by_identity(sea.store(), seeds.size(), [&](std::size_t slot) { return sums_at(sea.store(), slot); });
}

template <int dim>
constexpr std::array<int, dim> block_cells() {
  if constexpr (dim == 2)
    return {31, 23};
  else
    return {11, 9, 10};
}

template <int dim, class Real, class Kernel, class Diffusion>
void check_against_all_pairs(const Parameters& p, const Diffusion& diffusion, double tolerance) {
  const auto seeds = disordered_block<dim>(p.spacing, block_cells<dim>(), {}, true);
  const auto expected = all_pairs<Kernel>(seeds, p, diffusion);
  CHECK(worst_difference(sweep_sums<dim, Real>(p, domain_around<dim>({}, 3.2), seeds), expected) < tolerance);
}

}  // namespace

TEMPLATE_TEST_CASE("the sweep over clusters gives what all pairs give", "[sph][fast]", float, double) {
  const double tolerance = std::is_same_v<TestType, float> ? 1e-5 : 1e-12;
  const auto p2 = parameters_for<2>(KernelChoice::wendland, DiffusionChoice::none);
  check_against_all_pairs<2, TestType, KernelWendland<2>>(p2, DensityDiffusionNone{}, tolerance);
  const auto p3 = parameters_for<3>(KernelChoice::wendland, DiffusionChoice::molteni);
  check_against_all_pairs<3, TestType, KernelWendland<3>>(p3, DensityDiffusionMolteni<>{p3.delta, p3.eos.c0, p3.h()}, tolerance);
  const auto cubic = parameters_for<3>(KernelChoice::cubic, DiffusionChoice::fourtakas);
  check_against_all_pairs<3, TestType, KernelCubic<3>>(
      cubic, DensityDiffusionFourtakas<>(cubic.delta, cubic.h(), cubic.eos, cubic.gravity), tolerance);
}

TEST_CASE("periodic sides join both ends", "[sph][fast]") {
  const auto p = parameters_for<3>(KernelChoice::wendland, DiffusionChoice::none);
  const auto seeds = disordered_block<3>(p.spacing, {12, 14, 6}, {0, 0, 0}, true);
  const Domain<3> domain{{0, 0, -0.1}, {1.2, 1.4, 1.0}, {true, true, false}};
  const auto expected = all_pairs<KernelWendland<3>>(seeds, p, DensityDiffusionNone{}, {1.2, 1.4, 0.0});
  CHECK(worst_difference(sweep_sums<3, double>(p, domain, seeds), expected) < 1e-12);
}

TEMPLATE_TEST_CASE("pairs conserve linear and angular momentum without walls", "[sph][fast]", float, double) {
  const auto p = parameters_for<3>(KernelChoice::wendland, DiffusionChoice::fourtakas);
  const auto seeds = disordered_block<3>(p.spacing, {11, 12, 13}, {0, 0, 0}, false);
  const auto sums = sweep_sums<3, TestType>(p, domain_around<3>({0, 0, 0}, 1.5), seeds);
  std::array<double, 3> force{}, moment{};
  double magnitude = 0.0, lever = 0.0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const auto& x = seeds[i].position;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      force[k] += sums[i][k], magnitude += std::abs(sums[i][k]);
      moment[k] += x[a] * sums[i][b] - x[b] * sums[i][a], lever += std::abs(x[a] * sums[i][b]) + std::abs(x[b] * sums[i][a]);
    }
  }
  const double tolerance = std::is_same_v<TestType, float> ? 1e-6 : 1e-13;
  for (int k = 0; k < 3; ++k) {
    CHECK(std::abs(force[k]) < tolerance * magnitude);
    CHECK(std::abs(moment[k]) < tolerance * lever);
  }
}

TEST_CASE("float accelerations are the same 10 km away", "[sph][fast]") {
  const auto p = parameters_for<3>(KernelChoice::wendland, DiffusionChoice::none);
  const auto near = disordered_block<3>(p.spacing, {11, 9, 10}, {0, 0, 0}, true);
  auto far = near;
  for (auto& seed : far) seed.position[0] += 1e4, seed.position[1] -= 1e4, seed.position[2] += 1e4;
  const auto here = sweep_sums<3, float>(p, domain_around<3>({0, 0, 0}, 1.5), near);
  const auto there = sweep_sums<3, float>(p, domain_around<3>({1e4, -1e4, 1e4}, 1.5), far);
  CHECK(worst_difference(there, here) < 1e-5);
}

TEST_CASE("float accelerations do not lose digits at the far end of a long tank", "[sph][fast]") {
  const auto p = parameters_for<2>(KernelChoice::wendland, DiffusionChoice::none);
  const auto seeds =
      disordered_block<2>(p.spacing, {31, 23}, {5000.0, 0}, true);  // 50 000 spacings from the corner of the domain
  const auto expected = all_pairs<KernelWendland<2>>(seeds, p, DensityDiffusionNone{});
  CHECK(worst_difference(sweep_sums<2, float>(p, Domain<2>{{-1, -1}, {5010, 10}}, seeds), expected) < 1e-5);
}

TEST_CASE("any number of threads gives the same bits", "[sph][fast]") {
  const auto p = parameters_for<3>(KernelChoice::wendland, DiffusionChoice::none);
  const auto seeds = disordered_block<3>(p.spacing, {24, 20, 12}, {0, 0, 0}, true);
  const int threads = omp_get_max_threads();
  const auto run = [&](int n) {
    omp_set_num_threads(n);
    SeaSph<3, float> sea(p, domain_around<3>({0, 0, 0}, 4.0), seeds);
    for (int step = 0; step < 5; ++step) sea.step(1.0);
    return by_identity(sea.store(), seeds.size(), [&](std::size_t slot) {
      return std::array<double, 4>{sea.store().x[0][slot], sea.store().v[1][slot], sea.store().v[2][slot],
                                   sea.store().deviation[slot]};
    });
  };
  const auto one = run(1);
  CHECK(run(2) == one);
  CHECK(run(5) == one);
  omp_set_num_threads(threads);
}
