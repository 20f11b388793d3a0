// What history.csv says of a body's motion: src/coupling/recorder.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/recorder.hpp"

#include <catch2/catch.hpp>

#include "kernels/rigid/rotation.hpp"

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

/// A body that flies and turns steadily: everything known in closed form.
Motion steady(double t) {
  const Eigen::Vector3d omega(0.3, -0.2, 0.5);
  Motion m;
  m.position = Eigen::Vector3d(10, 2, -3) + t * Eigen::Vector3d(1, -2, 0.5);
  m.velocity = {1, -2, 0.5};
  m.attitude = rotation_exp(t * omega);  // about a fixed axis, so body and earth components of omega agree
  m.omega = omega;
  return m;
}

}  // namespace

TEST_CASE("velocity and acceleration of the reference point are the rates of its displacement", "[coupling][fast]") {
  const Eigen::Vector3d point(4, -7, 12);
  const double t = 1.3, h = 1e-4;
  const auto at = [&](double when) {
    return reference_motion(steady(when), steady(0.0), point, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  };
  const ReferenceMotion now = at(t), before = at(t - h), after = at(t + h);
  CHECK(((after.displacement - before.displacement) / (2 * h) - now.velocity).norm() < 1e-7);
  CHECK(((after.velocity - before.velocity) / (2 * h) - now.acceleration).norm() < 1e-7);
  CHECK(at(0.0).displacement.norm() == Approx(0.0).margin(1e-14));
}

TEST_CASE("angles are those since the start, in the order yaw, pitch, roll", "[coupling][fast]") {
  Motion start;
  start.attitude = attitude({0.4, -0.3, 1.1});
  Motion now = start;
  now.attitude = attitude({0.1, 0.09, -0.2}) * start.attitude;
  const ReferenceMotion m =
      reference_motion(now, start, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  CHECK((m.angles - Eigen::Vector3d(0.1, 0.09, -0.2)).norm() < 1e-14);
}
