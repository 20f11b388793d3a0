// A wave of the paper's proportions (depth 0.6 m, period 1.5 s, height 0.055 m) that travels between periodic sides: phase speed
// and loss per wave length, without a paddle. The support of the kernel decides both: as we explain it, a lattice of particles
// under pressure resists shear where its sums are coarse (tests/kernels/sph/lattice_stiffness_test.cpp), and a stiff sea is a
// fast one. Equations: docs/theory/waves.md; figures: docs/developer/notes/sea_physics.md. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <complex>

#include "kernels/base/constants.hpp"
#include "kernels/waves/dispersion.hpp"
#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

struct Travel {
  double speed_ratio;  ///< phase speed over that of linear theory
  double viscosity;    ///< decay rate of the amplitude / (2 k^2) [m2/s]
  double loss;         ///< of the amplitude per wave length, at the speed of groups
};

/// Two and a half periods; speed and decay from the means over the first full period and the last.
Travel travel(double particles_per_height, double h_over_d, double alpha) {
  const double depth = 0.6, period = 1.5, height = 1.88 / 20.6 * depth;
  const auto wave = waves::wave_properties(period, depth, 9.81);
  const double k = wave.wave_number, length = 2.0 * pi / k, omega = 2.0 * pi / period;
  Tank tank(depth / std::round(depth / (height / particles_per_height)), length, depth);
  Parameters& p = tank.p;
  p.h_over_d = h_over_d, p.alpha = alpha, p.alpha_solid = 0.0;
  const double spacing = p.spacing, width = length / tank.columns;  // cells a little off square, so that the wave fits
  p.mass_factor *= width / spacing;
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  for (Seed<2>& seed : seeds) {
    const double x = seed.position[0] * width / spacing, z = seed.position[1] - tank.bottom();
    const double way = 0.5 * height / std::sinh(k * depth), along = way * std::cosh(k * z), up = way * std::sinh(k * z);
    seed.velocity = {omega * along * std::cos(k * x), omega * up * std::sin(k * x)};
    seed.position = {x - along * std::sin(k * x), seed.position[1] + up * std::cos(k * x)};
    if (seed.position[0] < 0.0) seed.position[0] += length;
  }
  for_lattice<2>({0, -int(std::ceil(p.reach() / spacing))}, {tank.columns, 0}, [&](const std::array<int, 2>& at) {
    seeds.push_back({.position = {at[0] * width, at[1] * spacing},
                     .deviation = p.eos.hydrostatic_deviation(tank.surface() - at[1] * spacing, p.gravity),
                     .owner = 1});
  });
  SeaSph<2> sea(p, {{0, -0.5}, {length, 2}, {true, false}}, seeds);

  constexpr int readings = 40;  // per period
  const int periods_2 = 5;      // half periods in all
  std::vector<std::complex<double>> mode;
  for (int n = 1; n <= readings * periods_2 / 2; ++n) {
    sea.advance(n * period / readings - sea.time());
    std::complex<double> sum = 0.0;
    for_water_of(sea, [&](std::size_t slot) {
      sum += (sea.store().x[1][slot] - tank.bottom()) * std::polar(1.0, -k * sea.store().x[0][slot]);
    });
    mode.push_back(sum * std::polar(1.0, omega * sea.time()));  // stands still where the wave is that of theory
  }
  CHECK(sea.store().lost.empty());
  // Means over a whole period drop what travels the other way.
  std::complex<double> first = 0.0, last = 0.0;
  for (int n = 0; n < readings; ++n) first += mode[std::size_t(n)], last += mode[mode.size() - 1 - std::size_t(n)];
  const double between = (double(mode.size()) - readings) * period / readings;
  const double rate = std::log(std::abs(first) / std::abs(last)) / between;
  const double group_speed = 0.5 * omega / k * (1.0 + 2.0 * k * depth / std::sinh(2.0 * k * depth));
  return {1.0 - std::arg(last / first) / (omega * between), rate / (2.0 * k * k), 1.0 - std::exp(-rate * length / group_speed)};
}

}  // namespace

TEST_CASE(
    "a travelling wave has the speed of linear theory and the loss of the viscosity where the support is 2.5 x 2 spacings; "
    "with 1.5 x 2 it runs ahead",
    "[verification][sea][nightly]") {
  const double alpha = 0.01, particles_per_height = 2.5;
  const Travel wide = travel(particles_per_height, 2.5, alpha), narrow = travel(particles_per_height, 1.5, alpha);
  CAPTURE(wide.speed_ratio, wide.viscosity, wide.loss, narrow.speed_ratio, narrow.viscosity, narrow.loss);
  CHECK(wide.speed_ratio == Approx(1.0).margin(0.01));
  CHECK(std::abs(wide.speed_ratio - 1.0) < 0.5 * std::abs(narrow.speed_ratio - 1.0));
  // Half of alpha c0 h/8, as it acts on approaching pairs.
  const double approaching = alpha * 10.0 * std::sqrt(9.81 * 0.6) * 2.5 * (1.88 / 20.6 * 0.6 / particles_per_height) / 16.0;
  CHECK(wide.viscosity == Approx(approaching).epsilon(0.3));
  CHECK(wide.loss < 0.02);
}
