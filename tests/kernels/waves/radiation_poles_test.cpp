// Poles of radiation memory: found exactly where there are few, good to the tolerance where K is a body's, and their convolution
// is exact for a straight velocity. SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/radiation_poles.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "kernels/waves/cummins.hpp"

using namespace spindrift;

namespace {

std::vector<double> sampled(const waves::RadiationPoles& k, double h, int count) {
  std::vector<double> samples;
  for (int n = 0; n < count; ++n) samples.push_back(k.at(h * n));
  return samples;
}

}  // namespace

TEST_CASE("a memory of few oscillations gives back its poles and their weights", "[waves][fast]") {
  waves::RadiationPoles k;
  k.pole = {{-0.2, 0.6}, {-0.5, 1.5}, {-0.8, 0.0}}, k.weight = {{3.0, 1.0}, {-1.0, 0.5}, {0.7, 0.0}};
  const waves::RadiationPoles fit = waves::fit_radiation_poles(sampled(k, 0.1, 400), 0.1, 1e-9);
  REQUIRE(fit.pole.size() == 3);
  for (std::size_t n = 0; n < 3; ++n) {
    double nearest = 1.0;
    std::complex<double> weight;
    for (std::size_t m = 0; m < 3; ++m)
      if (const double off = std::abs(fit.pole[m] - k.pole[n]); off < nearest) nearest = off, weight = fit.weight[m];
    CHECK(nearest < 1e-7);
    CHECK(std::abs(weight - k.weight[n]) < 1e-6);
  }
}

TEST_CASE("the memory of damping with a peak is met within the tolerance by decaying poles, and by more where less is borne",
          "[waves][fast]") {
  // A narrow bell of damping, which no finite number of poles has.
  std::vector<double> omega, damping, samples;
  for (double w = 0.05; w < 4.0; w += 0.05) omega.push_back(w), damping.push_back(w * w * std::exp(-4.0 * (w - 0.8) * (w - 0.8)));
  for (int n = 0; n <= 300; ++n) samples.push_back(waves::retardation(omega, damping, 0.2 * n));
  double size = 0.0;
  for (double k : samples) size += k * k;
  size = std::sqrt(size / double(samples.size()));
  std::vector<std::size_t> poles;
  for (double tolerance : {0.1, 0.01, 0.002}) {
    const waves::RadiationPoles fit = waves::fit_radiation_poles(samples, 0.2, tolerance * size);
    CAPTURE(tolerance, fit.error / size, fit.pole.size());
    CHECK(fit.error <= tolerance * size);
    poles.push_back(fit.pole.size());
    double worst = 0.0, sum = 0.0;
    for (std::size_t n = 0; n < samples.size(); ++n)
      worst = std::max(worst, std::abs(fit.at(0.2 * double(n)) - samples[n])),
      sum += std::pow(fit.at(0.2 * double(n)) - samples[n], 2);
    CHECK(fit.error == Approx(std::sqrt(sum / double(samples.size()))).epsilon(1e-6));
    for (const std::complex<double>& p : fit.pole) CHECK(p.real() < 0.0);
  }
  CHECK(poles.back() > poles.front());
}

TEST_CASE("memory of nothing needs no poles", "[waves][fast]") {
  const std::vector<double> nothing(20, 0.0);
  CHECK(waves::fit_radiation_poles(nothing, 0.1, 1e-12).pole.empty());
}

TEST_CASE("the answer of a pole to a straight velocity is the integral's, however short the step", "[waves][fast]") {
  const std::complex<double> p(-0.4, 1.1);
  const double s = GENERATE(1e-6, 1e-3, 0.05, 0.08, 0.09, 0.5, 4.0), v0 = 2.0, v1 = -1.0;
  std::complex<double> sum = 0.0;
  constexpr int parts = 4000;  // Simpson
  for (int n = 0; n <= parts; ++n) {
    const double x = s * n / parts, weight = n == 0 || n == parts ? 1.0 : n % 2 == 1 ? 4.0 : 2.0;
    sum += weight * std::exp(p * (s - x)) * (v0 + (v1 - v0) * x / s);
  }
  sum *= s / (3.0 * parts);
  CHECK(std::abs(waves::pole_response(p, s, v0, v1) - sum) < 1e-12 * s);
}
