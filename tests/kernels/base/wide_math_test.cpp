// kernels/base/wide_math.hpp against the C library, in units in the last place; lanes against one number.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/wide_math.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace spindrift;

namespace {
double ulps(double value, double exact) {
  return std::abs(value - exact) / (std::numeric_limits<double>::epsilon() * std::max(std::abs(exact), 1e-300));
}
}  // namespace

TEST_CASE("logarithm and exponential agree with the C library within 2 units in the last place", "[wide][fast]") {
  double worst_log = 0, worst_log1p = 0, worst_exp = 0, worst_expm1 = 0;
  for (double x = 1e-280; x < 1e280; x *= 1.7) worst_log = std::max(worst_log, ulps(spindrift::log(x), std::log(x)));
  for (double x = 0.5; x < 2.0; x += 0.000713) worst_log = std::max(worst_log, ulps(spindrift::log(x), std::log(x)));
  for (double x = 1e-18; x < 1e18; x *= 1.13)
    for (const double s : {x, x < 0.99 ? -x : x}) worst_log1p = std::max(worst_log1p, ulps(spindrift::log1p(s), std::log1p(s)));
  for (double x = -690.0; x < 690.0; x += 0.1371) worst_exp = std::max(worst_exp, ulps(spindrift::exp(x), std::exp(x)));
  for (double x = 1e-18; x < 600.0; x *= 1.13)
    for (const double s : {x, -x}) worst_expm1 = std::max(worst_expm1, ulps(spindrift::expm1(s), std::expm1(s)));
  CHECK(worst_log <= 2.0);
  CHECK(worst_log1p <= 2.0);
  CHECK(worst_exp <= 2.0);
  CHECK(worst_expm1 <= 2.0);
}

TEST_CASE("exponentials of any size stay finite", "[wide][fast]") {
  CHECK(spindrift::exp(-1e9) > 0.0);
  CHECK(spindrift::exp(-1e9) < 1e-300);
  CHECK(std::isfinite(spindrift::exp(1e9)));
  CHECK(spindrift::tanh(1e9) == 1.0);
  CHECK(spindrift::tanh(-1e9) == -1.0);
  CHECK(spindrift::tanh(1e-9) == Approx(1e-9).epsilon(1e-15));
}

TEST_CASE("powers near one keep the digits of the difference", "[wide][fast]") {
  for (const double x : {1e-14, 1e-10, 1e-5}) {
    const double exact = x / 7.0 * (1.0 - 3.0 / 7.0 * x + 13.0 / 49.0 * x * x);  // three terms of the binomial series
    CHECK(power_minus_one(x, 1.0 / 7.0) == Approx(exact).epsilon(1e-14));
  }
  CHECK(power(3.7, 2.5) == Approx(std::pow(3.7, 2.5)).epsilon(1e-14));
}

TEST_CASE("lanes have the transcendental functions of one number", "[wide][fast]") {
  using V = Wide<double, 8>;
  double x[V::size];
  for (int n = 0; n < V::size; ++n) x[n] = 0.013 + 0.71 * n * n;
  const V v = V::load(x);
  for (int n = 0; n < V::size; ++n) {
    CHECK(ulps(log(v)[n], spindrift::log(x[n])) <= 1.0);
    CHECK(ulps(log1p(v)[n], spindrift::log1p(x[n])) <= 1.0);
    CHECK(ulps(exp(v)[n], spindrift::exp(x[n])) <= 1.0);
    CHECK(ulps(expm1(v)[n], spindrift::expm1(x[n])) <= 1.0);
    CHECK(ulps(tanh(v)[n], std::tanh(x[n])) <= 4.0);
  }
}
