// A standing wave of linear theory, omega^2 = g k tanh(k H), between periodic sides over a dynamic bottom: frequency and decay.
// Viscous decay of the amplitude in deep water is exp(-2 nu k^2 t) (Lamb, Hydrodynamics, art. 348).
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

struct Wave {
  double frequency_ratio;  ///< measured over linear theory
  double viscosity;        ///< decay rate / (2 k^2) [m2/s]
};

/// `change` sets the viscosity of the water; walls have none.
template <class Change>
Wave standing_wave(double spacing, double periods, const Change& change) {
  const double length = 1.0, amplitude = 0.01, k = 2.0 * pi / length;
  Tank tank(spacing, length, 0.5);
  tank.p.alpha = tank.p.alpha_solid = tank.p.nu = tank.p.nu_solid = 0.0;
  change(tank.p);
  const double omega = std::sqrt(tank.p.gravity * k * std::tanh(k * tank.depth)), period = 2.0 * pi / omega;
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  for (Seed<2>& seed : seeds) {  // the moment when the surface is flat
    const double x = seed.position[0], z = seed.position[1] - tank.bottom(),
                 scale = amplitude * omega / std::sinh(k * tank.depth);
    seed.velocity = {-scale * std::cosh(k * z) * std::sin(k * x), scale * std::sinh(k * z) * std::cos(k * x)};
  }
  for_lattice<2>({0, -Tank::wall_layers}, {tank.columns, 0}, [&](const std::array<int, 2>& at) {
    const auto x = lattice_point<2>({0, 0}, spacing, at);
    seeds.push_back(
        {.position = x, .deviation = tank.p.eos.hydrostatic_deviation(tank.surface() - x[1], tank.p.gravity), .owner = 1});
  });
  SeaSph<2> sea(tank.p, {{0, -0.5}, {tank.columns * spacing, 2}, {true, false}}, seeds);

  std::vector<double> crossings, peaks;
  double before = 0.0, peak = 0.0;
  const double dt = period / 200;
  while (sea.time() < periods * period) {
    sea.advance(dt);
    double mode = 0.0;
    for_water_of(sea, [&](std::size_t slot) { mode += sea.store().x[1][slot] * std::cos(k * sea.store().x[0][slot]); });
    peak = std::max(peak, std::abs(mode));
    if (before * mode < 0.0) {
      crossings.push_back(sea.time() - dt * mode / (mode - before));
      peaks.push_back(peak);
      peak = 0.0;
    }
    before = mode;
  }
  const double halves = double(crossings.size()) - 2.0;  // the first half period is starting noise
  const double decay = std::log(peaks[1] / peaks.back()) / (0.5 * period * halves);
  return {0.5 * halves * period / (crossings.back() - crossings[1]), decay / (2.0 * k * k)};
}

Wave standing_wave(double spacing, double alpha, double periods) {
  return standing_wave(spacing, periods, [&](Parameters& p) { p.alpha = alpha; });
}

}  // namespace

TEST_CASE("a standing wave swings at the frequency of linear theory", "[verification][sea][fast]") {
  const Wave wave = standing_wave(0.04, 0.01, 3.0);
  CHECK(wave.frequency_ratio == Approx(1.0).margin(0.03));
}

// The pair force is a Laplacian, whose free surface holds back grad v n where that of a fluid holds back (grad v + grad v^T) n:
// of an irrotational wave it takes half in the limit (Colagrossi et al. 2011, Phys. Rev. E 84, 026705).
TEST_CASE("laminar viscosity takes from a standing wave a little less than half of what a viscous fluid loses",
          "[verification][sea][fast]") {
  const auto viscosity_with = [](double nu) {
    return standing_wave(0.04, 3.0, [&](Parameters& p) { p.viscosity = ViscosityChoice::laminar, p.nu = nu; }).viscosity;
  };
  constexpr double nu = 4e-3;
  const double share = (viscosity_with(nu) - viscosity_with(0.0)) / nu;
  CHECK(share > 0.3);
  CHECK(share < 0.5);
}

TEST_CASE("a standing wave is within 1 % of linear theory, its decay that of the artificial viscosity",
          "[verification][sea][nightly]") {
  const Wave fine = standing_wave(0.02, 0.02, 6.0), coarse = standing_wave(0.04, 0.02, 6.0);
  CHECK(fine.frequency_ratio == Approx(1.0).margin(0.01));
  CHECK(std::abs(fine.frequency_ratio - 1.0) < std::abs(coarse.frequency_ratio - 1.0));
  // alpha c0 h / 8 if it acted on all pairs; it acts on the approaching half.
  const double all_pairs = 0.02 * 10.0 * std::sqrt(9.81 * 0.5) * 1.5 * 0.02 / 8.0;
  CHECK(fine.viscosity > 0.35 * all_pairs);
  CHECK(fine.viscosity < 0.65 * all_pairs);
  CHECK(fine.viscosity < 0.75 * coarse.viscosity);
}
