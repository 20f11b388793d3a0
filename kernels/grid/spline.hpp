// Slopes of the cubic spline through points (two continuous derivatives), for interpolate_hermite of
// kernels/base/interpolation.hpp. Tridiagonal system of the first derivatives (de Boor 1978, chapter 4) with parabolic ends. Used
// by kernels/grid/aerofoil.cpp; tested in tests/kernels/grid/spline_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace spindrift {

/// Fills `slope`; x increasing, at least three points. `work` has the size of x.
inline void spline_slopes(std::span<const double> x, std::span<const double> y, std::span<double> slope, std::span<double> work) {
  const std::size_t n = x.size();
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto delta = [&](std::size_t i) { return (y[i + 1] - y[i]) / h(i); };
  // Ends: s0 + s1 = 2 delta, no third derivative over the first and the last interval. Every row is divided by its diagonal.
  slope[0] = 2.0 * delta(0), work[0] = 1.0;
  for (std::size_t i = 1; i + 1 < n; ++i) {  // h_i s_{i-1} + 2 (h_i + h_{i-1}) s_i + h_{i-1} s_{i+1} = rhs
    const double diagonal = 2.0 * (h(i) + h(i - 1)) - h(i) * work[i - 1];
    slope[i] = (3.0 * (h(i) * delta(i - 1) + h(i - 1) * delta(i)) - h(i) * slope[i - 1]) / diagonal;
    work[i] = h(i - 1) / diagonal;
  }
  slope[n - 1] = (2.0 * delta(n - 2) - slope[n - 2]) / (1.0 - work[n - 2]);
  for (std::size_t i = n - 1; i-- > 0;) slope[i] -= work[i] * slope[i + 1];
}

}  // namespace spindrift
