// Cylinders cut into strips: the wetted part of each under its local surface, its points of integration and its exposed ends.
// Called by EngineeringSea; equations in docs/theory/sea_engineering.md, sections 1 to 3; tested in tests/src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "kernels/rigid/shapes.hpp"
#include "kernels/waves/wetted.hpp"

namespace spindrift::sea {

struct Coefficients {
  double drag, added_mass;                             ///< across
  std::array<double, 2> axial_drag, axial_added_mass;  ///< of start and end
  bool diffracts = false;                              ///< as MacCamy and Fuchs have it
};

/// The flat end of a cylinder.
struct EndDisc {
  Eigen::Vector3d centre, normal;  ///< body axes; out of the cylinder
  double radius, drag, added_mass;
};

/// What water meets of the ends that share a point: sums over them, R^2 and R^3 along their normals n.
struct ExposedEnd {
  Eigen::Vector3d area_normal = Eigen::Vector3d::Zero(), cube_normal = Eigen::Vector3d::Zero();  ///< units, body axes
  double area = 0.0, cube = 0.0;        ///< |sum pi R^2 n| [m2], |sum R^3 n| [m3]
  double radius = 0.0;                  ///< of the widest [m]
  double drag = 0.0, added_mass = 0.0;  ///< coefficients
  bool exposed() const { return area > 0.0 || cube > 0.0; }
};
ExposedEnd exposed_end(std::span<const EndDisc> sharing_a_point);

/// A slice of a cylinder, body axes from the centre of mass. An end that continues in another strip, or that another strip counts
/// where several share a point, is not exposed.
struct Strip {
  Cylinder shape;
  Coefficients coefficients;
  std::array<ExposedEnd, 2> ends;
  int scattered = -1;  ///< of EngineeringSea's waves scattered at a radius; -1: none
};

/// Cuts a cylinder into strips no longer than `longest` [m]; the exposed ends are those of the whole cylinder.
void append_strips(const Cylinder& cylinder, const Coefficients& coefficients, const std::array<ExposedEnd, 2>& ends,
                   double longest, std::vector<Strip>& strips);

/// A piece of a strip that counts as one point: its arm from the centre of mass, on the axis, and that of its water, which is
/// beside the axis where sections are partly wet [m]; its wetted volume [m3], its radius [m].
struct Station {
  Eigen::Vector3d arm, water;
  double volume, radius;
};
struct WettedEnd {
  Eigen::Vector3d arm;
  double share;  ///< of its disc that is under water
};
struct WettedStrip {
  Eigen::Vector3d axis;
  waves::Wetted wetted;             ///< first moment about the centre of mass
  std::array<Station, 4> stations;  ///< the first `count`; their volumes add to the wetted volume, with its first moment
  std::size_t count = 0;
  std::array<WettedEnd, 2> ends;
};

/// Start and end of the strip as arms from the centre of mass in earth axes; the plane in the same axes.
waves::Wetted wetted_part(const Cylinder& shape, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          const waves::WaterPlane& surface);
WettedStrip wetted_strip(const Strip& strip, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                         const waves::WaterPlane& surface);

}  // namespace spindrift::sea
