// kernels/base/dual.hpp: derivatives of each operation against the rule of calculus written out.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/dual.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace spindrift;

TEST_CASE("dual numbers differentiate", "[dual][fast]") {
  using D = Dual<double, 2>;
  const double a = 1.3, b = -0.4;
  const D x = D::variable(a, 0), y = D::variable(b, 1);
  const auto holds = [](const D& f, double value, double by_x, double by_y) {
    CHECK(f.value == Approx(value).epsilon(1e-14));
    CHECK(f.d[0] == Approx(by_x).epsilon(1e-14).margin(1e-15));
    CHECK(f.d[1] == Approx(by_y).epsilon(1e-14).margin(1e-15));
  };
  holds(x * y + 2.0 * x - y * 3.0, a * b + 2 * a - 3 * b, b + 2, a - 3);
  holds(x / y, a / b, 1 / b, -a / (b * b));
  holds(1.0 / x, 1 / a, -1 / (a * a), 0);
  holds(sqrt(x), std::sqrt(a), 0.5 / std::sqrt(a), 0);
  holds(log(x * x), 2 * std::log(a), 2 / a, 0);
  holds(log1p(y), std::log1p(b), 0, 1 / (1 + b));
  holds(exp(x * y), std::exp(a * b), b * std::exp(a * b), a * std::exp(a * b));
  holds(expm1(y), std::expm1(b), 0, std::exp(b));
  holds(tanh(x), std::tanh(a), 1 - std::tanh(a) * std::tanh(a), 0);
  holds(abs(y), -b, 0, -1);
  holds(max(x, y), a, 1, 0);
  holds(min(x, 0.5), 0.5, 0, 0);
  holds(select(x < y, x, y), b, 0, 1);
}

TEST_CASE("dual numbers of lanes differentiate each lane", "[dual][fast]") {
  using V = NativeWide<double>;
  using D = Dual<V, 1>;
  double from[V::size];
  for (int n = 0; n < V::size; ++n) from[n] = 0.5 + n;
  const D x = D::variable(V::load(from), 0);
  const D f = sqrt(x) * max(x, 2.0) / (1.0 + x * x);
  for (int n = 0; n < V::size; ++n) {
    const auto one = Dual<double, 1>::variable(from[n], 0);
    const auto g = sqrt(one) * max(one, 2.0) / (1.0 + one * one);
    CHECK(f.value[n] == Approx(g.value).epsilon(1e-15));
    CHECK(f.d[0][n] == Approx(g.d[0]).epsilon(1e-14));
  }
}
