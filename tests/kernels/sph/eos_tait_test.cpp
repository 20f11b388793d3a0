// Laws of kernels/sph/eos_tait.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/eos_tait.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::sph;

TEST_CASE("the Tait pressure is B((rho/rho0)^7 - 1), also for a density one part in 1e12 away", "[sph][fast]") {
  const EosTait eos{1025.0, 40.0};
  for (double d : {-30.0, -1.0, 0.5, 20.0, 300.0}) {
    CHECK(eos.pressure(d) == Approx(eos.stiffness() * (std::pow(1.0 + d / eos.rho0, 7.0) - 1.0)).epsilon(1e-12));
  }
  CHECK(eos.pressure(1e-9) == Approx(eos.c0 * eos.c0 * 1e-9).epsilon(1e-9));
  CHECK(eos.pressure(1e-9f) == Approx(eos.c0 * eos.c0 * 1e-9).epsilon(1e-6));
}

TEST_CASE("the inverse of the Tait equation gives back the density deviation", "[sph][fast]") {
  const EosTait eos{1000.0, 34.0};
  for (double d : {-100.0, -1e-6, 0.0, 1e-8, 3.0, 150.0})
    CHECK(eos.deviation(eos.pressure(d)) == Approx(d).epsilon(1e-10).margin(1e-15));
}

TEST_CASE("the sound speed of the Tait equation is sqrt(dp/drho)", "[sph][fast]") {
  const EosTait eos{1000.0, 34.0};
  const double d = GENERATE(-50.0, 0.0, 80.0), e = 1e-3;
  const double slope = (eos.pressure(d + e) - eos.pressure(d - e)) / (2.0 * e);
  CHECK(eos.sound_speed(d) == Approx(std::sqrt(slope)).epsilon(1e-8));
}

TEST_CASE("hydrostatic density balances the weight of the compressible column", "[sph][fast]") {
  const EosTait eos{1000.0, 20.0};
  const double depth = GENERATE(0.1, 2.0, 15.0), g = 9.81, e = 1e-4;
  const double slope =
      (eos.pressure(eos.hydrostatic_deviation(depth + e, g)) - eos.pressure(eos.hydrostatic_deviation(depth - e, g))) / (2.0 * e);
  CHECK(slope == Approx((eos.rho0 + eos.hydrostatic_deviation(depth, g)) * g).epsilon(1e-7));
  CHECK(eos.hydrostatic_deviation(0.0, g) == 0.0);
}
