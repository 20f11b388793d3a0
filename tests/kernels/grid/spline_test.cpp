// The cubic spline: exact for parabolas, fourth order inside for smooth functions.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/spline.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/base/interpolation.hpp"
#include "tests/order.hpp"

using namespace spindrift;

namespace {

template <class F>
double error_of_spline(int n, F f) {
  std::vector<double> x, y;
  for (int i = 0; i <= n; ++i) x.push_back(std::pow(double(i) / n, 1.2)), y.push_back(f(x.back()));
  std::vector<double> slope(x.size()), work(x.size());
  spline_slopes(x, y, slope, work);
  double worst = 0.0;
  for (int m = 0; m <= 400; ++m) {
    const double at = 0.2 + 0.6 * m / 400;
    worst = std::max(worst, std::abs(interpolate_hermite(x, y, slope, at).value - f(at)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a spline through a parabola is the parabola", "[grid][fast]") {
  CHECK(error_of_spline(7, [](double x) { return 2.0 - 3.0 * x + 5.0 * x * x; }) < 1e-14);
}

TEST_CASE("a spline through a smooth function is of fourth order", "[grid][order]") {
  std::vector<double> h, error;
  for (const int n : {16, 32, 64, 128}) {
    h.push_back(1.0 / n);
    error.push_back(error_of_spline(n, [](double x) { return std::sin(7.0 * x); }));
  }
  CHECK(observed_order(h, error) == Approx(4.0).margin(0.25));
}
