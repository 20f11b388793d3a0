// Laws of kernels/mooring/line_table.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_table.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "kernels/mooring/line_spring_damper.hpp"
#include "stiffness_check.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {
struct FibreRope {  // slack to 100 m, then stiffening
  std::array<double, 5> distance{100.0, 102.0, 104.0, 106.0, 108.0}, tension{0.0, 1e5, 3e5, 8e5, 2e6}, slope;
  FibreRope() { monotone_slopes(distance, tension, slope); }
  LineTable line() const { return {distance, tension, slope}; }
};
}  // namespace

TEST_CASE("a tabulated line gives its table, stays slack below and goes on straight beyond", "[mooring][fast]") {
  const FibreRope rope;
  for (std::size_t i = 0; i < 5; ++i) CHECK(rope.line().at(rope.distance[i]).value == Approx(rope.tension[i]).margin(1e-9));
  CHECK(rope.line().at(60.0).value == 0.0);
  CHECK(rope.line().at(110.0).value == Approx(2e6 + 2.0 * rope.slope[4]));
  CHECK(rope.slope[4] > 6e5);
}

TEST_CASE("tension rises with distance between the rows too", "[mooring][fast]") {
  const FibreRope rope;
  double last = 0.0;
  for (double d = 99.0; d < 112.0; d += 0.01) {
    const double t = rope.line().at(d).value;
    CHECK(t >= last);
    last = t;
  }
}

TEST_CASE("a table of a linear spring is that spring, and its stiffness agrees with differences", "[mooring][fast]") {
  const std::array distance{5.0, 6.0, 10.0}, tension{0.0, 100.0, 500.0};
  std::array<double, 3> slope;
  monotone_slopes(distance, tension, slope);
  const LineTable table{distance, tension, slope};
  const LineSpringDamper spring{.rest_length = 5.0, .stiffness_N_m = 100.0, .tension_only = true};
  const Vector3d span = GENERATE(Vector3d(4, 3, 5), Vector3d(0, 0, -7), Vector3d(1, 1, 0), Vector3d(9, 9, 1));
  CHECK((table.forces(span, Vector3d::Zero()).on_fairlead - spring.forces(span, Vector3d::Zero()).on_fairlead).norm() < 1e-10);
  CHECK((table.stiffness(span) - spring.stiffness(span)).norm() < 1e-10);
  const FibreRope rope;
  const Vector3d at(60, 70, 52);  // 105.85 m
  CHECK((rope.line().stiffness(at) - difference_stiffness(rope.line(), at, 1e-3)).norm() < 1e-4);
}
