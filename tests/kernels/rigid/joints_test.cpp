// Jacobian, velocity side and acceleration side of every joint's constraints against differences of their residuals.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/joints.hpp"

#include <catch2/catch.hpp>

#include "kernels/rigid/rotation.hpp"

using namespace spindrift;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

/// A body on a path with constant linear acceleration and a rotation vector that is quadratic in time.
struct Path {
  Vector3d position, velocity, acceleration;
  Quaterniond attitude;
  Vector3d omega, alpha;  // body axes, at t = 0

  Pose at(double t) const {
    const Quaterniond q = attitude * rotation_exp(t * omega + 0.5 * t * t * alpha);
    const Vector3d body_rate = rotation_rate_matrix(t * omega + 0.5 * t * t * alpha) * (omega + t * alpha);
    return {q.toRotationMatrix(), position + t * velocity + 0.5 * t * t * acceleration, velocity + t * acceleration,
            q * body_rate};
  }
};

const Path first{{1, 2, 3}, {0.1, -0.3, 0.2}, {0.5, 0.1, -0.4}, attitude({0.3, -0.2, 0.9}), {0.4, -0.6, 0.3}, {0.2, 0.5, -0.7}};
const Path second{{-1, 0.5, 2},     {-0.2, 0.4, 0.7}, {-0.3, 0.6, 0.2}, attitude({-0.7, 0.5, 0.1}),
                  {-0.5, 0.2, 0.8}, {-0.1, 0.3, 0.6}};
const Path still{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, Quaterniond::Identity(), {0, 0, 0}, {0, 0, 0}};

std::vector<Constraint> constraints_of(JointType type) {
  // Frames that do not fit each other: residuals are not zero, so every term of the formulas counts.
  const Vector3d a = Vector3d(1, 2, -1).normalized(), b = perpendicular_to(a);
  const Vector3d c = Vector3d(-2, 1, 1).normalized(), d = perpendicular_to(c);
  const JointFrame on_i{{0.3, -0.2, 0.5}, a, b, a.cross(b)}, on_j{{-0.4, 0.6, 0.1}, c, d, c.cross(d)};
  std::vector<Constraint> all;
  append_joint(type, 0, 1, on_i, on_j, turns(type) ? 0 : -1, slides(type) ? 0 : -1, 0, all);
  return all;
}

}  // namespace

TEST_CASE("constraint Jacobians, velocity and acceleration sides match differences", "[rigid][fast]") {
  const auto type = GENERATE(JointType::fixed, JointType::revolute, JointType::spherical, JointType::universal,
                             JointType::translational, JointType::cylindrical, JointType::planar);
  const int grounded = GENERATE(0, 1, 2);  // none, first, second body is the earth
  const Path& i = grounded == 1 ? still : first;
  const Path& j = grounded == 2 ? still : second;
  const PrescribedMotion drive{.start = 0.2, .rate = 0.5, .amplitude = 0.3, .omega = 2.0, .phase = 0.1};
  INFO(joint_type_names[std::size_t(type)]);
  for (const Constraint& c : constraints_of(type)) {
    const Drive now = c.driver >= 0 ? drive.at(0.0) : Drive{};
    const auto along = [&](double t) { return residual(c, i.at(t), j.at(t), c.driver >= 0 ? drive.at(t) : Drive{}); };
    const ConstraintRows rows = jacobian(c, i.at(0), j.at(0), now);
    const int n = c.rows();
    // Jacobian: move one body by a small translation or rotation vector.
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](const Path& path, bool turn, double step) {
        Path other = path;
        if (turn)
          other.attitude = path.attitude * rotation_exp(step * Vector3d::Unit(k));
        else
          other.position += step * Vector3d::Unit(k);
        return other.at(0);
      };
      for (bool turn : {false, true}) {
        const Vector3d by_i =
            (residual(c, moved(i, turn, h), j.at(0), now) - residual(c, moved(i, turn, -h), j.at(0), now)) / (2 * h);
        const Vector3d by_j =
            (residual(c, i.at(0), moved(j, turn, h), now) - residual(c, i.at(0), moved(j, turn, -h), now)) / (2 * h);
        CHECK(((turn ? rows.rotation_i : rows.translation_i).col(k) - by_i).head(n).norm() < 1e-9);
        CHECK(((turn ? rows.rotation_j : rows.translation_j).col(k) - by_j).head(n).norm() < 1e-9);
      }
    }
    const auto times_jacobian = [&](const Vector3d& vi, const Vector3d& wi, const Vector3d& vj, const Vector3d& wj) -> Vector3d {
      return rows.translation_i * vi + rows.rotation_i * wi + rows.translation_j * vj + rows.rotation_j * wj;
    };
    // d(residual)/dt = C u - nu and d2(residual)/dt2 = C du/dt - gamma along the paths.
    const double s = 1e-4;
    const Vector3d rate = (along(s) - along(-s)) / (2 * s), second_rate = (along(s) - 2 * along(0) + along(-s)) / (s * s);
    const Vector3d by_rate = times_jacobian(i.velocity, i.omega, j.velocity, j.omega) - velocity_side(c, i.at(0), j.at(0), now);
    const Vector3d by_acceleration =
        times_jacobian(i.acceleration, i.alpha, j.acceleration, j.alpha) - acceleration_side(c, i.at(0), j.at(0), now);
    CHECK((rate - by_rate).head(n).norm() < 1e-7);
    CHECK((second_rate - by_acceleration).head(n).norm() < 1e-6);
  }
}

TEST_CASE("a joint takes away the freedoms its name says", "[rigid][fast]") {
  const auto count = [](JointType type) {
    std::vector<Constraint> all;
    append_joint(type, 0, 1, {}, {}, -1, -1, 0, all);
    int rows = 0;
    for (const Constraint& c : all) rows += c.rows();
    return rows;
  };
  CHECK(count(JointType::fixed) == 6);
  CHECK(count(JointType::revolute) == 5);
  CHECK(count(JointType::translational) == 5);
  CHECK(count(JointType::cylindrical) == 4);
  CHECK(count(JointType::universal) == 4);
  CHECK(count(JointType::spherical) == 3);
  CHECK(count(JointType::planar) == 3);
}

TEST_CASE("a joint's angle continues over full turns", "[rigid][fast]") {
  CHECK(unwrapped(-3.0, 3.0) == Approx(2 * pi - 3.0));
  CHECK(unwrapped(3.0, 100.0) == Approx(3.0 + 2 * pi * 15));
  const JointFrame frame;
  Pose turned;
  turned.axes = Eigen::AngleAxisd(0.7, Vector3d::UnitX()).toRotationMatrix();
  CHECK(joint_angle(frame, frame, Pose{}, turned) == Approx(0.7));
}
