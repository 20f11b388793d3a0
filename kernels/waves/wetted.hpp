// The part of a solid that lies under a plane: the vocabulary of exact buoyancy.
// Equations: docs/theory/sea_engineering.md, section 1. Used by wetted_cylinder.hpp, wetted_frustum.hpp and src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

/// A plane water surface; `normal` is a unit vector that points out of the water.
struct WaterPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;  ///< normal . x of the points x of the surface [m]

  /// Distance of a point above the surface [m], negative under water.
  double height(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

/// The plane through (x, y, elevation) that rises by slope_x, slope_y [-] per metre of x and y.
inline WaterPlane tangent_plane(double x, double y, double elevation, double slope_x, double slope_y) {
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-slope_x, -slope_y, 1.0) / std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
  return {normal, normal.dot(Eigen::Vector3d(x, y, elevation))};
}

/// Volume under water [m3] and its first moment [m4] about the origin of the axes in use; centre = moment / volume.
/// Buoyancy needs no division: the force rho g V along z has the moment rho g (first_moment x z).
struct Wetted {
  double volume = 0.0;
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
};

/// A point of a circle by the angle from the direction in which the surface plane is left fastest upwards.
struct RimPoint {
  double angle, sine, cosine;
};

/// Where the chord `distance` from the centre of a circle meets it, both multiplied by any common factor >= 0: at angle 0 when
/// the chord lies beyond the far side, at pi beyond the near one. Never divides by zero: radius 0 only compares.
inline RimPoint rim_point(double distance, double radius) {
  if (distance >= radius) return {0.0, 0.0, 1.0};
  if (distance <= -radius) return {pi, 0.0, -1.0};
  const double cosine = distance / radius, sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return {std::atan2(sine, cosine), sine, cosine};
}

/// Integrals over the part of the unit disc at x < cosine of the rim point, i.e. angles from it to pi (x = cos, dA = 2 sin^2
/// d(angle)): area, first and second moment in x.
struct SegmentMoments {
  double area, first, second;
};
inline SegmentMoments segment_moments(const RimPoint& rim) {
  const double s = rim.sine, c = rim.cosine, rest = pi - rim.angle;
  return {rest + s * c, -2.0 / 3.0 * s * s * s, 0.25 * (rest + s * c * (1.0 - 2.0 * s * s))};
}

}  // namespace spindrift::waves
