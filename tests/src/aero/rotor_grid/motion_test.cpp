// The rotor's grid carried by hub and spin: velocities are the rates of positions, distances stay.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/motion.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "kernels/rigid/rotation.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

RotorPose pose(double t) {
  RotorPose p;
  const Eigen::Vector3d spin(0.02, -0.05, 0.03);  // body axes, constant
  p.hub.position = {0.4 * t, 0.1 * t, 90.0 + 0.2 * t};
  p.hub.velocity = {0.4, 0.1, 0.2};
  p.hub.attitude = attitude({0.1, 0.2, -0.3}) * rotation_exp(spin * t);
  p.hub.omega = spin;
  p.speed = 0.92, p.azimuth = 0.3 + 0.92 * t;
  return p;
}

}  // namespace

TEST_CASE("velocities of the rotor's nodes are the rates of their positions", "[rotor_grid][fast]") {
  const Eigen::Vector3d x(-3.0, 4.0, 80.0);
  const double h = 1e-4;
  const Eigen::Vector3d rate = (pose(2.0 + h).point(x) - pose(2.0 - h).point(x)) / (2.0 * h);
  CHECK((rate - pose(2.0).velocity(x)).norm() < 1e-6);
}

TEST_CASE("a placed grid keeps its distances and turns the way the rotor does", "[rotor_grid][fast]") {
  const std::vector<Eigen::Vector3d> nodes{{0, 0, 0}, {0, 0, 89}, {-7, 3, 60}};
  std::vector<Eigen::Vector3d> earth(nodes.size());
  place_nodes(pose(11.0), nodes, earth);
  CHECK((earth[1] - earth[2]).norm() == Approx((nodes[1] - nodes[2]).norm()).epsilon(1e-14));
  RotorPose quarter;
  quarter.azimuth = 0.5 * std::acos(-1.0);
  place_nodes(quarter, nodes, earth);
  CHECK((earth[1] - Eigen::Vector3d(0, -89, 0)).norm() < 1e-12);  // blade 1 from up to the right, seen from upwind
}
