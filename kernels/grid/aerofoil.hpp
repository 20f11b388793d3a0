// Aerofoil outlines as curves, and nodes on them as the grid round the section wants them: the same number on every outline, so
// that sections blend node by node. Spacing after Vinokur (1983), kernels/grid/spacing.hpp; the curve is a cubic spline in
// chord length. Used by src/aero/rotor_grid/sections.cpp; tested in tests/kernels/grid/aerofoil_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "kernels/base/interpolation.hpp"

namespace spindrift {

/// A plane curve through points, by the length of its polygon. Does not own: the six spans have the number of points.
struct PlaneCurve {
  std::span<double> length, x, y, slope_x, slope_y, work;

  double total() const { return length.back(); }
  Eigen::Vector2d operator()(double s) const {
    return {interpolate_hermite(length, x, slope_x, s).value, interpolate_hermite(length, y, slope_y, s).value};
  }
};

/// From x and y, which are set, fills the rest.
void make_curve(PlaneCurve& curve);

/// Length at which the curve is farthest from `point`: the leading edge, seen from the trailing edge.
double farthest_from(const PlaneCurve& curve, const Eigen::Vector2d& point);

/// How many nodes go where, lengths over the chord.
struct SectionSpacing {
  int round = 120;               ///< cells round the section, even
  int edge = 4;                  ///< of them on the blunt trailing edge, even
  double leading_edge = 0.004;   ///< size of the cells at the leading edge
  double trailing_edge = 0.006;  ///< and of those beside the trailing edge
  double rounded_edge = 0.12;    ///< length of curve that counts as the edge where the outline is closed
  bool round_off = false;        ///< half a circle on the edge of an open outline, in place of the flat
};

/// Nodes i = 0 ... round - 1 on an outline that runs from the trailing edge along the pressure side to the leading edge and back
/// along the suction side: node 0 is the middle of the trailing edge, node round/2 the leading edge. An open outline has a flat
/// edge between its ends; on a closed one (a circle) the edge is a piece of the curve. `slide` shifts the nodes along a closed
/// outline, in fractions of its length. `slide` of an open one must be zero.
void resample(const PlaneCurve& curve, const SectionSpacing& spacing, double slide, std::span<Eigen::Vector2d> nodes);

/// Twice the area inside a closed polygon; positive counter-clockwise.
double signed_area(std::span<const Eigen::Vector2d> points);

/// Largest distance across a closed polygon along y, seen over its points' x.
double outline_thickness(std::span<const Eigen::Vector2d> points);

struct SegmentPair {
  int first = -1, second = -1;  ///< segments by the index of their first point; -1 where none cross
};

/// The first two segments of a closed polygon that meet without being neighbours.
SegmentPair first_crossing(std::span<const Eigen::Vector2d> points);

}  // namespace spindrift
