// Radiation memory of a floating body: retardation functions from damping over frequency, and the convolution with the body's
// velocity. Cummins (1962), Schiffstechnik 9, 101; Ogilvie (1964): K(t) = 2/pi int_0^inf B(w) cos wt dw,
// A(inf) = A(w) + 1/w int_0^inf K(t) sin wt dt. Theory: docs/theory/sea_engineering.md. Used by src/sea/potential.cpp; tested in
// tests/kernels/waves/cummins_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <utility>
#include <vector>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

/// 2/pi int B(w) cos wt dw, exact for B that is straight between the frequencies [rad/s], zero at w = 0 and beyond the last.
inline double retardation(std::span<const double> omega, std::span<const double> damping, double t) {
  double sum = 0.0, w0 = 0.0, b0 = 0.0;
  for (std::size_t k = 0; k < omega.size(); ++k) {
    const double w1 = omega[k], b1 = damping[k], width = w1 - w0;
    if (width > 0.0) {
      const double half = 0.5 * width * t;
      if (std::abs(half) < 1e-4) {
        sum += 0.5 * (b0 * std::cos(w0 * t) + b1 * std::cos(w1 * t)) * width;
      } else {
        // int (b0 + s (w - w0)) cos wt = [b sin wt / t] + s [cos wt / t^2]
        const double slope = (b1 - b0) / width;
        sum += (b1 * std::sin(w1 * t) - b0 * std::sin(w0 * t)) / t + slope * (std::cos(w1 * t) - std::cos(w0 * t)) / (t * t);
      }
    }
    w0 = w1, b0 = b1;
  }
  return 2.0 / pi * sum;
}

/// Added mass at infinite frequency with which the retardation function at steps of h, K[0] at t = 0, gives the added mass of
/// most frequencies [rad/s]: the median over them, each by the trapezoidal rule. Damping that ends before it has died out is a
/// jump there, near which Ogilvie's integral goes to infinity as a logarithm. Far below it the lost part is a constant, and is in
/// what this returns. A median minds neither that end nor irregular frequencies.
inline double infinite_added_mass(std::span<const double> omega, std::span<const double> added_mass,
                                  std::span<const double> retardation, double h) {
  std::vector<std::pair<double, double>> found;  // by frequency: added mass, share of the axis
  double all = 0.0;
  for (std::size_t k = 0; k < omega.size(); ++k) {
    const std::complex<double> turn = std::polar(1.0, omega[k] * h);
    std::complex<double> at = 1.0;
    double sum = 0.0;
    for (std::size_t n = 1; n < retardation.size(); ++n) {
      at *= turn;
      sum += (n + 1 == retardation.size() ? 0.5 : 1.0) * retardation[n] * at.imag();
    }
    const double before = k == 0 ? 0.0 : omega[k - 1], after = omega[std::min(k + 1, omega.size() - 1)];
    found.emplace_back(added_mass[k] + sum * h / omega[k], after - before);
    all += after - before;
  }
  std::sort(found.begin(), found.end());
  double below = 0.0;
  for (const auto& [mass, share] : found)
    if ((below += share) >= 0.5 * all) return mass;
  return found.back().first;
}

}  // namespace spindrift::waves
