// Aerofoil outlines as curves, and nodes on them as the grid round the section wants them: the same number on every outline, so
// that sections blend node by node. Spacing after Vinokur (1983), kernels/grid/spacing.hpp; the curve is a cubic spline in
// chord length. Used by src/aero/rotor_grid/sections.cpp; tested in tests/kernels/grid/aerofoil_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/grid/spacing.hpp"
#include "kernels/grid/spline.hpp"

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
inline void make_curve(PlaneCurve& curve) {
  curve.length[0] = 0.0;
  for (std::size_t i = 1; i < curve.x.size(); ++i)
    curve.length[i] = curve.length[i - 1] + std::hypot(curve.x[i] - curve.x[i - 1], curve.y[i] - curve.y[i - 1]);
  spline_slopes(curve.length, curve.x, curve.slope_x, curve.work);
  spline_slopes(curve.length, curve.y, curve.slope_y, curve.work);
}

/// Length at which the curve is farthest from `point`: the leading edge, seen from the trailing edge.
inline double farthest_from(const PlaneCurve& curve, const Eigen::Vector2d& point) {
  std::size_t best = 0;
  const auto squared = [&](double s) { return (curve(s) - point).squaredNorm(); };
  for (std::size_t i = 0; i < curve.length.size(); ++i)
    if (squared(curve.length[i]) > squared(curve.length[best])) best = i;
  double low = curve.length[best > 0 ? best - 1 : 0], high = curve.length[std::min(best + 1, curve.length.size() - 1)];
  constexpr double golden = 0.6180339887498949;
  for (int n = 0; n < 60; ++n) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (squared(a) > squared(b) ? high : low) = squared(a) > squared(b) ? b : a;
  }
  return 0.5 * (low + high);
}

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
inline void resample(const PlaneCurve& curve, const SectionSpacing& spacing, double slide, std::span<Eigen::Vector2d> nodes) {
  const double total = curve.total();
  const Eigen::Vector2d begin = curve(0.0), end = curve(total), middle = 0.5 * (begin + end);
  const Eigen::Vector2d outward(end.y() - begin.y(), begin.x() - end.x());  // as long as the edge
  const bool closed = (end - begin).norm() < 1e-9 * total;
  const int half = spacing.edge / 2, side = (spacing.round - spacing.edge) / 2;
  const double leading = closed ? 0.5 * total : farthest_from(curve, middle), edge = closed ? 0.5 * spacing.rounded_edge : 0.0;
  const auto at = [&](double s) {
    if (!closed) return curve(s);
    s += slide * total;
    return curve(s - total * std::floor(s / total));
  };
  const int round = spacing.round;
  for (int m = -half; m <= half; ++m) {
    const double u = double(m) / half;  // -1 on the suction side, 1 on the pressure side
    Eigen::Vector2d& node = nodes[std::size_t((m + round) % round)];
    if (closed)
      node = at(edge * u);
    else if (spacing.round_off)
      node = middle + 0.5 * std::sin(0.5 * pi * u) * (begin - end) + 0.5 * std::cos(0.5 * pi * u) * outward;
    else
      node = 0.5 * (1.0 + u) * begin + 0.5 * (1.0 - u) * end;
  }
  const auto fill = [&](double length, auto put) {
    const double tail = closed ? spacing.rounded_edge / spacing.edge : spacing.trailing_edge;
    const double nose = closed ? 0.5 * length / side : spacing.leading_edge;  // a circle has no nose to resolve
    const VinokurLaw law(tail * side / length, nose * side / length);
    for (int m = 1; m <= side; ++m) put(m, length * law(double(m) / side));
  };
  fill(leading - edge, [&](int m, double s) { nodes[std::size_t(half + m)] = at(edge + s); });
  fill(total - leading - edge, [&](int m, double s) {
    if (m < side) nodes[std::size_t(round - half - m)] = at(total - edge - s);
  });
}

/// Twice the area inside a closed polygon; positive counter-clockwise.
inline double signed_area(std::span<const Eigen::Vector2d> points) {
  double twice = 0.0;
  for (std::size_t i = 0, n = points.size(); i < n; ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % n];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// Largest distance across a closed polygon along y, seen over its points' x.
inline double outline_thickness(std::span<const Eigen::Vector2d> points) {
  double most = 0.0;
  const std::size_t n = points.size();
  for (const Eigen::Vector2d& p : points) {
    double low = p.y(), high = p.y();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % n];
      if ((a.x() - p.x()) * (b.x() - p.x()) > 0.0 || a.x() == b.x()) continue;
      const double y = a.y() + (b.y() - a.y()) * (p.x() - a.x()) / (b.x() - a.x());
      low = std::min(low, y), high = std::max(high, y);
    }
    most = std::max(most, high - low);
  }
  return most;
}

struct SegmentPair {
  int first = -1, second = -1;  ///< segments by the index of their first point; -1 where none cross
};

/// The first two segments of a closed polygon that meet without being neighbours.
inline SegmentPair first_crossing(std::span<const Eigen::Vector2d> points) {
  const int n = int(points.size());
  const auto turn = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  };
  for (int i = 0; i < n; ++i)
    for (int j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const auto &a = points[std::size_t(i)], &b = points[std::size_t(i + 1)], &c = points[std::size_t(j)],
                 &d = points[std::size_t((j + 1) % n)];
      if (turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0) return {i, j};
    }
  return {};
}

}  // namespace spindrift
