// Laws of kernels/rigid/rotation.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/rotation.hpp"

#include <catch2/catch.hpp>

using namespace spindrift;
using Eigen::Vector3d;

TEST_CASE("the rate matrix turns the rate of a rotation vector into the angular velocity in body axes", "[rigid][fast]") {
  const double size = GENERATE(1e-9, 1e-3, 0.2499, 0.2501, 1.0, 2.5);
  const Vector3d theta = size * Vector3d(1, -2, 0.5).normalized(), rate(0.3, 0.7, -0.2);
  const double h = 1e-6;
  const Eigen::Quaterniond turned = rotation_exp(theta - h * rate).conjugate() * rotation_exp(theta + h * rate);
  const Vector3d omega = turned.vec() / h;  // 2 vec(q) over 2 h
  CHECK((rotation_rate_matrix(theta) * rate - omega).norm() < 1e-9);
  CHECK((rotation_rate(theta, rotation_rate_matrix(theta) * rate) - rate).norm() < 1e-14);
}

TEST_CASE("series and closed form of the rotation formulas meet to round-off", "[rigid][fast]") {
  const Vector3d axis = Vector3d(2, 1, -1).normalized(), omega(0.1, 0.5, 0.9);
  const Vector3d below = (0.25 - 1e-14) * axis, above = (0.25 + 1e-14) * axis;
  CHECK((rotation_rate_matrix(below) - rotation_rate_matrix(above)).norm() < 3e-14);
  CHECK((rotation_rate(below, omega) - rotation_rate(above, omega)).norm() < 3e-14);
}

TEST_CASE("the exponential of a rotation vector is a unit quaternion of its angle and axis", "[rigid][fast]") {
  const double angle = GENERATE(0.0, 1e-12, 1.9e-4, 2.1e-4, 0.3, 3.0);
  const Vector3d axis = Vector3d(-1, 3, 2).normalized();
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle, axis)), q = rotation_exp(angle * axis);
  CHECK((q.coeffs() - expected.coeffs()).norm() < 1e-15);
}

TEST_CASE("Euler angles and attitude are inverses, and pitch is positive nose down about y", "[rigid][fast]") {
  const Vector3d angles(0.2, -1.3, 2.5);
  CHECK((euler_angles(attitude(angles)) - angles).norm() < 1e-14);
  CHECK((attitude({0, 0.1, 0}) * Vector3d::UnitX()).z() < 0.0);  // the downwind side goes down
}

TEST_CASE("a tilt after a yaw is told apart from it, whatever the yaw", "[rigid][fast]") {
  const double yaw = GENERATE(0.0, 0.5, -2.5, 3.1), angle = GENERATE(0.0, 1e-9, 0.4, 2.0);
  const Vector3d tilt = angle * Vector3d(0.6, -0.8, 0.0);
  Eigen::Quaterniond q = rotation_exp(tilt) * rotation_exp({0, 0, yaw});
  for (int sign = 0; sign < 2; ++sign, q.coeffs() *= -1.0) CHECK((tilt_and_yaw(q) - tilt - Vector3d(0, 0, yaw)).norm() < 1e-14);
}
