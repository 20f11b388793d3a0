// Laws of kernels/base/wide.hpp: lane arithmetic is the arithmetic of one number.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/wide.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace spindrift;

TEMPLATE_TEST_CASE("lanes compute what one number computes", "[wide][fast]", float, double) {
  using V = Wide<TestType, 8>;
  TestType a[8], b[8];
  for (int n = 0; n < 8; ++n) a[n] = TestType(0.3 * n - 2.0), b[n] = TestType(5.0 / (n + 1));
  const V va = V::load(a), vb = V::load(b);
  for (int n = 0; n < 8; ++n) {
    CHECK((va + vb)[n] == a[n] + b[n]);
    CHECK((va - vb)[n] == a[n] - b[n]);
    CHECK((va * vb)[n] == a[n] * b[n]);
    CHECK((va / vb)[n] == a[n] / b[n]);
    CHECK((-va)[n] == -a[n]);
    CHECK(min(va, vb)[n] == std::min(a[n], b[n]));
    CHECK(max(va, vb)[n] == std::max(a[n], b[n]));
    CHECK(sqrt(vb)[n] == std::sqrt(b[n]));
  }
  const TestType nan = std::numeric_limits<TestType>::quiet_NaN();
  CHECK(max(V(nan), V(TestType(1)))[2] == TestType(1));  // the second of the two where they do not compare
  CHECK(std::isnan(max(V(TestType(1)), V(nan))[2]));
  CHECK(min(V(nan), V(TestType(1)))[2] == TestType(1));
  CHECK(std::signbit(max(V(TestType(0.0)), V(TestType(-0.0)))[2]));
  CHECK_FALSE(std::signbit(min(V(TestType(-0.0)), V(TestType(0.0)))[2]));
  CHECK(V(TestType(-0.0))[3] == TestType(0));
  CHECK(std::signbit(V(TestType(-0.0))[3]));
}

TEMPLATE_TEST_CASE("a product that is added is rounded once, in whole registers and in halves", "[wide][fast]", float, double) {
  const auto check = []<class V>(V) {
    using T = typename V::Scalar;
    const T unit = std::numeric_limits<T>::epsilon();
    // a b = 1 - unit^2: rounded it is 1, so that only a fused operation sees the rest.
    const T a = T(1) + unit, b = T(1) - unit;
    const V va(a), vb(b), one(T(1)), two(T(2));
    const auto all = [](V v, T expected) {
      for (int lane = 0; lane < V::size; ++lane) CHECK(v[lane] == expected);
    };
    all(va * vb, T(1));
    all(va * vb - one, -unit * unit);
    all(one - va * vb, unit * unit);
    all(-(va * vb) + one, unit * unit);
    all(one + -(va * vb), unit * unit);
    all(fma(va, vb, -one), -unit * unit);
    all(fma_of_minus(va, vb, one), unit * unit);
    V sum = one;
    sum -= va * vb;
    all(sum, unit * unit);
    sum = -one;
    sum += va * vb;
    all(sum, -unit * unit);
    all(va * vb - two * V(T(0.5)), -unit * unit);  // of two products the left one
    all(two * V(T(0.5)) - va * vb, T(0));
    all((va * vb) * two, T(2));  // a product of a product takes the rounded one
    all(max(va * vb, T(0)), T(1));
    all(sqrt(va * vb), T(1));
    all(select(va > vb, va * vb, one), T(1));
  };
  check(Wide<TestType, 16>());
  check(Wide<TestType, 8>());
  check(NativeWide<TestType>());
}

TEST_CASE("the sum of lanes adds halves", "[wide][fast]") {
  float a[16];
  for (int n = 0; n < 16; ++n) a[n] = float(n * n);
  CHECK(sum(Wide<float, 16>::load(a)) == 1240.0f);
  CHECK(sum(Wide<double, 4>(2.5)) == 10.0);
  CHECK(sum(Wide<double, 16>(2.5)) == 40.0);
  // The order of additions, by numbers that lose digits in any other: of 16 lanes n meets n + 8, then n + 4, n + 2, n + 1.
  double b[16];
  for (int n = 0; n < 16; ++n) b[n] = std::sin(1.0 + 7.0 * n) * std::pow(10.0, n % 5);
  double expected[16];
  std::copy(b, b + 16, expected);
  for (int half = 8; half > 0; half /= 2)
    for (int n = 0; n < half; ++n) expected[n] += expected[n + half];
  CHECK(sum(Wide<double, 16>::load(b)) == expected[0]);
}

TEMPLATE_TEST_CASE("comparisons of lanes select lane by lane", "[wide][fast]", float, double) {
  const auto check = []<class V>(V) {
    using T = typename V::Scalar;
    T a[V::size], b[V::size];
    for (int n = 0; n < V::size; ++n) a[n] = T(n % 3), b[n] = T((n + 1) % 2);
    const V va = V::load(a), vb = V::load(b);
    for (int n = 0; n < V::size; ++n) {
      CHECK((va < vb)[n] == (a[n] < b[n]));
      CHECK((va <= vb)[n] == (a[n] <= b[n]));
      CHECK((va > vb)[n] == (a[n] > b[n]));
      CHECK((va >= vb)[n] == (a[n] >= b[n]));
      CHECK(((va > 0.5) & !(vb > 0.5))[n] == (a[n] > T(0.5) && !(b[n] > T(0.5))));
      CHECK(((va > 1.5) | (vb > 0.5))[n] == (a[n] > T(1.5) || b[n] > T(0.5)));
      CHECK(select(va < vb, va, vb)[n] == std::min(a[n], b[n]));
      CHECK(select(va < vb, va, 7.0)[n] == (a[n] < b[n] ? a[n] : T(7)));
      CHECK(abs(va - vb)[n] == std::abs(a[n] - b[n]));
      CHECK(max(va, 1.0)[n] == std::max(a[n], T(1)));
    }
    CHECK(any(va > 1.5));
    CHECK_FALSE(any(va > 2.5));
    CHECK_FALSE(any(!(va > -1.0)));
  };
  check(Wide<TestType, 8>());
  check(NativeWide<TestType>());
}

TEST_CASE("lanes are read and written one by one, in halves too", "[wide][fast]") {
  Wide<double, 16> w(1.0);
  w.v[3] = 5.0;
  w.v[12] = 7.0;
  CHECK(double(w.v[3]) == 5.0);
  CHECK(w[12] == 7.0);
  CHECK(sum(w) == 26.0);
}
