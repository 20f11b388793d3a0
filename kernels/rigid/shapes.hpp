// The simple solids that a floating body is made of, in body axes from its centre of mass.
// Filled from [[bodies.NAME.cylinders]] and its like; read by every sea model (wetted volume, strips, particles); tested in
// tests/kernels/waves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <memory>

#include "kernels/base/constants.hpp"

namespace spindrift {

class ClosedSurface;

/// Circular cylinder with flat ends, or a cone frustum where the two radii differ. Body axes from the centre of mass [m].
struct Cylinder {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< centre of the first end disc
  Eigen::Vector3d end = Eigen::Vector3d::UnitZ();   ///< centre of the other
  double start_radius = 1.0;
  double end_radius = 1.0;

  bool tapered() const { return start_radius != end_radius; }
  double length() const { return (end - start).norm(); }
  Eigen::Vector3d axis() const { return (end - start).normalized(); }
  Eigen::Vector3d at(double fraction) const { return start + fraction * (end - start); }
  double radius(double fraction) const { return start_radius + fraction * (end_radius - start_radius); }
  double volume() const {
    return pi / 3.0 * length() * (start_radius * start_radius + start_radius * end_radius + end_radius * end_radius);
  }
};

/// Box with its edges along the body axes.
struct Box {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), size = Eigen::Vector3d::Ones();
  double volume() const { return size.prod(); }
};

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
  double volume() const { return 4.0 / 3.0 * pi * radius * radius * radius; }
};

/// A closed surface of triangles, shared by all who read it; in 2-D the prism of its outline.
struct Mesh {
  std::shared_ptr<const ClosedSurface> surface;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the body axes, in the surface's coordinates [m]
  double volume() const;
  double section() const;  ///< of a prism: its area across y [m2]
};

}  // namespace spindrift
