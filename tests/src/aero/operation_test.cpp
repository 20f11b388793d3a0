// Operating tables: what lies between and beyond their rows, and the torque law that holds their tip-speed ratio.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/operation.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using namespace spindrift::aero;

TEST_CASE("an operating table is straight between its rows and holds its ends", "[aero][fast]") {
  const Operation table{{4.0, 7.0, 12.0}, {0.6, 0.6, 1.0}, {0.1, 0.0, 0.2}, {}};
  CHECK(table.at(1.0).speed == 0.6);
  CHECK(table.at(9.5).speed == Approx(0.8));
  CHECK(table.at(9.5).pitch == Approx(0.1));
  CHECK(table.at(30.0).speed == 1.0);
  CHECK_FALSE(table.torque_gain());
}

TEST_CASE("the torque gain is what a constant power coefficient at a constant tip-speed ratio makes of it", "[aero][fast]") {
  const double gain = GENERATE(1e3, 1.2e7);
  Operation table;
  for (double wind : {3.0, 4.0, 6.0, 8.0, 12.0, 14.0}) {
    const double speed = std::clamp(0.1 * wind, 0.4, 1.2);
    table.wind.push_back(wind), table.speed.push_back(speed), table.pitch.push_back(0.0);
    table.power.push_back(std::min(gain * speed * speed * speed, gain));
  }
  REQUIRE(table.torque_gain());
  CHECK(*table.torque_gain() == Approx(gain));
  CHECK(table.below_rated().wind.back() == 8.0);
}

TEST_CASE("the DTU turbine's table of 2013 wants a torque gain of 1.22e7 N m s2 and has its published pitch", "[aero][fast]") {
  const Operation table = read_operation(SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_operation.csv");
  CHECK(*table.torque_gain() == Approx(1.2236e7).epsilon(2e-3));  // rho pi R^5 C_P / (2 lambda^3), C_P .476, lambda 7.5
  CHECK(table.at(6.0).pitch == Approx(0.896 * radians_per_degree));
  CHECK(table.at(13.0).pitch == Approx(7.266 * radians_per_degree));
  CHECK(table.at(20.0).pitch == Approx(17.618 * radians_per_degree));
  CHECK(table.below_rated().wind.back() == 11.0);
}

TEST_CASE("a table without powers has rated power where its speed first is the greatest", "[aero][fast]") {
  const Operation table{{6.0, 8.0, 9.0, 12.0, 20.0}, {2.1, 2.8, 3.14, 3.14, 3.14}, {0.0, 0.0, 0.0, 0.16, 0.35}, {}};
  CHECK(table.below_rated().wind == std::vector{6.0, 8.0});
  CHECK(table.below_rated().pitch.back() == 0.0);
  CHECK(Operation{{6.0, 20.0}, {3.14, 3.14}, {0.0, 0.35}, {}}.below_rated().wind.empty());
}
