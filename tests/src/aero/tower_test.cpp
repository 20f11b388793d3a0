// The tower in the wind: potential flow round a cylinder, drag of a cylinder, both where the tower is.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/tower.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include "kernels/base/constants.hpp"
#include "kernels/rotor/tower_flow.hpp"
#include "src/aero/wind.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
const TowerFrame start{{-5.0, 0.0, 90.0}, x, z, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
const TowerOptions options{.stations = {{10.0, 6.0, 1.0}, {90.0, 4.0, 0.6}}};

}  // namespace

TEST_CASE("the flow round the tower is without sources and rotation, and follows its surface", "[aero][fast]") {
  const double h = 1e-5;
  for (double px : {-3.0, -1.2, 2.0})
    for (double py : {0.5, 1.7}) {
      const auto flow = [](double a, double b) { return tower_flow(a, b); };
      const double divergence =
          (flow(px + h, py).along - flow(px - h, py).along + flow(px, py + h).across - flow(px, py - h).across) / (2 * h);
      const double rotation =
          (flow(px + h, py).across - flow(px - h, py).across - flow(px, py + h).along + flow(px, py - h).along) / (2 * h);
      CHECK(divergence == Approx(0.0).margin(1e-8));
      CHECK(rotation == Approx(0.0).margin(1e-8));
    }
  for (double angle : {0.3, 1.0, 2.5}) {
    const TowerFlow f = tower_flow(std::cos(angle), std::sin(angle));
    CHECK((1.0 + f.along) * std::cos(angle) + f.across * std::sin(angle) == Approx(0.0).margin(1e-12));
  }
  CHECK(tower_flow(-1.0, 0.0).along == -1.0);  // stagnation
  CHECK(tower_flow(0.0, 1.0).along == 1.0);
}

TEST_CASE("the tower's wake has lost the momentum of its drag, begins without a jump beside it and is not before it",
          "[aero][fast]") {
  for (const double downwind : {3.0, 10.0}) {
    double lost = 0.0;
    for (int i = 0; i < 4000; ++i) lost -= tower_wake(downwind, -10.0 + 0.005 * (i + 0.5), 0.8) * 0.005;
    // rho U^2 times the loss over the width = rho U^2 Cd R; the wake's width follows the distance from the axis, not from the
    // plane.
    CHECK(lost == Approx(0.8).epsilon(downwind > 5.0 ? 0.01 : 0.1));
  }
  CHECK(tower_wake(-3.0, 0.0, 0.8) == 0.0);
  CHECK(tower_wake(1e-9, 1.0, 0.8) == 0.0);
  CHECK(tower_wake(4.0, 0.0, 0.8) == Approx(-0.4));
  CHECK(tower_wake(2.0, 0.0, 0.8) == -0.5);  // not 0.57: half of the wind at most
  CHECK(tower_wake(2.0, 1.0, 0.8) > -0.5);
  // A downwind rotor's blade meets it: tower of 5 m there, drag coefficient 0.8, blade 10 m behind the axis.
  const Tower tower(options, start, 1.225);
  const double radius = 2.5, x_in_radii = 4.0, wake = 0.8 / std::sqrt(x_in_radii), round = 1.0 / (x_in_radii * x_in_radii);
  CHECK(tower.disturbed(start, 10.0 * x, {x_in_radii * radius, 0.0, 50.0}).x() == Approx(10.0 * (1.0 - round - wake)));
}

TEST_CASE("before the tower the wind is slower, above it and below its foot it is not", "[aero][fast]") {
  const Tower tower(options, start, 1.225);
  const Eigen::Vector3d wind = 10.0 * x;
  // Halfway up the radius is 2.5 m.
  CHECK(tower.disturbed(start, wind, {-5.0, 0.0, 50.0}).x() == Approx(10.0 * (1.0 - 0.25)));
  CHECK(tower.disturbed(start, wind, {-5.0, 0.0, 120.0}) == wind);
  CHECK(tower.disturbed(start, wind, {-5.0, 0.0, 5.0}) == wind);
  // A tower that has moved and turned with its carrier disturbs the same wind in its own frame the same way.
  TowerFrame moved = start;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  const Eigen::Vector3d shift(7.0, -3.0, 2.0), point(-4.0, 1.5, 60.0);
  moved.hub = turn * start.hub + shift, moved.axis = turn * x, moved.up = turn * z;
  CHECK((tower.disturbed(moved, turn * wind, turn * point + shift) - turn * tower.disturbed(start, wind, point)).norm() < 1e-9);
}

TEST_CASE("drag of the tower is that of its pieces in the wind that they meet", "[aero][fast]") {
  const Tower tower(options, start, 1.225);
  const Wind wind{8.0 * x};
  const TowerLoad load = tower.drag(start, wind, 0.0);
  // Both fall in a straight line, by .4 and 2 m: the mean of their product is that of the means and a twelfth of .4 times 2 m.
  CHECK(load.force.x() == Approx(0.5 * 1.225 * (0.8 * 5.0 + 0.4 * 2.0 / 12.0) * 80.0 * 64.0).epsilon(1e-4));
  TowerFrame running = start;
  running.hub_velocity = 8.0 * x;
  CHECK(tower.drag(running, wind, 0.0).force.norm() == 0.0);
}

TEST_CASE("a tower of two rows has the drag of one of many in sheared wind", "[aero][fast]") {
  TowerOptions coarse{.stations = {{0.0, 8.3, 0.6}, {115.0, 5.5, 0.6}}}, fine;
  for (int n = 0; n <= 400; ++n) fine.stations.push_back({115.0 * n / 400, 8.3 - 2.8 * n / 400, 0.6});
  const TowerFrame frame{119.0 * z, x, z, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Wind wind{10.0 * x, {WindLaw::power, 119.0, 10.0, 0.14, 0.0}};
  const TowerLoad two = Tower(coarse, frame, 1.225).drag(frame, wind, 0.0),
                  many = Tower(fine, frame, 1.225).drag(frame, wind, 0.0);
  CHECK(two.force.x() == Approx(many.force.x()).epsilon(1e-3));
  CHECK(two.moment.y() == Approx(many.moment.y()).epsilon(1e-3));
}
