// Sizes of the cells of a grid line, one by one: geometric, and growth up to a limit. Laws that are functions: spacing.hpp.
// Used by src/aero/rotor_grid; tested in tests/kernels/grid/stretching_test.cpp.
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

}  // namespace spindrift
