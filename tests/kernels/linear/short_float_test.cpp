// Sixteen bits of a float: nearest, ties to even, and what is no number stays none.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/linear/short_float.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using spindrift::linear::load_eight;
using spindrift::linear::ShortFloat;

TEST_CASE("a short float is the nearest of its kind, in the range of floats", "[linear][fast]") {
  for (const float x : {1.0f, -1.5f, 3.140625f, 1e-37f, -2.5e38f, 7.1e-3f, 123456.0f, 0.0f}) {
    const float back = float(ShortFloat(x));
    CHECK(std::abs(back - x) <= std::ldexp(std::abs(x), -9));
    CHECK(float(ShortFloat(back)) == back);
  }
  CHECK(float(ShortFloat(1.0f + 0x1p-8f)) == 1.0f);                 // halfway: to even
  CHECK(float(ShortFloat(1.0f + 0x1p-7f + 0x1p-8f)) == 1.015625f);  // halfway: to even, which is above
  CHECK(float(ShortFloat(1.0f + 0x1p-8f + 0x1p-20f)) == 1.0f + 0x1p-7f);
  CHECK(std::signbit(float(ShortFloat(-0.0f))));
  constexpr float infinity = std::numeric_limits<float>::infinity();
  CHECK(float(ShortFloat(-infinity)) == -infinity);
  CHECK(std::isnan(float(ShortFloat(std::numeric_limits<float>::quiet_NaN()))));
  CHECK(std::isnan(float(ShortFloat(std::bit_cast<float>(0x7fffffffu)))));
}

TEST_CASE("eight short floats are read as they are one by one", "[linear][fast]") {
  ShortFloat numbers[9];
  for (int n = 0; n < 9; ++n) numbers[n] = ShortFloat(std::ldexp(1.0f + 0.37f * float(n), n - 4) * (n % 2 == 0 ? 1.0f : -1.0f));
  for (int first = 0; first < 2; ++first) {
    const auto eight = load_eight(numbers + first);
    for (int n = 0; n < 8; ++n) CHECK(eight[n] == float(numbers[first + n]));
  }
}
