// The beam between two bodies: its frequencies, its energy, and that its forces are what its energy says.
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/beam/modal_link.hpp"
#include "kernels/rigid/rotation.hpp"

using namespace spindrift;
using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

const beam::Properties properties{{0.0, 2.0}, {3.0, 2.0}, {5.0, 4.0}, {7.0, 6.0}, {5e3, 4e3}, {4.0, 4.0}};

beam::ModalLink link(std::array<double, 2> damping = {0, 0}) {
  return make_modal_link(properties, {.x = {2.0, 0.3, 0.2}, .y = {2.0, 0.3, 0.4}, .inertia_z = 0.3, .damping = damping});
}

beam::End placed(const Vector3d& centre, const Vector3d& turned, const Vector3d& arm, const Vector3d& velocity = {0, 0, 0},
                 const Vector3d& spin = {0, 0, 0}) {
  const Matrix3d axes = rotation_exp(turned).toRotationMatrix();
  return {centre, centre + axes * arm, axes, velocity, spin};
}

/// The bodies after a time with constant velocity and spin.
beam::End moved(const beam::End& e, double t) {
  beam::End m = e;
  const Matrix3d turn = rotation_exp(t * e.spin).toRotationMatrix();
  m.centre += t * e.velocity;
  m.point = m.centre + turn * (e.point - e.centre);
  m.axes = turn * e.axes;
  return m;
}

const beam::End start = placed({0.1, -0.2, 0.3}, {0.3, -0.2, 0.5}, {0.1, 0.2, 0.4}, {0.2, 0.1, -0.3}, {0.4, -0.6, 0.5});
/// Bent by about a tenth of the length.
const beam::End end = [] {
  const Matrix3d turn = start.axes * rotation_exp({0.1, 0.15, -0.05}).toRotationMatrix();
  const Vector3d point = start.point + start.axes * Vector3d(0.2, -0.12, 1.97), arm(0.1, -0.1, 0.2);
  return beam::End{point - turn * arm, point, turn, {-0.3, 0.4, 0.1}, {-0.3, 0.5, 0.7}};
}();

}  // namespace

TEST_CASE("a link clamped at its start with a body at its end vibrates in the modes of the beam", "[beam][fast]") {
  const beam::ModalLink l = link();
  const beam::End base = placed({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  const beam::End tip = placed({0, 0, 2.15}, {0, 0, 0}, {0, 0, -0.15});
  Eigen::MatrixXd mass = dynamics(l, base, tip, {0, 0, 0}).mass.bottomRightCorner<6, 6>();
  mass.diagonal() += (Eigen::VectorXd(6) << 2, 2, 2, 0.4 - 2 * 0.15 * 0.15, 0.2 - 2 * 0.15 * 0.15, 0.3).finished();
  Eigen::MatrixXd stiffness(6, 6);
  constexpr double step = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const auto at = [&](double way) {
      beam::End t = tip;
      (k < 3 ? t.velocity[k] : t.spin[k - 3]) = 1.0;
      t = moved(t, way);
      t.velocity.setZero(), t.spin.setZero();
      return Eigen::VectorXd(dynamics(l, base, t, {0, 0, 0}).loads.tail<6>());
    };
    stiffness.col(k) = (at(-step) - at(step)) / (2 * step);
  }
  CHECK((stiffness - stiffness.transpose()).norm() < 1e-6 * stiffness.norm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(stiffness, mass);
  std::vector<double> expected{l.x.omega[0], l.x.omega[1], l.y.omega[0], l.y.omega[1]};
  for (const double omega : expected) {
    double nearest = 1e300;
    for (int k = 0; k < 6; ++k) nearest = std::min(nearest, std::abs(std::sqrt(eigen.eigenvalues()[k]) / omega - 1.0));
    CHECK(nearest < 2e-5);
  }
}

TEST_CASE("rate and bias of the deformation are its derivatives along the bodies' motion", "[beam][fast]") {
  const beam::ModalLink l = link();
  const auto at = [&](double t) { return deformation(l, moved(start, t), moved(end, t)); };
  constexpr double step = 1e-4;
  const beam::Deformation now = at(0.0);
  CHECK(((at(step).value - at(-step).value) / (2 * step) - now.rate).norm() < 1e-7);
  CHECK(((at(step).value - 2 * now.value + at(-step).value) / (step * step) - now.bias).norm() < 2e-6);
}

TEST_CASE("loads of a bent, moving link follow from its energies (Lagrange's equations)", "[beam][fast]") {
  // Power of all loads - mass * acceleration without accelerations = -d/dt (elastic + weight + kinetic energy).
  const beam::ModalLink l = link();
  const Vector3d gravity(0.5, 0.3, -9.8);
  const auto energy = [&](double t) {
    const beam::End a = moved(start, t), b = moved(end, t);
    return elastic_energy(l, deformation(l, a, b)) + kinetic_energy(l, a, b) + potential_energy(l, a, b, gravity);
  };
  beam::Vector12 motion;
  motion << start.velocity, start.spin, end.velocity, end.spin;
  constexpr double step = 1e-5;
  const double rate = (energy(step) - energy(-step)) / (2 * step);
  CHECK(dynamics(l, start, end, gravity).loads.dot(motion) == Approx(-rate).epsilon(1e-7));
}

TEST_CASE("a link loads nothing when both bodies move as one, but by its weight and inertia", "[beam][fast]") {
  const beam::ModalLink l = link({0.02, 0.03});
  beam::End tip = start;
  tip.point = start.point + start.axes * Vector3d(0, 0, 2.0);
  tip.centre = tip.point + Vector3d(0.1, 0.3, 0.2);
  tip.velocity = start.velocity + start.spin.cross(tip.centre - start.centre);
  const beam::Deformation d = deformation(l, start, tip);
  CHECK(d.value.norm() < 1e-14);
  CHECK(d.rate.norm() < 1e-14);
  const Vector3d gravity(0, 0, -9.8);
  beam::LinkDynamics all = dynamics(l, start, tip, gravity);
  beam::Vector12 centripetal = beam::Vector12::Zero();  // both turn as one about the first
  centripetal.segment<3>(6) = start.spin.cross(start.spin.cross(tip.centre - start.centre));
  all.loads -= all.mass * centripetal;
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero(), inertia = Vector3d::Zero();
  for (const beam::Station& s : l.stations) {
    const Vector3d arm = start.point - start.centre + start.axes * Vector3d(0, 0, s.height);
    mass += s.mass, moment += s.mass * arm;
    inertia += s.mass * start.spin.cross(start.spin.cross(arm));
  }
  CHECK(mass == Approx(5.0));
  CHECK((all.loads.segment<3>(0) + all.loads.segment<3>(6) - (mass * gravity - inertia)).norm() < 1e-10);
  const Vector3d about_start =
      all.loads.segment<3>(3) + all.loads.segment<3>(9) + (tip.centre - start.centre).cross(Vector3d(all.loads.segment<3>(6)));
  Vector3d expected = moment.cross(gravity);
  for (const beam::Station& s : l.stations) {
    const Vector3d arm = start.point - start.centre + start.axes * Vector3d(0, 0, s.height);
    expected -= s.mass * arm.cross(start.spin.cross(start.spin.cross(arm)));
  }
  CHECK((about_start - expected).norm() < 1e-10);
}
