// The motion a driver prescribes on a joint: value, rate and second derivative at any time.
// A sum of start value + constant rate + harmonic + table (natural cubic spline, so that the acceleration is continuous).
// Used by the drivers of kernels/rigid/constraints.hpp; tested in tests/kernels/rigid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace spindrift {

/// Value [rad or m] with its first and second time derivatives.
struct Drive {
  double value = 0.0, rate = 0.0, acceleration = 0.0;
};

/// Natural cubic spline through (time, value); constant beyond its ends, at which it still has the rate within.
class CubicTable {
 public:
  CubicTable() = default;
  /// Times strictly increasing, at least two.
  CubicTable(std::span<const double> times, std::span<const double> values)
      : t_(times.begin(), times.end()), y_(values.begin(), values.end()), m_(times.size(), 0.0) {
    const std::size_t n = t_.size();
    std::vector<double> diagonal(n, 1.0), right(n, 0.0);  // tridiagonal system for the second derivatives m
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const double left = t_[k] - t_[k - 1], next = t_[k + 1] - t_[k];
      const double w = k > 1 ? left / diagonal[k - 1] : 0.0;
      diagonal[k] = 2.0 * (left + next) - w * (k > 1 ? left : 0.0);
      right[k] = 6.0 * ((y_[k + 1] - y_[k]) / next - (y_[k] - y_[k - 1]) / left) - w * right[k - 1];
    }
    for (std::size_t k = n - 1; k-- > 1;) m_[k] = (right[k] - (t_[k + 1] - t_[k]) * m_[k + 1]) / diagonal[k];
  }
  bool empty() const { return t_.empty(); }

  /// Of the slopes of the straight lines between its points.
  double steepest() const {
    double most = 0.0;
    for (std::size_t k = 0; k + 1 < t_.size(); ++k) most = std::max(most, std::abs((y_[k + 1] - y_[k]) / (t_[k + 1] - t_[k])));
    return most;
  }

  double begin() const { return t_.front(); }
  double end() const { return t_.back(); }

  Drive at(double t) const {
    const double rounding = 1e-9 * (t_.back() - t_.front());  // of the times of steps
    if (t < t_.front() - rounding) return {y_.front(), 0.0, 0.0};
    if (t > t_.back() + rounding) return {y_.back(), 0.0, 0.0};
    t = std::clamp(t, t_.front(), t_.back());
    const std::size_t k = std::size_t(std::upper_bound(t_.begin() + 1, t_.end() - 1, t) - t_.begin()) - 1;
    const double h = t_[k + 1] - t_[k], a = (t_[k + 1] - t) / h, b = 1.0 - a;
    return {a * y_[k] + b * y_[k + 1] + ((a * a * a - a) * m_[k] + (b * b * b - b) * m_[k + 1]) * h * h / 6.0,
            (y_[k + 1] - y_[k]) / h + ((3 * b * b - 1) * m_[k + 1] - (3 * a * a - 1) * m_[k]) * h / 6.0,
            a * m_[k] + b * m_[k + 1]};
  }

 private:
  std::vector<double> t_, y_, m_;  // knots [s], values, second derivatives
};

/// start + rate t + amplitude sin(omega t + phase) + table(t); radians or metres, seconds.
struct PrescribedMotion {
  double start = 0.0, rate = 0.0;
  double amplitude = 0.0, omega = 0.0, phase = 0.0;
  CubicTable table{};

  Drive at(double t) const {
    const double angle = omega * t + phase;
    Drive d{start + rate * t + amplitude * std::sin(angle), rate + amplitude * omega * std::cos(angle),
            -amplitude * omega * omega * std::sin(angle)};
    if (!table.empty()) {
      const Drive more = table.at(t);
      d = {d.value + more.value, d.rate + more.rate, d.acceleration + more.acceleration};
    }
    return d;
  }
  /// An upper bound of the rate's size, that of a table by its straight lines.
  double fastest() const { return std::abs(rate) + std::abs(amplitude * omega) + table.steepest(); }
};

}  // namespace spindrift
