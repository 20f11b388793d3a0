// Laws of src/aero/prescribed.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/prescribed.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

TEST_CASE("harmonics of the passages of three blades repeat three times a turn", "[aero][fast]") {
  AeroOptions o;
  o.thrust_N = 1.5e6, o.thrust_cosine_N = {-3e4, 1e4}, o.thrust_sine_N = {2e3};
  o.torque_N_m = 1e7, o.torque_sine_N_m = {1e5};
  o.harmonic_step = 3;
  const Prescribed load(o);
  double mean = 0.0;
  for (int i = 0; i < 90; ++i) {
    const double azimuth = 2 * pi * i / 90;
    CHECK(load(0.0, azimuth).thrust == Approx(load(5.0, azimuth + 2 * pi / 3).thrust));
    CHECK(load(0.0, azimuth).torque == Approx(1e7 + 1e5 * std::sin(3 * azimuth)));
    mean += load(0.0, azimuth).thrust / 90;
  }
  CHECK(mean == Approx(1.5e6));
  CHECK(load(0.0, 0.0).thrust == Approx(1.5e6 - 3e4 + 1e4));
}

TEST_CASE("a table in time passes its rows, linear or smooth, and holds its ends", "[aero][fast]") {
  AeroOptions o;
  o.table = data_file("thrust.csv", "time_s,thrust_N,torque_N_m\n1,0,10\n2,100,10\n4,140,30\n5,140,50\n");
  o.interpolation = GENERATE("linear", "cubic");
  const Prescribed load(o);
  CHECK(load(0.0, 0.0).thrust == 0.0);
  CHECK(load(2.0, 0.0).thrust == Approx(100.0));
  CHECK(load(4.0, 9.0).torque == Approx(30.0));
  CHECK(load(99.0, 0.0).thrust == Approx(140.0));
  CHECK(load(99.0, 0.0).torque == Approx(50.0));
  if (o.interpolation == "linear") CHECK(load(3.0, 0.0).thrust == Approx(120.0));
  if (o.interpolation == "cubic") CHECK(load(3.0, 0.0).thrust > 121.0);  // the curve bends where the line does not
  CHECK(load(4.5, 0.0).thrust == Approx(140.0));                         // and does not overshoot
}

TEST_CASE("a thrust table without torque has none; one without time is refused", "[aero][fast]") {
  AeroOptions o;
  o.table = data_file("no_torque.csv", "time_s,thrust_N\n0,5\n1,6\n");
  CHECK(Prescribed(o)(0.5, 0.0).torque == 0.0);
  CHECK(Prescribed(o)(0.5, 0.0).thrust == Approx(5.5));
  const auto refused = [&](const std::string& text) {
    o.table = data_file("bad.csv", text);
    Prescribed load(o);
  };
  CHECK_THROWS_WITH(refused("t,thrust_N\n0,5\n1,6\n"), Contains("\"t\""));
  CHECK_THROWS_WITH(refused("time_s,thrust_N\n1,5\n1,6\n"), Contains("must be above 1"));
  CHECK_THROWS_WITH(refused("time_s,thrust_N\n1,5\n"), Contains("at least 2 rows"));
  CHECK_THROWS_WITH(refused("time_s,torque_N_m\n1,5\n2,6\n"), Contains("needs a column \"thrust_N\""));
}
