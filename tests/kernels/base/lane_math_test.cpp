// Accuracy of kernels/base/lane_math.hpp against the C library, and the fixed sequence of kernels/base/random.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/lane_math.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kernels/base/random.hpp"

using namespace spindrift;

TEST_CASE("lane sine and cosine are those of the C library to two units in the last place of one", "[base][fast]") {
  Random random(5);
  double worst = 0.0;
  for (int n = 0; n < 40000; ++n) {
    Lanes x, s, c;
    for (int i = 0; i < lanes; ++i) x.v[i] = (random.uniform() - 0.5) * 2.0 * std::pow(10.0, 8.0 * random.uniform() - 2.0);
    lane_sincos(x, s, c);
    for (int i = 0; i < lanes; ++i) {
      worst = std::max({worst, std::abs(s[i] - std::sin(x[i])), std::abs(c[i] - std::cos(x[i]))});
    }
  }
  CHECK(worst <= 2.0 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("random bits are the published sequence of SplitMix64 and fill the unit interval evenly", "[base][fast]") {
  Random random(1234567);
  CHECK(random.bits() == 6457827717110365317u);
  CHECK(random.bits() == 3203168211198807973u);
  CHECK(random.bits() == 9817491932198370423u);
  double mean = 0.0, square = 0.0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    mean += u / n, square += u * u / n;
  }
  CHECK(mean == Approx(0.5).margin(0.004));
  CHECK(square == Approx(1.0 / 3.0).margin(0.004));
}
