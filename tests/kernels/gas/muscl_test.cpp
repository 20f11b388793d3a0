// Reconstruction: exact for what its order promises, order on smooth data, limits at jumps, positive states.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/muscl.hpp"

#include <catch2/catch.hpp>

#include "tests/kernels/gas/states.hpp"
#include "tests/order.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

TEST_CASE("without limiter cell averages of a parabola give its face values", "[gas][fast]") {
  const auto average = [](double x) { return 1.0 + 2.0 * x + 3.0 * (x * x + 1.0 / 12.0); };  // cells of size 1 round x
  const double face = reconstruct(Unlimited{}, average(0), average(1), average(2));
  CHECK(face == Approx(1.0 + 2.0 * 1.5 + 3.0 * 2.25).epsilon(1e-14));
}

TEMPLATE_TEST_CASE("a limited face value lies between the cells at a jump or extremum", "[gas][fast]", VanAlbada, VanLeer,
                   Minmod) {
  Generator g;
  for (int n = 0; n < 1000; ++n) {
    const double a = g.between(-1, 1), b = g.between(-1, 1), c = g.between(-1, 1), value = reconstruct(TestType{}, a, b, c);
    // Van Albada's may pass the mean of the cells slightly (Anderson et al. 1986), never the neighbour.
    CHECK(value >= std::min(b, c) - 1e-15);
    CHECK(value <= std::max(b, c) + 1e-15);
    if ((b - a) * (c - b) <= 0.0) CHECK(value == Approx(b).margin(1e-15));
  }
  CHECK(reconstruct(TestType{}, 1.0, 1.0, 1.0) == 1.0);
  CHECK(reconstruct(TestType{}, 1.0, 2.0, 3.0) == Approx(2.5));
}

// The interpolation error at faces between averages of a sine: its mean where the slope is at least half the largest, and its
// largest value anywhere. At an extremum a limited value is the cell's, h/2 from the face: an error of second order.
TEMPLATE_TEST_CASE("limited values have their order on a monotone stretch, and second order at extrema", "[gas][fast]", Unlimited,
                   VanAlbada, VanLeer, Minmod) {
  std::vector<double> h, monotone, largest;
  for (const int cells : {32, 64, 128, 256}) {
    const double size = 2.0 * M_PI / cells;
    const auto average = [&](int i) { return (std::cos(i * size) - std::cos((i + 1) * size)) / size; };
    double sum = 0, worst = 0;
    int steep = 0;
    for (int i = 0; i < cells; ++i) {
      const double error =
          std::abs(reconstruct(TestType{}, average(i - 1), average(i), average(i + 1)) - std::sin((i + 1) * size));
      worst = std::max(worst, error);
      if (std::abs(std::cos((i + 0.5) * size)) > 0.5) sum += error, ++steep;
    }
    h.push_back(size), monotone.push_back(sum / steep), largest.push_back(worst);
  }
  const bool third = std::is_same_v<TestType, Unlimited> || std::is_same_v<TestType, VanAlbada>;
  CHECK(observed_order(h, monotone) > (third ? 2.9 : 1.9));
  CHECK(observed_order(h, largest) > (std::is_same_v<TestType, Unlimited> ? 2.9 : 1.9));
}

TEMPLATE_TEST_CASE("limiting does not depend on the units of the variable", "[gas][fast]", VanAlbada, VanLeer, Minmod) {
  Generator g;
  const double scale = 1e-7;
  for (int n = 0; n < 100; ++n) {
    const double a = g.between(-1, 1), b = g.between(-1, 1), c = g.between(-1, 1);
    CHECK(scale * reconstruct(TestType{}, a, b, c) ==
          Approx(reconstruct(TestType{}, scale * a, scale * b, scale * c)).margin(1e-13 * scale));
  }
}

TEST_CASE("a state that would lose its pressure falls back to its cell", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  const auto at = [&](double p, double T) {
    return Primitive<double>{p - gas.pressure_reference, 10.0, 0.0, 0.0, T - gas.temperature_reference};
  };
  // From 8e5 through 1e5 to 0.9e5 the unlimited value on the far side of the middle cell is negative.
  const auto f = muscl(gas, Unlimited{}, at(8e5, 300), at(1e5, 300), at(0.9e5, 300), at(0.9e5, 300));
  CHECK(f.l.p == at(1e5, 300).p);
  CHECK(absolute_pressure(gas, f.r) == Approx((0.9 + 0.1 / 3.0) * 1e5));
  const auto both = muscl(gas, Unlimited{}, at(1e5, 3000), at(1e5, 300), at(1e5, 300), at(1e5, 3000));
  CHECK(both.l.T == at(1e5, 300).T);
  CHECK(both.r.T == at(1e5, 300).T);
  const auto smooth = muscl(gas, Unlimited{}, at(1e5, 300), at(1.1e5, 310), at(1.2e5, 320), at(1.3e5, 330));
  CHECK(absolute_pressure(gas, smooth.l) == Approx(1.15e5));
  CHECK(absolute_temperature(gas, smooth.r) == Approx(315.0));

  using V = Wide<double, 8>;  // lanes decide for themselves
  double p[4][V::size];
  for (int k = 0; k < V::size; ++k)
    p[0][k] = (k % 2 ? 8e5 : 1.1e5) - gas.pressure_reference, p[1][k] = 1e5 - gas.pressure_reference,
    p[2][k] = p[3][k] = 0.9e5 - gas.pressure_reference;
  const auto lane = [&](int c) { return Primitive<V>{V::load(p[c]), V(0.0), V(0.0), V(0.0), V(0.0)}; };
  const auto w = muscl(gas, Unlimited{}, lane(0), lane(1), lane(2), lane(3));
  for (int k = 0; k < V::size; ++k) CHECK((w.l.p[k] == p[1][k]) == (k % 2 == 1));
}
