// Cylinders cut into strips: the wetted part of each under its local surface, its points of integration and its exposed ends.
// Called by EngineeringSea; equations in docs/theory/sea_engineering.md, sections 1 to 3; tested in tests/src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kernels/rigid/shapes.hpp"
#include "kernels/waves/wetted.hpp"

namespace spindrift::sea {

struct Coefficients {
  double drag, added_mass;                             ///< across
  std::array<double, 2> axial_drag, axial_added_mass;  ///< of start and end
  bool diffracts = false;                              ///< as MacCamy and Fuchs have it
};

/// A slice of a cylinder, body axes from the centre of mass. An end that continues in another strip or member has exposed area 0.
struct Strip {
  Cylinder shape;
  Coefficients coefficients;
  double start_exposed_area = 0.0, end_exposed_area = 0.0;  ///< [m2]
  int scattered = -1;                                       ///< of EngineeringSea's waves scattered at a radius; -1: none
};

/// Cuts a cylinder into strips no longer than `longest` [m]; the exposed areas belong to its own two ends.
void append_strips(const Cylinder& cylinder, const Coefficients& coefficients, double start_exposed_area, double end_exposed_area,
                   double longest, std::vector<Strip>& strips);

/// What remains in the water of an end disc where other cylinders of the body join it: its area less theirs, at least 0 [m2].
double exposed_area(const Eigen::Vector3d& centre, double radius, const std::vector<Cylinder>& others, double tolerance);

/// A piece of a strip that counts as one point: its arm from the centre of mass [m], its wetted volume [m3], its radius [m].
struct Station {
  Eigen::Vector3d arm;
  double volume, radius;
};
struct End {
  Eigen::Vector3d arm;
  double exposed_area, radius;  ///< wetted part of the exposed area [m2]
};
struct WettedStrip {
  Eigen::Vector3d axis;
  waves::Wetted wetted;             ///< first moment about the centre of mass
  std::array<Station, 4> stations;  ///< the first `count`; their volumes add to the wetted volume
  std::size_t count = 0;
  std::array<End, 2> ends;
};

/// Start and end of the strip as arms from the centre of mass in earth axes; the plane in the same axes.
waves::Wetted wetted_part(const Cylinder& shape, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          const waves::WaterPlane& surface);
WettedStrip wetted_strip(const Strip& strip, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                         const waves::WaterPlane& surface);

}  // namespace spindrift::sea
