// A mode under forces whose answer is known. SPDX-License-Identifier: Apache-2.0
#include "kernels/beam/oscillator.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using spindrift::beam::Oscillator;

TEST_CASE("a free mode fades and swings as the exact solution, in steps of any length", "[fast]") {
  const Oscillator mode{3.0, 0.4};
  const double swing = std::sqrt(9.0 - 0.04);
  for (const int steps : {1, 7, 200}) {
    Oscillator::State s{1.0, 0.0};
    for (int n = 0; n < steps; ++n) s = mode.advance(s, 0.0, 0.0, 2.5 / steps);
    CHECK(s.x == Approx(std::exp(-0.5) * (std::cos(2.5 * swing) + 0.2 / swing * std::sin(2.5 * swing))).epsilon(1e-12));
    CHECK(s.v == Approx(-9.0 * std::exp(-0.5) * std::sin(2.5 * swing) / swing).epsilon(1e-12));
  }
}

TEST_CASE("under a force that grows linearly a mode follows the exact solution", "[fast]") {
  const Oscillator mode{2.0, 0.0};
  // x'' + 4 x = t from rest: x = t / 4 - sin(2 t) / 8.
  Oscillator::State s{0.0, 0.0};
  for (int n = 0; n < 10; ++n) s = mode.advance(s, 0.13 * n, 0.13 * (n + 1), 0.13);
  CHECK(s.x == Approx(1.3 / 4.0 - std::sin(2.6) / 8.0).epsilon(1e-12));
  CHECK(s.v == Approx(0.25 - std::cos(2.6) / 4.0).epsilon(1e-12));
}

TEST_CASE("a force that oscillates is followed to second order in the step", "[fast]") {
  const auto error = [](int steps) {  // x'' + 4 x = cos(t): x = (cos t - cos 2t) / 3
    const Oscillator mode{2.0, 0.0};
    const double h = 4.0 / steps;
    Oscillator::State s{0.0, 0.0};
    for (int n = 0; n < steps; ++n) s = mode.advance(s, std::cos(h * n), std::cos(h * (n + 1)), h);
    return std::abs(s.x - (std::cos(4.0) - std::cos(8.0)) / 3.0);
  };
  CHECK(error(40) / error(80) == Approx(4.0).epsilon(0.05));
}
