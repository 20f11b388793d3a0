// Nearest point of a triangle to a point, by the region of the triangle's plane the point projects into (Ericson 2005, Real-Time
// Collision Detection, 5.1.5). Called by src/aero/grid/wall_distance.cpp and kernels/rigid/closed_surface.cpp; tested in
// tests/kernels/grid/nearest_point_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

namespace spindrift {

inline Eigen::Vector3d nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? Eigen::Vector3d(a + std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) * ab) : a;
}

/// Of a triangle a b c: the point nearest to another, and where on it that lies.
struct NearestOnTriangle {
  Eigen::Vector3d point;
  int corner = -1;  ///< 0, 1, 2; -1: not at one
  int side = -1;    ///< from corner `side` to the next; -1: not on one
};

/// Triangles without area are treated as their longest edge or point, where that is not told.
inline NearestOnTriangle nearest_place_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                                   const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, -1, 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, -1, 2};
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), -1, 1};
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) {
    const Eigen::Vector3d best[] = {nearest_on_segment(p, a, b), nearest_on_segment(p, a, c), nearest_on_segment(p, b, c)};
    return {*std::min_element(best, best + 3,
                              [&](const auto& x, const auto& y) { return (x - p).squaredNorm() < (y - p).squaredNorm(); })};
  }
  return {p - normal.dot(ap) / area2 * normal};  // keeps the digits of a point just above a large triangle
}

inline Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c) {
  return nearest_place_on_triangle(p, a, b, c).point;
}

/// Squared distance from a point to an axis-aligned box; zero inside.
inline double squared_distance_to_box(const Eigen::Vector3d& p, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

}  // namespace spindrift
