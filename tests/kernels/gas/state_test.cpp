// Primitive and conserved variables: textbook values, round trips, digits at low Mach number; the gas's properties.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/state.hpp"

#include <catch2/catch.hpp>

#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

TEST_CASE("with references of zero the variables are those of the textbook", "[gas][fast]") {
  const IdealGas gas;
  const Primitive<double> q{101325.0, 30.0, -20.0, 10.0, 288.15};
  const auto c = conserved(gas, q);
  CHECK(c.rho == Approx(101325.0 / (287.05 * 288.15)).epsilon(1e-15));
  CHECK(c.E == Approx(101325.0 / 0.4 + 0.5 * c.rho * 1400.0).epsilon(1e-14));
  CHECK(sound_speed(gas, q) == Approx(340.29).margin(0.01));  // ICAO standard atmosphere
  CHECK(viscosity(gas, 288.15) == Approx(1.789e-5).epsilon(2e-3));
  IdealGas constant = gas;
  constant.viscosity = {.mu0 = 0.01, .constant = true};
  CHECK(viscosity(constant, 500.0) == 0.01);
}

TEST_CASE("conserved variables go back to primitive ones", "[gas][fast]") {
  for (const IdealGas& gas : {absolute_air(), gauge_air()}) {
    Generator g;
    for (int n = 0; n < 200; ++n) {
      const auto q = g.state(gas), back = primitive(gas, conserved(gas, q));
      CHECK(back.p == Approx(q.p).margin(1e-12 * (absolute_pressure(gas, q) + 1e5 + density(gas, q) * kinetic(q))));
      CHECK(back.u == Approx(q.u).epsilon(1e-13));
      CHECK(back.T == Approx(q.T).margin(1e-12 * (600.0 + kinetic(q) / 700.0)));
    }
  }
}

TEST_CASE("rows of component-major storage load and store states", "[gas][fast]") {
  using V = Wide<double, 8>;
  constexpr int n = 2 * V::size;
  double from[5 * n], to[5 * n] = {};
  for (int k = 0; k < 5 * n; ++k) from[k] = k;
  store_primitive(to + 3, n, load_primitive<V>(from + 3, n));
  CHECK(to[2] == 0.0);
  CHECK(to[3] == 3.0);
  CHECK(to[4 * n + 3 + V::size - 1] == 4 * n + 3 + V::size - 1);
  const auto one = load_conserved<double>(from + 1, n);
  CHECK(one.rho == 1.0);
  CHECK(one.E == 4 * n + 1.0);
}
