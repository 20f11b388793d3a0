// Laws of kernels/rigid/wrench.hpp and motion.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/wrench.hpp"

#include <catch2/catch.hpp>

#include "kernels/rigid/motion.hpp"

using namespace spindrift;

TEST_CASE("the moment of a force is its lever arm crossed with it, about any point", "[rigid][fast]") {
  Wrench w{{0, 0, 0}, {0, 0, 0}, {1, 2, 3}};
  w.add_force({0, 0, 10}, {3, 2, 3});
  CHECK((w.moment - Eigen::Vector3d(0, -20, 0)).norm() == Approx(0.0).margin(1e-15));
  const Wrench there = w.about({3, 2, 3});
  CHECK(there.moment.norm() == Approx(0.0).margin(1e-15));
  CHECK((there.about(w.point).moment - w.moment).norm() == Approx(0.0).margin(1e-15));
}

TEST_CASE("the power of a load is the same about every point of a rigid body", "[rigid][fast]") {
  Motion m;
  m.position = {10, -3, 5};
  m.attitude = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized());
  m.velocity = {1, -2, 0.5};
  m.omega = {0.3, 0.1, -0.4};
  const Eigen::Vector3d arm(2, 7, -1), force(4, 5, -6);
  Wrench w{{0, 0, 0}, {0, 0, 0}, m.position};
  w.add_force(force, m.point(arm));
  const double at_centre = w.force.dot(m.velocity) + w.moment.dot(m.omega_earth());
  CHECK(at_centre == Approx(force.dot(m.point_velocity(arm))));
}
