// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/aerofoil.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/base/constants.hpp"
#include "kernels/grid/spacing.hpp"
#include "kernels/grid/spline.hpp"

namespace spindrift {

void make_curve(PlaneCurve& curve) {
  curve.length[0] = 0.0;
  for (std::size_t i = 1; i < curve.x.size(); ++i)
    curve.length[i] = curve.length[i - 1] + std::hypot(curve.x[i] - curve.x[i - 1], curve.y[i] - curve.y[i - 1]);
  spline_slopes(curve.length, curve.x, curve.slope_x, curve.work);
  spline_slopes(curve.length, curve.y, curve.slope_y, curve.work);
}

double farthest_from(const PlaneCurve& curve, const Eigen::Vector2d& point) {
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

void resample(const PlaneCurve& curve, const SectionSpacing& spacing, double slide, std::span<Eigen::Vector2d> nodes) {
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

double signed_area(std::span<const Eigen::Vector2d> points) {
  double twice = 0.0;
  for (std::size_t i = 0, n = points.size(); i < n; ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % n];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

double outline_thickness(std::span<const Eigen::Vector2d> points) {
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

SegmentPair first_crossing(std::span<const Eigen::Vector2d> points) {
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
