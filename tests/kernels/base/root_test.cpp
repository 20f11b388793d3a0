// Laws of kernels/base/root.hpp and interpolation.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/root.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/base/interpolation.hpp"

using namespace spindrift;

TEST_CASE("an increasing function's root is found from a guess wrong by any power of ten", "[base][fast]") {
  const double root = GENERATE(1e-12, 0.3, 7e5);
  const double guess = root * GENERATE(1e-9, 0.5, 1.0, 3.0, 1e9);
  const Root cubic = increasing_root([=](double x) { return ValueAndSlope{x * x * x - root * root * root, 3 * x * x}; }, guess);
  CHECK(cubic.converged);
  CHECK(cubic.x == Approx(root).epsilon(1e-14));
  const Root bent = increasing_root([=](double x) { return ValueAndSlope{std::log(x / root), 1 / x}; }, guess);
  CHECK(bent.converged);
  CHECK(bent.x == Approx(root).epsilon(1e-14));
}

TEST_CASE("a function without a root is reported, not looped over", "[base][fast]") {
  const Root none = increasing_root([](double x) { return ValueAndSlope{1.0 + x, 1.0}; }, 1.0);
  CHECK_FALSE(none.converged);
}

TEST_CASE("a sign change is closed in on, smooth, flat or jumping", "[base][fast]") {
  const auto find = [](auto f, double a, double b) { return bracketed_root(f, a, f(a), b, f(b), 1e-12); };
  CHECK(find([](double x) { return std::cos(x) - x; }, 0.0, 1.0).x == Approx(0.7390851332151607).epsilon(1e-11));
  CHECK(find([](double x) { return std::cos(x) - x; }, 0.0, 1.0).evaluations < 12);
  CHECK(find([](double x) { return std::pow(x - 0.3, 9); }, -1.0, 2.0).x == Approx(0.3).margin(1e-2));
  CHECK(find([](double x) { return x < 0.7 ? -1.0 : 2.0; }, 0.0, 1.0).x == Approx(0.7).epsilon(1e-11));
  CHECK(find([](double x) { return 1.0 / x - 1e6; }, 1e-9, 1.0).x == Approx(1e-6).epsilon(1e-5));
}

TEST_CASE("linear interpolation passes the nodes and holds its end values", "[base][fast]") {
  const std::array x{0.0, 1.0, 4.0}, y{2.0, 3.0, -3.0};
  for (std::size_t i = 0; i < 3; ++i) CHECK(interpolate_linear(x, y, x[i]) == y[i]);
  CHECK(interpolate_linear(x, y, 2.5) == Approx(0.0).margin(1e-15));
  CHECK(interpolate_linear(x, y, -9.0) == 2.0);
  CHECK(interpolate_linear(x, y, 9.0) == -3.0);
}

TEST_CASE("the monotone cubic stays between its data where a spline would overshoot", "[base][fast]") {
  const std::vector<double> x{0, 1, 2, 3, 4, 7}, y{0, 0, 0, 1, 1, 1.5};
  std::vector<double> slope(x.size());
  monotone_slopes(x, y, slope);
  double last = -1e-15;
  for (double at = 0.0; at <= 7.0; at += 1.0 / 64) {
    const auto [value, rate] = interpolate_hermite(x, y, slope, at);
    CHECK(value >= last - 1e-15);
    CHECK(rate >= -1e-14);
    CHECK(value <= 1.5 + 1e-15);
    last = value;
  }
}

TEST_CASE("the monotone cubic reproduces a straight line and has order three on smooth data", "[base][fast]") {
  const auto error = [](int n) {
    std::vector<double> x, y;
    for (int i = 0; i <= n; ++i) x.push_back(0.2 + 1.1 * i / n), y.push_back(std::exp(x.back()));
    std::vector<double> slope(x.size());
    monotone_slopes(x, y, slope);
    double worst = 0.0;
    for (double at = 0.2; at < 1.3; at += 0.0037)
      worst = std::max(worst, std::abs(interpolate_hermite(x, y, slope, at).value - std::exp(at)));
    return worst;
  };
  CHECK(std::log2(error(20) / error(40)) > 2.7);
  const std::array<double, 3> x{0, 1, 5}, y{1, 3, 11};
  std::array<double, 3> slope;
  monotone_slopes(x, y, slope);
  CHECK(interpolate_hermite(x, y, slope, 3.3).value == Approx(7.6));
  CHECK(interpolate_hermite(x, y, slope, 3.3).slope == Approx(2.0));
}
