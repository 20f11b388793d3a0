// A blade as a surface: sections along the span lofted node by node, placed by twist, sweep, prebend, precone and pitch, closed
// at the tip; cut by coaxial surfaces. Recipe: docs/theory/rotor_grid.md. Used by the generator of this folder; tested in
// tests/src/aero/rotor_grid/blade_surface_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "src/aero/rotor_grid/sections.hpp"

namespace spindrift::aero {

struct BladeSettings {
  SectionSpacing spacing;
  double hub_radius = 5.0;  ///< of the cylinder that the blade ends on [m]
  double pitch = 0.0;       ///< about the blade's axis, nose into the wind positive [rad]
  double roll = 0.0;  ///< angle by which the grid round the blade has been turned after it [rad]; the root circle's nodes follow
};

/// A point of the coaxial surface r: arc length s = r theta, positive towards the leading edge, and x along the axis, downwind
/// [m]. Rotor frame: origin at the hub, x the axis downwind, z along blade 1; theta turns z towards -y, as the rotor turns.
struct SurfacePoint {
  double s = 0.0, x = 0.0;
};

class BladeSurface {
 public:
  /// Throws NumericalFailure where the loft folds: neighbouring sections that pass through each other.
  BladeSurface(const Turbine& turbine, const BladeSettings& settings);

  int round() const { return round_; }
  double tip_radius() const { return tip_radius_; }  ///< of the surface r = const that closes the blade [m]
  double tip_chord() const { return tip_chord_; }    ///< [m]
  double closure() const { return closure_; }        ///< length over which the tip thins to a plate [m]
  double chord(double r) const;                      ///< [m]; beyond the ends that of the ends
  /// Half-chord point on the coaxial surface; beyond the ends theta and x of the ends.
  SurfacePoint centre(double r) const;
  /// Nodes of the section on the coaxial surface r, hub radius <= r <= tip radius; node 0 in the middle of the trailing edge,
  /// then along the pressure side.
  void cut(double r, std::span<SurfacePoint> nodes) const;
  /// Direction of the chord at the tip, towards the leading edge, on the surface (s, x).
  Eigen::Vector2d tip_chord_direction() const;

 private:
  struct Line {  ///< one node along the span
    std::vector<double> r, theta, x, slope_theta, slope_x;
    SurfacePoint at(double radius) const;
  };
  int round_ = 0;
  double tip_radius_ = 0.0, tip_chord_ = 0.0, closure_ = 0.0;
  std::vector<Line> lines_;
  Line middle_;                              ///< of the half-chord points
  std::vector<double> chord_, slope_chord_;  ///< at middle_.r
};

}  // namespace spindrift::aero
