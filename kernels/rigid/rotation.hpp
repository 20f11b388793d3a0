// Finite rotations: exponential map, its right Jacobian, Euler angles for output, tilt and yaw for linear stiffness.
// Formulas: Rodrigues; right Jacobian of SO(3) after Iserles et al. (2000), Lie-group methods, Acta Numerica 9, and Chirikjian
// (2012). Used by the bodies' step (charts of kernels/rigid/partition.hpp) and by output; tested in tests/kernels/rigid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace spindrift {

/// Matrix of the cross product, skew(a) b = a x b.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d s;
  s << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return s;
}

/// Unit quaternion of the rotation vector theta [rad] (axis times angle).
inline Eigen::Quaterniond rotation_exp(const Eigen::Vector3d& theta) {
  const double half = 0.5 * theta.norm();
  const double sinc_half = half < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : 0.5 * std::sin(half) / half;
  Eigen::Quaterniond q(std::cos(half), sinc_half * theta.x(), sinc_half * theta.y(), sinc_half * theta.z());
  return q;
}

/// With attitude q = q0 exp(theta), the angular velocity in body axes is omega = T(theta) d(theta)/dt; this is T.
inline Eigen::Matrix3d rotation_rate_matrix(const Eigen::Vector3d& theta) {
  const double a2 = theta.squaredNorm(), a = std::sqrt(a2);
  double first, second;  // (1 - cos a)/a2 and (a - sin a)/a3; series below 0.25 rad are exact to round-off
  if (a < 0.25) {
    first = 0.5 - a2 * (1.0 / 24 - a2 * (1.0 / 720 - a2 * (1.0 / 40320 - a2 / 3628800)));
    second = 1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 * (1.0 / 362880 - a2 / 39916800)));
  } else {
    first = (1.0 - std::cos(a)) / a2;
    second = (a - std::sin(a)) / (a2 * a);
  }
  const Eigen::Matrix3d s = skew(theta);
  return Eigen::Matrix3d::Identity() - first * s + second * (s * s);
}

/// d(theta)/dt = T(theta)^-1 omega, without forming T; valid for |theta| < 2 pi.
inline Eigen::Vector3d rotation_rate(const Eigen::Vector3d& theta, const Eigen::Vector3d& omega) {
  const double a2 = theta.squaredNorm(), a = std::sqrt(a2);
  const double c = a < 0.25 ? 1.0 / 12 + a2 * (1.0 / 720 + a2 * (1.0 / 30240 + a2 * (1.0 / 1209600 + a2 / 47900160)))
                            : (1.0 - 0.5 * a / std::tan(0.5 * a)) / a2;
  const Eigen::Vector3d turned = theta.cross(omega);
  return omega + 0.5 * turned + c * theta.cross(turned);
}

/// Roll, pitch, yaw [rad] of an attitude, sequence yaw-pitch-roll (Z-Y'-X''); pitch in [-pi/2, pi/2].
inline Eigen::Vector3d euler_angles(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

/// Attitude of roll, pitch, yaw [rad], the inverse of euler_angles.
inline Eigen::Quaterniond attitude(const Eigen::Vector3d& roll_pitch_yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(roll_pitch_yaw.z(), Vector3d::UnitZ()) * AngleAxisd(roll_pitch_yaw.y(), Vector3d::UnitY()) *
         AngleAxisd(roll_pitch_yaw.x(), Vector3d::UnitX());
}

/// Tilt and yaw [rad] of an attitude: a yaw about the vertical, then a tilt about a level axis, whose components along x and y
/// come first. The tilt of a body turned about its own axis stays what it is. Yaw in [-pi, pi].
inline Eigen::Vector3d tilt_and_yaw(const Eigen::Quaterniond& q) {
  const double side = q.w() < 0.0 ? -1.0 : 1.0, upright = std::hypot(q.w(), q.z());
  // q without its yaw, (w, z) / upright: the axis of the tilt times the sine of its half.
  const double c = upright > 0.0 ? q.w() / upright : 1.0, s = upright > 0.0 ? q.z() / upright : 0.0;
  const double x = c * q.x() - s * q.y(), y = c * q.y() + s * q.x(), sine = std::hypot(x, y);
  const double scale = sine > 0.0 ? 2.0 * std::atan2(sine, upright) / sine : 2.0;
  return {scale * x, scale * y, 2.0 * std::atan2(side * q.z(), side * q.w())};
}

}  // namespace spindrift
