// Laws of kernels/mooring/line_spring_damper.hpp, then the lines of Leble & Barakos (2016), Table 3.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_spring_damper.hpp"

#include <catch2/catch.hpp>

#include "stiffness_check.hpp"

using namespace spindrift;
using Eigen::Vector3d;

TEST_CASE("a two-way line pulls when long and pushes when short, along its chord", "[mooring][fast]") {
  const LineSpringDamper line{.rest_length = 5.0, .stiffness_N_m = 100.0, .damping = 0.0};
  const double length = GENERATE(4.0, 5.0, 6.5);
  const Vector3d chord = Vector3d(2, -1, 2) / 3;
  const LineForces f = line.forces(length * chord, Vector3d::Zero());
  CHECK(f.fairlead_tension == Approx(100.0 * (length - 5.0)).margin(1e-12));
  CHECK((f.on_fairlead + f.fairlead_tension * chord).norm() == Approx(0.0).margin(1e-12));
  CHECK((f.on_fairlead + f.on_anchor).norm() == 0.0);
}

TEST_CASE("a tension-only line never pushes and carries nothing when slack", "[mooring][fast]") {
  const LineSpringDamper line{.rest_length = 5.0, .stiffness_N_m = 100.0, .damping = 30.0, .tension_only = true};
  const double length = GENERATE(0.0, 1.0, 4.999, 5.0, 5.01, 7.0), rate = GENERATE(-50.0, -1.0, 0.0, 1.0, 50.0);
  const Vector3d x = Vector3d::UnitX();
  const LineForces f = line.forces(length * x, rate * x);
  CHECK(f.fairlead_tension >= 0.0);
  CHECK(f.on_fairlead.dot(x) <= 0.0);
  if (length <= 5.0) CHECK(f.fairlead_tension == 0.0);
}

TEST_CASE("the damper takes energy out whichever way the ends move, and sideways motion costs nothing", "[mooring][fast]") {
  LineSpringDamper line{.rest_length = 5.0, .stiffness_N_m = 100.0, .damping = 30.0};
  LineSpringDamper spring = line;
  spring.damping = 0.0;
  const Vector3d span(4, 3, 2), rate = GENERATE(Vector3d(1, 2, 3), Vector3d(-2, 0, 1), Vector3d(0, 0, -4));
  const double power = (line.forces(span, rate).on_fairlead - spring.forces(span, rate).on_fairlead).dot(rate);
  const double stretching = rate.dot(span.normalized());
  CHECK(power == Approx(-30.0 * stretching * stretching));
  CHECK((line.forces(span, {-3, 4, 0}).on_fairlead - spring.forces(span, {-3, 4, 0}).on_fairlead).norm() < 1e-12);
}

TEST_CASE("stiffness of a spring line agrees with differences, geometric part included", "[mooring][fast]") {
  const LineSpringDamper line{.rest_length = 5.0, .stiffness_N_m = 100.0, .damping = 0.0, .tension_only = GENERATE(false, true)};
  const Vector3d span = GENERATE(Vector3d(4, 3, 2), Vector3d(0, 0, -7), Vector3d(1, 1, 0));
  const Eigen::Matrix3d k = line.stiffness(span);
  CHECK((k - difference_stiffness(line, span, 1e-3)).norm() < 1e-8 * 100.0);
  CHECK((k - k.transpose()).norm() < 1e-12);
}

TEST_CASE("a line of no length has no direction and no force", "[mooring][fast]") {
  const LineSpringDamper line{.rest_length = 5.0, .stiffness_N_m = 100.0, .damping = 3.0};
  CHECK(line.forces(Vector3d::Zero(), {1, 2, 3}).on_fairlead == Vector3d::Zero());
}

TEST_CASE("the paper's three lines: surge and heave stiffness 1.5 k cos2 and 3 k sin2 at the relaxed length", "[mooring][fast]") {
  // Fairleads on a circle of 46.7 m at z = -7, anchors at 162.6 m and z = -20.6; l0 = 116.73 m, EA = 4e8 N (Leble & Barakos 2016,
  // Table 3).
  const double k = 4e8 / 116.73, angle = std::atan2(20.6 - 7.0, 162.6 - 46.7);
  CHECK(k == Approx(3.427e6).epsilon(1e-4));
  const LineSpringDamper line{.rest_length = std::hypot(13.6, 115.9), .stiffness_N_m = k, .damping = 4e4};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (double azimuth : {0.0, 2.0943951023931953, 4.1887902047863905})
    sum += line.stiffness({-115.9 * std::cos(azimuth), -115.9 * std::sin(azimuth), 13.6});
  CHECK(sum(0, 0) == Approx(1.5 * k * std::pow(std::cos(angle), 2)));
  CHECK(sum(1, 1) == Approx(sum(0, 0)));
  CHECK(sum(2, 2) == Approx(3 * k * std::pow(std::sin(angle), 2)));
  CHECK(sum(0, 2) == Approx(0.0).margin(1e-6 * k));
}
