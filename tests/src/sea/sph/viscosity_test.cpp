// The laminar law and the sub-particle stress as sweeps.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

Parameters parameters(ViscosityChoice viscosity) {
  Parameters p;
  p.spacing = 0.1, p.h_over_d = 1.5, p.gravity = 0.0, p.eos.c0 = 30.0, p.viscosity = viscosity, p.nu = 0.05, p.nu_solid = 0.02;
  return p;
}

template <int dim, class Real>
auto sums_of(const Parameters& p, const std::vector<Seed<dim>>& seeds) {
  SeaSph<dim, Real> sea(p, domain_around<dim>({}, 3.0), seeds);
  sea.evaluate();
  return by_identity(sea.store(), seeds.size(), [&](std::size_t slot) { return sums_at(sea.store(), slot); });
}

}  // namespace

TEST_CASE("laminar viscosity adds its pair sum, with its own strength at walls, to what is there without", "[sph][fast]") {
  const auto seeds = disordered_block<2>(0.1, {20, 15}, {}, true);
  const Parameters p = parameters(ViscosityChoice::laminar);
  Parameters inviscid = p;
  inviscid.nu = inviscid.nu_solid = 0.0;
  const auto with = sums_of<2, double>(p, seeds), without = sums_of<2, double>(inviscid, seeds);
  const KernelWendland<2> kernel(p.h());
  double worst = 0.0;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      double expected = 0.0;
      for (std::size_t j = 0; j < seeds.size(); ++j) {
        if (i == j || (seeds[i].owner != 0 && seeds[j].owner != 0)) continue;
        const double x = seeds[i].position[0] - seeds[j].position[0], z = seeds[i].position[1] - seeds[j].position[1];
        const double nu = seeds[i].owner == 0 && seeds[j].owner == 0 ? p.nu : p.nu_solid;
        const auto deviation = [](const Seed<2>& s) { return s.owner == 0 ? s.deviation : std::max(s.deviation, 0.0); };
        const double rho_sum = 2.0 * p.eos.rho0 + deviation(seeds[i]) + deviation(seeds[j]);
        expected += 4.0 * nu * kernel.slope(x * x + z * z) / rho_sum * (seeds[i].velocity[k] - seeds[j].velocity[k]);
      }
      worst = std::max(worst, std::abs(with[i][k] - without[i][k] - expected));
    }
  CHECK(worst < 1e-10);
}

TEST_CASE("the sub-particle stress of uniform shear is Smagorinsky's in the bulk", "[sph][fast]") {
  const Parameters p = parameters(ViscosityChoice::laminar_sps);
  std::vector<Seed<3>> seeds;
  constexpr int n = 12;
  const double shear = 2.0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int c = 0; c < n; ++c)
        seeds.push_back({.position = {0.1 * a, 0.1 * b, 0.1 * c}, .velocity = {shear * 0.1 * c, 0.0, 0.0}});
  SeaSph<3, float> sea(p, domain_around<3>({}, 3.0), seeds);
  sea.evaluate();
  const auto stress = by_identity(sea.store(), seeds.size(), [&](std::size_t slot) {
    std::array<double, 6> tau;
    for (int k = 0; k < 6; ++k)
      tau[k] = double(sea.store().stress[(slot / cluster_size * 6 + k) * cluster_size + slot % cluster_size]);
    return tau;
  });
  const auto& tau = stress[(6 * n + 6) * n + 6];  // tau/rho^2 in the middle: xx, xy, xz, yy, yz, zz
  const double nu_t = 0.12 * 0.12 * 0.01 * shear, isotropic = -2.0 / 3.0 * 0.0066 * 0.01 * shear * shear;
  CHECK(tau[2] * 1000.0 == Approx(nu_t * shear).epsilon(0.05));
  CHECK(tau[0] * 1000.0 == Approx(isotropic).epsilon(0.1));
  CHECK(std::abs(tau[1]) < 1e-3 * tau[2]);
}

TEMPLATE_TEST_CASE("laminar and sub-particle stresses conserve momentum", "[sph][fast]", float, double) {
  const auto seeds = disordered_block<3>(0.1, {9, 8, 7}, {}, false);
  const auto sums = sums_of<3, TestType>(parameters(ViscosityChoice::laminar_sps), seeds);
  const auto laminar = sums_of<3, TestType>(parameters(ViscosityChoice::laminar), seeds);
  double magnitude = 0.0, stress = 0.0;
  std::array<double, 3> force{};
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (int k = 0; k < 3; ++k)
      force[k] += sums[i][k], magnitude += std::abs(sums[i][k]), stress += std::abs(sums[i][k] - laminar[i][k]);
  const double tolerance = std::is_same_v<TestType, float> ? 1e-6 : 1e-13;
  for (int k = 0; k < 3; ++k) CHECK(std::abs(force[k]) < tolerance * magnitude);
  CHECK(stress > 1e-4 * magnitude);
}
