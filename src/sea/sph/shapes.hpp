// Bodies filled with particles. Each particle stands at the centroid of its own piece of the body: the outermost ones about half
// a spacing inside the surface, because water comes no nearer to them than about half a spacing outside of it. Together they
// displace the volume of the body. (With particles on the surface a body of n spacings is one spacing too wide, which changes its
// draft.) Counts and radii are rounded so that number * spacing^dim is the volume as nearly as can be. Called by scenes; tested
// in tests/src/sea/sph/shapes_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
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

/// Box of the given edges, filled by counts along them (an edge of zero: one, the plane of a 2-D scene) whose product is nearest
/// to its volume in cells, each within one of the edge in spacings: particles that stand for more or less than their volume make
/// the body larger or smaller.
Points points_in_box(const Eigen::Vector3d& edges, double spacing);

/// Spacing across an axis that makes up for layers of other than the spacing along it: number times spacing^3 is the volume.
inline double spacing_across(double length, double spacing) {
  return spacing * std::sqrt(whole_spacings(length, spacing) * spacing / length);
}

/// Rings of a disc in the plane of the first two components: ring k holds about as many particles as spacings fit on it. `owed`:
/// what rounding has left out so far, in particles; of layer upon layer the volume up to each is then met within half a particle.
std::vector<Eigen::Vector2d> points_in_disc(double radius, double spacing, double& owed);
std::vector<Eigen::Vector2d> points_in_disc(double radius, double spacing);

/// The half of a disc with a positive second component.
std::vector<Eigen::Vector2d> points_in_half_disc(double radius, double spacing, double& owed);

/// Circular cylinder along an axis (0 x, 1 y, 2 z); length zero makes the disc of a 2-D scene.
Points points_in_cylinder(double radius, double length, int axis, double spacing);

/// Sphere: shells of points spread by the golden angle.
Points points_in_sphere(double radius, double spacing);
/// Its half with y > 0, as evenly.
Points points_in_half_sphere(double radius, double spacing);

}  // namespace spindrift::sph
