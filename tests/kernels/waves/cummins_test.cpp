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

TEST_CASE("added mass at infinite frequency follows from that at others and the memory", "[waves][fast]") {
  const double infinite = 7.0, step = 0.01;
  std::vector<double> memory, omega, added_mass;
  for (int n = 0; n <= 4000; ++n) memory.push_back(k * std::exp(-a * n * step));
  for (double w = 0.3; w < 4.0; w += 0.1) omega.push_back(w), added_mass.push_back(infinite - k / (a * a + w * w));
  CHECK(waves::infinite_added_mass(omega, added_mass, memory, step) == Approx(infinite).epsilon(1e-4));
  added_mass[10] *= 40.0;  // an irregular frequency
  CHECK(waves::infinite_added_mass(omega, added_mass, memory, step) == Approx(infinite).epsilon(1e-4));
  CHECK(waves::infinite_added_mass(std::vector{3.0}, std::vector{infinite - k / (a * a + 9.0)}, memory, step) ==
        Approx(infinite).epsilon(1e-4));
}

TEST_CASE("damping that ends before it has died out leaves the added mass of the lower frequencies", "[waves][fast]") {
  // The memory of damping up to `last` alone; the added mass is that of all of it.
  const double infinite = 7.0, step = 0.01, last = GENERATE(1.0, 2.0, 4.0);
  std::vector<double> omega, cut, added_mass, memory;
  for (double w = 1e-9; w < last; w += 0.02)
    omega.push_back(w), cut.push_back(damping(w)), added_mass.push_back(infinite - k / (a * a + w * w));
  for (int n = 0; n <= 20000; ++n) memory.push_back(waves::retardation(omega, cut, n * step));
  const double found = waves::infinite_added_mass(omega, added_mass, memory, step);
  for (std::size_t m = 0; m < omega.size() / 2; m += 5) {
    double integral = 0.0;
    for (std::size_t n = 1; n < memory.size(); ++n) integral += memory[n] * std::sin(omega[m] * double(n) * step) * step;
    CHECK(std::abs(found - integral / omega[m] - added_mass[m]) < 0.03 * k / (a * a));
  }
}
