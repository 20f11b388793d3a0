// Wind over height against the formulas' own consequences and published ratios. SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/wind_profile.hpp"

#include <catch2/catch.hpp>

using namespace spindrift;

TEST_CASE("the power law doubles its logarithm with the square of height, and is one at the reference", "[rotor][fast]") {
  const WindProfile p{.law = WindLaw::power, .reference_height = 119.0, .least_height = 1.0, .exponent = 0.2};
  CHECK(p.share(119.0) == 1.0);
  const double z = GENERATE(12.0, 30.0, 119.0, 208.0);
  CHECK(p.share(z * z / 119.0) == Approx(p.share(z) * p.share(z)).epsilon(1e-14));
  CHECK(p.share(208.0) / p.share(30.0) == Approx(1.47296).epsilon(1e-4));  // (208/30)^0.2
}

TEST_CASE("the logarithmic law has the slope u* / (kappa z): the same step of speed for each doubling of height",
          "[rotor][fast]") {
  const WindProfile p{.law = WindLaw::logarithmic, .reference_height = 100.0, .least_height = 1.0, .roughness = 1e-2};
  CHECK(p.share(100.0) == 1.0);
  const double z = GENERATE(2.0, 20.0, 150.0), step = 0.07525749891599529;  // ln 2 / ln 1e4
  CHECK(p.share(2.0 * z) - p.share(z) == Approx(step).epsilon(1e-12));
}

TEST_CASE("below its least height the wind is as there, under water too; a uniform one is one everywhere", "[rotor][fast]") {
  const auto law = GENERATE(WindLaw::power, WindLaw::logarithmic);
  const WindProfile p{.law = law, .reference_height = 119.0, .least_height = 10.0};
  CHECK(p.share(10.0) < 1.0);
  CHECK(p.share(10.0) > 0.5);
  for (const double z : {9.0, 0.0, -300.0}) CHECK(p.share(z) == p.share(10.0));
  CHECK(p.share(10.1) > p.share(10.0));
  for (const double z : {-300.0, 0.0, 119.0}) CHECK(WindProfile{}.share(z) == 1.0);
}
