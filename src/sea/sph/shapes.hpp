// Bodies filled with particles. The outermost particles stand half a spacing inside the surface, because water comes no nearer to
// them than about half a spacing outside of it: every particle then stands for its own volume, and together they displace the
// volume of the body. (With particles on the surface a body of n spacings is one spacing too wide, which changes its draft.)
// Counts and radii are rounded so that number * spacing^dim is the volume as nearly as can be.
// Called by scenes; tested in tests/src/sea/sph/shapes_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"

namespace spindrift::sph {

/// Points in body axes from the centre of the shape [m].
using Points = std::vector<Eigen::Vector3d>;

inline int whole_spacings(double length, double spacing) { return std::max(1, int(std::lround(length / spacing))); }

/// Cells of nearly the spacing that fill a length exactly; returns their centres from the middle.
inline std::vector<double> cell_centres(double length, double spacing) {
  const int n = whole_spacings(length, spacing);
  std::vector<double> centres;
  for (int k = 0; k < n; ++k) centres.push_back(length * ((k + 0.5) / n - 0.5));
  return centres;
}

/// Box of the given edges; an edge of zero makes the plane of a 2-D scene.
inline Points points_in_box(const Eigen::Vector3d& edges, double spacing) {
  const auto along = [&](int axis) { return edges[axis] > 0.0 ? cell_centres(edges[axis], spacing) : std::vector<double>{0.0}; };
  Points points;
  for (double x : along(0))
    for (double y : along(1))
      for (double z : along(2)) points.push_back({x, y, z});
  return points;
}

/// Rings of a disc in the plane of the first two components: ring k holds about as many particles as spacings fit on it.
inline std::vector<Eigen::Vector2d> points_in_disc(double radius, double spacing) {
  const int rings = whole_spacings(radius, spacing);
  const double width = radius / rings;
  std::vector<Eigen::Vector2d> points;
  double area = 0.0;  // in spacings^2; carried over, so that rounding does not add up
  for (int ring = 0; ring < rings; ++ring) {
    area += pi * (2 * ring + 1) * width * width / (spacing * spacing);
    const int n = std::max(1, int(std::lround(area - double(points.size()))));
    const double r = n == 1 ? 0.0 : width * (ring + 0.5);
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * pi * (k + 0.5 * (ring % 2)) / n;
      points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  }
  return points;
}

/// Circular cylinder along an axis (0 x, 1 y, 2 z); length zero makes the disc of a 2-D scene.
inline Points points_in_cylinder(double radius, double length, int axis, double spacing) {
  const std::vector<double> layers = length > 0.0 ? cell_centres(length, spacing) : std::vector<double>{0.0};
  Points points;
  for (double along : layers)
    for (const Eigen::Vector2d& p : points_in_disc(radius, spacing)) {
      Eigen::Vector3d point;
      point[axis] = along, point[(axis + 1) % 3] = p[0], point[(axis + 2) % 3] = p[1];
      points.push_back(point);
    }
  return points;
}

/// Sphere: shells of points spread by the golden angle.
inline Points points_in_sphere(double radius, double spacing) {
  const int shells = whole_spacings(radius, spacing);
  const double width = radius / shells, golden = pi * (3.0 - std::sqrt(5.0));
  Points points;
  for (int shell = 0; shell < shells; ++shell) {
    const double volume = 4.0 / 3.0 * pi * std::pow((shell + 1) * width / spacing, 3);
    const int n = std::max(1, int(std::lround(volume - double(points.size()))));
    const double r = n == 1 ? 0.0 : width * (shell + 0.5);
    for (int k = 0; k < n; ++k) {
      const double z = 1.0 - (2.0 * k + 1.0) / n, ring = std::sqrt(1.0 - z * z);
      points.push_back(r * Eigen::Vector3d(ring * std::cos(golden * k), ring * std::sin(golden * k), z));
    }
  }
  return points;
}

}  // namespace spindrift::sph
