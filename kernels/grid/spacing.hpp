// Laws that spread nodes along a line, as smooth functions of s in [0, 1]: a family of grids samples one law, so that errors of
// its members compare (Richardson). Vinokur 1983, J. Comput. Phys. 50: the sinh law for a slope at one end, the tanh law for
// both. Called by src/aero/grid/generators and the rotor's grid; tested in tests/kernels/grid/spacing_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace detail {
/// x with sinh(x)/x = y for y >= 1, sin(x)/x = y (x < pi) below, its square negative then: returns x^2 with that sign.
inline double inverse_sinhc_squared(double y) {
  const auto value = [](double x2) {
    if (std::abs(x2) < 1e-4) return 1.0 + x2 / 6.0 * (1.0 + x2 / 20.0);
    const double x = std::sqrt(std::abs(x2));
    return x2 > 0 ? std::sinh(x) / x : std::sin(x) / x;
  };
  double low = -9.8696, high = 1.0;  // -pi^2, where the sine is zero
  while (value(high) < y) high *= 2.0;
  for (int n = 0; n < 200 && high - low > 1e-15 * (1.0 + std::abs(low)); ++n) {
    const double middle = 0.5 * (low + high);
    (value(middle) < y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
}  // namespace detail

/// From 0 to 1 with the given slope at s = 0 (below 1: nodes crowd there) and no curvature there: neighbouring spacings are equal
/// at the start and grow towards a constant ratio.
class SinhLaw {
 public:
  explicit SinhLaw(double slope) : k2_(detail::inverse_sinhc_squared(1.0 / slope)), k_(std::sqrt(std::abs(k2_))) {}
  double operator()(double s) const {
    if (k_ < 1e-3) return s * (1.0 + k2_ * (s * s - 1.0) / 6.0);
    return k2_ > 0 ? std::sinh(k_ * s) / std::sinh(k_) : std::sin(k_ * s) / std::sin(k_);
  }

 private:
  double k2_, k_;
};

/// From 0 to 1 with given slopes (size over length times the number of cells) at both ends. Its error of discretisation goes with
/// the square of the number of cells, so that one law at 1, 2, 4 ... times as many cells gives similar grids.
class VinokurLaw {
 public:
  VinokurLaw(double slope_start, double slope_end)
      : a_(std::sqrt(slope_end / slope_start)),
        k2_(detail::inverse_sinhc_squared(1.0 / std::sqrt(slope_start * slope_end))),
        k_(std::sqrt(std::abs(k2_))) {}
  double operator()(double s) const {
    if (s <= 0.0 || s >= 1.0) return std::clamp(s, 0.0, 1.0);
    double u = s;
    if (k_ >= 1e-3)
      u = 0.5 + 0.5 * (k2_ > 0 ? std::tanh(k_ * (s - 0.5)) / std::tanh(0.5 * k_) : std::tan(k_ * (s - 0.5)) / std::tan(0.5 * k_));
    return u / (a_ + (1.0 - a_) * u);
  }

 private:
  double a_, k2_, k_;
};

/// From 0 to 1 with slope `ends` at both ends (below 1), no curvature there, and 2 - ends in the middle.
class WaveLaw {
 public:
  explicit WaveLaw(double ends) : ends_(ends) {}
  double operator()(double s) const { return s - (1.0 - ends_) * std::sin(6.283185307179586 * s) / 6.283185307179586; }

 private:
  double ends_;
};

}  // namespace spindrift
