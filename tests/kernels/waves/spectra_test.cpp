// Spectra and their realisations: energy, peak, reproducibility.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/spectra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/waves/realisation.hpp"

using namespace spindrift;
using namespace spindrift::waves;

namespace {

std::vector<Component> realise(const SeaState& sea, bool equal_energy_shares, std::size_t count, std::uint64_t seed) {
  std::vector<Component> components(count);
  if (equal_energy_shares)
    equal_energy(sea, components);
  else
    equal_frequency(sea, components);
  finish_realisation(sea, seed, 0.0, 100.0, 9.81, components);
  return components;
}

std::vector<double> elevation_series(const std::vector<Component>& components, int samples, double dt) {
  std::vector<ComponentGroup> sea((components.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < components.size(); ++i) set_lane(sea[i / lanes], int(i % lanes), components[i], 100.0);
  std::vector<double> eta;
  for (int i = 0; i < samples; ++i) eta.push_back(surface(sea, i * dt, 0.0, 0.0).elevation);
  return eta;
}

/// Frequency [rad/s] where the periodogram, averaged over 15 neighbouring lines, is largest.
double peak_of(const std::vector<double>& eta, double dt, double low, double high) {
  const double step = 2.0 * pi / (double(eta.size()) * dt);
  std::vector<double> lines;
  const int first = int(low / step);
  for (int line = first; line * step < high; ++line) {
    double c = 0.0, s = 0.0;
    const double turn_c = std::cos(line * step * dt), turn_s = std::sin(line * step * dt);
    double pc = 1.0, ps = 0.0;
    for (double e : eta) {
      c += e * pc, s += e * ps;
      const double next = pc * turn_c - ps * turn_s;
      ps = ps * turn_c + pc * turn_s, pc = next;
    }
    lines.push_back(c * c + s * s);
  }
  double best = 0.0, at = 0.0;
  for (std::size_t i = 7; i + 7 < lines.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = i - 7; j <= i + 7; ++j) sum += lines[j];
    if (sum > best) best = sum, at = (first + double(i)) * step;
  }
  return at;
}

}  // namespace

TEST_CASE("spectra hold the energy of their significant height and peak at their period", "[waves][fast]") {
  for (double gamma : {1.0, 2.0, 3.3, 5.0}) {
    const SeaState sea{3.25, 9.7, gamma};
    const double peak = 2.0 * pi / sea.peak_period, step = 1e-3 * peak;
    double energy = 0.0, most = 0.0, at = 0.0;
    for (double w = 0.5 * step; w < 60.0 * peak; w += step) {
      const double s = spectral_density(sea, w);
      energy += s * step;
      if (s > most) most = s, at = w;
    }
    CHECK(energy == Approx(sea.significant_height * sea.significant_height / 16.0).epsilon(gamma == 1.0 ? 1e-3 : 0.015));
    CHECK(at == Approx(peak).epsilon(2e-3));
  }
  // gamma is the ratio of the peaks of JONSWAP and Pierson-Moskowitz, apart from DNV's normalisation.
  const double peak = 2.0 * pi / 9.7;
  CHECK(spectral_density({3.0, 9.7, 3.3}, peak) / spectral_density({3.0, 9.7, 1.0}, peak) ==
        Approx(3.3 * (1.0 - 0.287 * std::log(3.3))));
  CHECK(peak_enhancement(4.0, 7.0) == 5.0);
  CHECK(peak_enhancement(4.0, 8.0) == Approx(std::exp(1.15)));
  CHECK(peak_enhancement(1.0, 8.0) == 1.0);
}

TEST_CASE("an hour of a JONSWAP sea has its significant height and its peak period", "[waves][fast]") {
  const SeaState sea{3.25, 9.7, 3.3};
  for (const bool shares : {false, true}) {
    const auto components = realise(sea, shares, 500, 42);
    double variance = 0.0;
    for (const Component& c : components) variance += 0.5 * c.amplitude * c.amplitude;
    CHECK(4.0 * std::sqrt(variance) == Approx(sea.significant_height).epsilon(1e-13));
    const auto eta = elevation_series(components, 7200, 0.5);
    double square = 0.0;
    for (double e : eta) square += e * e / double(eta.size());
    CHECK(4.0 * std::sqrt(square) == Approx(sea.significant_height).epsilon(0.03));
    CHECK(2.0 * pi / peak_of(eta, 0.5, 0.3, 1.5) == Approx(sea.peak_period).epsilon(0.05));
  }
}

TEST_CASE("equal shares of energy put half of the harmonics on each side of the median frequency", "[waves][fast]") {
  // Pierson-Moskowitz: the energy below omega is exp(-1.25 (peak/omega)^4) of the whole.
  const SeaState sea{2.0, 8.0, 1.0};
  const auto components = realise(sea, true, 64, 1);
  const auto below = [&](double w) { return std::exp(-1.25 * std::pow(2.0 * pi / sea.peak_period / w, 4)); };
  const double top = below(highest_in_peaks * 2.0 * pi / sea.peak_period);
  for (std::size_t i = 0; i < components.size(); ++i)
    CHECK(below(components[i].angular_frequency) / top == Approx((double(i) + 0.5) / 64.0).margin(1e-5));
}

TEST_CASE("the same seed gives the same sea, another seed another", "[waves][fast]") {
  const SeaState sea{3.25, 9.7, 3.3};
  const auto a = realise(sea, true, 200, 7), b = realise(sea, true, 200, 7), c = realise(sea, true, 200, 8);
  int same = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].phase == b[i].phase);
    REQUIRE(a[i].amplitude == b[i].amplitude);
    same += a[i].phase == c[i].phase;
  }
  CHECK(same == 0);
  // Phases do not depend on how the frequencies are chosen, and are these on every machine.
  Random random(7);
  CHECK(a[0].phase == 2.0 * pi * random.uniform());
  CHECK(realise(sea, false, 200, 7)[199].phase == a[199].phase);
}
