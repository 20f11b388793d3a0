// The law of the wall: linear at the wall, logarithmic away from it, and inverted to rounding.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/wall_law.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::turbulence;

TEST_CASE("the law of the wall is linear at the wall and logarithmic away from it", "[turbulence][fast]") {
  for (const double y : {1e-3, 0.1, 1.0}) CHECK(wall_law(y) == Approx(y).epsilon(0.06));
  CHECK(wall_law(1e-4) == Approx(1e-4).epsilon(1e-2));
  // u+ = ln(y+)/.41 + 5.6 within the range where Reichardt's constants mean it
  for (const double y : {100.0, 1e3, 1e4}) CHECK(wall_law(y) == Approx(std::log(y) / 0.41 + 5.6).epsilon(0.02));
}

TEST_CASE("the slope of the law of the wall is that of its values", "[turbulence][fast]") {
  for (const double y : {1e-3, 0.1, 1.0, 5.0, 12.0, 40.0, 300.0}) {
    const double d = 1e-4 * y;
    CHECK(wall_law_slope(y) == Approx((wall_law(y + d) - wall_law(y - d)) / (2.0 * d)).epsilon(1e-6));
  }
}

TEST_CASE("friction follows from speed and distance as the law says, in the sublayer and far out", "[turbulence][fast]") {
  const double nu = 1.5e-5;
  for (const double u : {0.05, 1.0, 4.0})
    for (const double y_plus : {0.1, 3.0, 12.0, 60.0, 3000.0}) {
      const double distance = y_plus * nu / u, speed = u * wall_law(y_plus);
      CHECK(friction_velocity(speed, distance, nu) == Approx(u).epsilon(1e-12));
      CHECK(wall_viscosity(speed, distance, 1.2, 1.2 * nu) * speed / distance == Approx(1.2 * u * u).epsilon(1e-12));
    }
  CHECK(wall_viscosity(0.0, 1e-3, 1.2, 1.8e-5) == 1.8e-5);
  CHECK(friction_velocity(0.0, 1e-3, 1.5e-5) == 0.0);
}

TEST_CASE("turbulence of the law of the wall: made as in the logarithmic layer far out, none at the wall", "[turbulence][fast]") {
  const double nu = 1.5e-5, u = 0.5;
  for (const double y_plus : {300.0, 3000.0}) {
    const double y = y_plus * nu / u;
    CHECK(wall_law_production(u, y, nu) == Approx(u * u * u / (0.41 * y)).epsilon(0.02));
    CHECK(wall_omega(u, y, nu, 0.075) == Approx(u / (0.3 * 0.41 * y)).epsilon(0.01));
  }
  const double near = 0.1 * nu / u;
  CHECK(wall_law_production(u, near, nu) < 0.15 * u * u * u * u / nu);
  CHECK(wall_law_production(0.0, near, nu) == 0.0);
  CHECK(wall_omega(u, near, nu, 0.075) == Approx(6.0 * nu / (0.075 * near * near)).epsilon(0.01));
  // Its most is a quarter of u^4 / nu, where half the stress is turbulent, at y+ about 11.
  double most = 0.0, place = 0.0;
  for (double y_plus = 1.0; y_plus < 100.0; y_plus *= 1.01)
    if (const double made = wall_law_production(u, y_plus * nu / u, nu); made > most) most = made, place = y_plus;
  CHECK(most == Approx(0.25 * u * u * u * u / nu).epsilon(1e-3));
  CHECK(place == Approx(11.0).margin(2.0));
}
