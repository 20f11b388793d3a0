// Laws of kernels/base/wide.hpp: lane arithmetic is the arithmetic of one number.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/wide.hpp"

#include <catch2/catch.hpp>
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
  CHECK(V(TestType(-0.0))[3] == TestType(0));
  CHECK(std::signbit(V(TestType(-0.0))[3]));
}

TEMPLATE_TEST_CASE("reciprocals of lanes are right within three units in the last place", "[wide][fast]", float, double) {
  using V = NativeWide<TestType>;
  const TestType unit = std::numeric_limits<TestType>::epsilon();
  for (double x = 1e-12; x < 1e12; x *= 1.37) {
    const TestType exact = TestType(1) / TestType(x), root = TestType(1 / std::sqrt(double(TestType(x))));
    CHECK(std::abs(reciprocal(V(x))[1] - exact) <= 3 * unit * exact);
    CHECK(std::abs(inverse_sqrt(V(x))[1] - root) <= 3 * unit * root);
  }
}

TEST_CASE("the sum of lanes adds halves", "[wide][fast]") {
  float a[16];
  for (int n = 0; n < 16; ++n) a[n] = float(n * n);
  CHECK(sum(Wide<float, 16>::load(a)) == 1240.0f);
  CHECK(sum(Wide<double, 4>(2.5)) == 10.0);
  CHECK(sum(Wide<double, 16>(2.5)) == 40.0);
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
