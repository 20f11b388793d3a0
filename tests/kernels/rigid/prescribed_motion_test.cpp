// Laws of kernels/rigid/prescribed_motion.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/prescribed_motion.hpp"

#include <catch2/catch.hpp>

using namespace spindrift;

TEST_CASE("rate and acceleration of a prescribed motion are the derivatives of its value", "[rigid][fast]") {
  const std::vector<double> times{0.0, 0.5, 1.5, 2.0, 4.0}, values{1.0, -1.0, 2.0, 2.5, 0.0};
  const PrescribedMotion motion{
      .start = 0.3, .rate = 2.0, .amplitude = 0.7, .omega = 3.0, .phase = 0.4, .table = CubicTable(times, values)};
  const double t = GENERATE(0.2, 0.5, 1.1, 1.9, 3.3), h = 1e-4;
  const Drive before = motion.at(t - h), now = motion.at(t), after = motion.at(t + h);
  CHECK(now.rate == Approx((after.value - before.value) / (2 * h)).margin(1e-6));
  CHECK(now.acceleration == Approx((after.rate - before.rate) / (2 * h)).margin(3e-3));  // a knot has a kink in the acceleration
}

TEST_CASE("a table motion passes its points, is smooth at them and rests beyond its ends", "[rigid][fast]") {
  const std::vector<double> times{0.0, 1.0, 3.0, 4.0}, values{1.0, 2.0, 0.0, 5.0};
  const CubicTable table(times, values);
  for (std::size_t k = 0; k < times.size(); ++k) CHECK(table.at(times[k]).value == Approx(values[k]).margin(1e-14));
  CHECK(table.at(1.0 - 1e-12).acceleration == Approx(table.at(1.0 + 1e-12).acceleration).margin(1e-9));
  CHECK(table.at(-1.0).value == 1.0);
  CHECK(table.at(9.0).value == 5.0);
  CHECK(table.at(9.0).rate == 0.0);
  for (const double end : {0.0, 4.0}) {  // where a run begins or ends with it, it moves
    const double inside = end == 0.0 ? 1e-7 : 4.0 - 1e-7;
    CHECK(table.at(end).rate == Approx(table.at(inside).rate).margin(1e-5));
    CHECK(std::abs(table.at(end).rate) > 0.5);
  }
  CHECK(table.at(4.0 + 1e-12).rate == table.at(4.0).rate);
  CHECK(table.at(4.0 + 1e-6).rate == 0.0);
  const std::vector<double> two{0.0, 2.0}, line{1.0, 5.0};
  CHECK(CubicTable(two, line).at(0.5).value == Approx(2.0));
  CHECK(CubicTable(two, line).at(0.5).rate == Approx(2.0));
}
