// Laws of kernels/rotor/fourier.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/fourier.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;

TEST_CASE("a Fourier series is the sum it stands for, whatever the lengths of its lists", "[rotor][fast]") {
  const std::array cosine{3.0, -1.0};
  const std::array sine{0.5, 2.0, -4.0, 0.0, 1.5};
  const double a = GENERATE(-7.0, 0.0, 0.3, 2.0, 400.0);
  const double sum = 10.0 + 3 * std::cos(a) - std::cos(2 * a) + 0.5 * std::sin(a) + 2 * std::sin(2 * a) - 4 * std::sin(3 * a) +
                     1.5 * std::sin(5 * a);
  CHECK(fourier(10.0, cosine, sine, a) == Approx(sum).epsilon(1e-13));
  CHECK(fourier(10.0, {}, {}, a) == 10.0);
}

TEST_CASE("the mean over a turn is the mean of the series, and its harmonics are those given", "[rotor][fast]") {
  const std::array cosine{3.0, -1.0, 0.2};
  const std::array sine{0.5, 2.0};
  constexpr int n = 64;
  double mean = 0.0, second_cosine = 0.0, second_sine = 0.0;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * pi * i / n, f = fourier(7.0, cosine, sine, a);
    mean += f / n, second_cosine += 2 * f * std::cos(2 * a) / n, second_sine += 2 * f * std::sin(2 * a) / n;
  }
  CHECK(mean == Approx(7.0).epsilon(1e-14));
  CHECK(second_cosine == Approx(-1.0));
  CHECK(second_sine == Approx(2.0));
}
