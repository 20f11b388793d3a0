// Retardation functions against one with a closed form: K = k exp(-a t), B = k a / (a^2 + w^2), A(inf) - A = k / (a^2 + w^2).
// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/cummins.hpp"

#include <catch2/catch.hpp>

#include <vector>

#include "tests/order.hpp"

using namespace spindrift;

namespace {
constexpr double k = 3.0, a = 0.5;
double damping(double w) { return k * a / (a * a + w * w); }
}  // namespace

TEST_CASE("the integral is exact for damping that is straight between its frequencies", "[waves][fast]") {
  // A triangle from 0 to 2 with its top at 1: 2/pi (2 cos t - 1 - cos 2t) / t^2.
  const std::vector<double> omega{1.0, 2.0}, b{1.0, 0.0};
  for (double t : {1e-6, 1e-3, 0.3, 2.0, 40.0}) {
    const double exact =
        t < 0.01 ? 2.0 / pi * (1.0 - 7.0 / 12.0 * t * t) : 2.0 / pi * (2.0 * std::cos(t) - 1.0 - std::cos(2.0 * t)) / (t * t);
    CHECK(waves::retardation(omega, b, t) == Approx(exact).epsilon(1e-6).margin(1e-12));
  }
}

TEST_CASE("memory of finer frequencies converges to the closed form at second order", "[waves][order][fast]") {
  // Beyond the last frequency, 200 rad/s, lies k a / 200 of damping: some 5e-3; the fit's range stays above it.
  std::vector<double> h, error;
  for (double step : {0.4, 0.2, 0.1}) {
    std::vector<double> omega, b;
    // Zero damping is what the integral takes at w = 0; the first frequency is close to it.
    for (double w = 1e-9; w < 200.0; w += step) omega.push_back(w), b.push_back(damping(w));
    h.push_back(step), error.push_back(std::abs(waves::retardation(omega, b, 2.0) - k * std::exp(-a * 2.0)));
  }
  CHECK(error.back() < 2e-3 * k);
  CHECK(observed_order(h, error) > 1.5);
}

TEST_CASE("added mass at infinite frequency follows from that at one frequency and the memory", "[waves][fast]") {
  const double infinite = 7.0, w = GENERATE(0.3, 1.0, 3.0), step = 0.01;
  std::vector<double> memory;
  for (int n = 0; n <= 4000; ++n) memory.push_back(k * std::exp(-a * n * step));
  CHECK(waves::infinite_added_mass(infinite - k / (a * a + w * w), w, memory, step) == Approx(infinite).epsilon(1e-4));
}
