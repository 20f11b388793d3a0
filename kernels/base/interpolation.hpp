// Interpolation in one variable on given nodes: straight lines, and cubics that never overshoot the data.
// Monotone cubic: Fritsch & Butland (1984), SIAM J. Sci. Stat. Comput. 5, in the weighted form of Moler's pchip.
// Used by kernels/mooring, kernels/beam and src/aero; tested in tests/kernels/base/root_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/base/root.hpp"

namespace spindrift {

/// Index i of the interval x[i] <= at < x[i+1], the first or last one outside. Nodes strictly increasing, at least two.
inline std::size_t interval(std::span<const double> x, double at) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  return static_cast<std::size_t>(above - x.begin()) - 1;
}

/// Piecewise linear; outside the nodes the end values hold.
inline double interpolate_linear(std::span<const double> x, std::span<const double> y, double at) {
  if (x.size() == 1) return y[0];
  const std::size_t i = interval(x, at);
  const double s = std::clamp((at - x[i]) / (x[i + 1] - x[i]), 0.0, 1.0);
  return (1.0 - s) * y[i] + s * y[i + 1];
}

/// Bilinear on a grid z[iy * x.size() + ix]; outside, the edge values hold. One row (y of size 1) is linear in x.
inline double interpolate_bilinear(std::span<const double> x, std::span<const double> y, std::span<const double> z, double at_x,
                                   double at_y) {
  const auto row = [&](std::size_t iy) { return interpolate_linear(x, z.subspan(iy * x.size(), x.size()), at_x); };
  if (y.size() == 1) return row(0);
  const std::size_t i = interval(y, at_y);
  const double s = std::clamp((at_y - y[i]) / (y[i + 1] - y[i]), 0.0, 1.0);
  return (1.0 - s) * row(i) + s * row(i + 1);
}

/// Node slopes of the monotone cubic. Zero at a local extremum, so that each interval stays between its two values.
inline void monotone_slopes(std::span<const double> x, std::span<const double> y, std::span<double> slope) {
  const std::size_t n = x.size();
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto delta = [&](std::size_t i) { return (y[i + 1] - y[i]) / h(i); };
  if (n == 2) return std::fill(slope.begin(), slope.end(), delta(0));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = delta(i - 1), after = delta(i), w1 = 2 * h(i) + h(i - 1), w2 = h(i) + 2 * h(i - 1);
    slope[i] = before * after > 0.0 ? (w1 + w2) / (w1 / before + w2 / after) : 0.0;
  }
  // One-sided parabola at the ends, limited so that the end interval stays monotone.
  const auto end = [](double h0, double h1, double d0, double d1) {
    const double s = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (s * d0 <= 0.0) return 0.0;
    return d0 * d1 <= 0.0 && std::abs(s) > 3 * std::abs(d0) ? 3 * d0 : s;
  };
  slope[0] = end(h(0), h(1), delta(0), delta(1));
  slope[n - 1] = end(h(n - 2), h(n - 3), delta(n - 2), delta(n - 3));
}

/// Cubic Hermite polynomial through (x, y, slope) in the interval of `at`; outside, that of the end interval: the caller guards.
inline ValueAndSlope interpolate_hermite(std::span<const double> x, std::span<const double> y, std::span<const double> slope,
                                         double at) {
  const std::size_t i = interval(x, at);
  const double h = x[i + 1] - x[i], s = (at - x[i]) / h, r = 1.0 - s, delta = (y[i + 1] - y[i]) / h;
  const double value = r * y[i] + s * y[i + 1] + h * s * r * (r * (slope[i] - delta) - s * (slope[i + 1] - delta));
  const double rate = delta + (r * r - 2 * s * r) * (slope[i] - delta) + (s * s - 2 * s * r) * (slope[i + 1] - delta);
  return {value, rate};
}

}  // namespace spindrift
