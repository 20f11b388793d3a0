// Spacing laws of a grid line: geometric, two-sided after Vinokur (1983), J. Comput. Phys. 50, 215, and growth up to a limit.
// Used by kernels/grid/aerofoil.hpp and src/aero/rotor_grid; tested in tests/kernels/grid/stretching_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace spindrift {

/// Ratio g of `cells` sizes first, first g, first g^2 ... that sum to `length`; any of first < = > length / cells.
inline double geometric_ratio(double first, double length, int cells) {
  const auto sum = [&](double g) {
    double total = 0.0, size = first;
    for (int j = 0; j < cells; ++j, size *= g) total += size;
    return total;
  };
  double low = 1e-3, high = 1.0;
  while (sum(high) < length) high *= 2.0;
  for (int n = 0; n < 80; ++n) {
    const double middle = 0.5 * (low + high);
    (sum(middle) < length ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Sizes of a geometric line; they sum to `length` to rounding.
inline void geometric_sizes(double first, double length, std::span<double> size) {
  const double g = geometric_ratio(first, length, int(size.size()));
  double total = 0.0, next = first;
  for (double& s : size) s = next, total += next, next *= g;
  for (double& s : size) s *= length / total;
}

/// Sizes h g^j while small, turning to `limit` (harmonic sum of the two), with the g that makes them sum to `length`: no size
/// beyond the limit, however thin the first. Where even equal sizes at the limit are too short, the limit is scaled up.
inline void limited_sizes(double first, double limit, double length, std::span<double> size) {
  const int cells = int(size.size());
  limit = std::max(limit, 1.05 * length / cells);
  const auto fill = [&](double g) {
    double total = 0.0, grown = first;
    for (double& s : size) s = 1.0 / (1.0 / grown + 1.0 / limit), total += s, grown *= g;
    return total;
  };
  double low = 1e-2, high = 2.0;
  while (fill(high) < length && high < 1e6) high *= 2.0;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (fill(middle) < length ? low : high) = middle;
  }
  const double total = fill(0.5 * (low + high));
  for (double& s : size) s *= length / total;
}

/// Inverse of sinh(y)/y = b (b > 1) or sin(y)/y = b (b < 1), by Newton steps from Vinokur's approximations.
inline double vinokur_argument(double b) {
  const bool above = b > 1.0;
  double y = std::sqrt(6.0 * std::abs(b - 1.0));
  if (above && b > 3.0) y = std::log(2.0 * b) + std::log(std::log(2.0 * b));
  if (!above && b < 0.5) y = 3.0;
  for (int n = 0; n < 60; ++n) {
    const double s = above ? std::sinh(y) : std::sin(y), c = above ? std::cosh(y) : std::cos(y);
    const double step = (s / y - b) / (c / y - s / (y * y));
    const double next = std::clamp(y - step, 0.2 * y, above ? 5.0 * y : 0.5 * (y + 3.141592653589793));
    if (std::abs(next - y) < 1e-14 * y) break;
    y = next;
  }
  return y;
}

/// Vinokur's two-sided stretching of [0, 1] by a continuous coordinate t in [0, 1]: ds/dt is `slope0` at 0 and `slope1` at 1
/// (size over length times the number of cells). Its error of discretisation goes with the square of the number of cells, so
/// that one law at 1, 2, 4 ... times as many cells gives similar grids.
struct Vinokur {
  Vinokur(double slope0, double slope1)
      : a_(std::sqrt(slope1 / slope0)), b_(1.0 / std::sqrt(slope0 * slope1)), y_(flat() ? 0.0 : vinokur_argument(b_)) {}
  double operator()(double t) const {
    double u = t;
    if (!flat())
      u = b_ > 1.0 ? 0.5 + std::tanh(y_ * (t - 0.5)) / (2.0 * std::tanh(0.5 * y_))
                   : 0.5 + std::tan(y_ * (t - 0.5)) / (2.0 * std::tan(0.5 * y_));
    return u / (a_ + (1.0 - a_) * u);
  }

 private:
  bool flat() const { return std::abs(b_ - 1.0) < 1e-4; }
  double a_, b_, y_;
};

}  // namespace spindrift
