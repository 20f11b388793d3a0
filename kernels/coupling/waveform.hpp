// Interface data over a window from samples at a few times: constant (the value at the end of each piece), linear, or cubic
// through the four samples nearest to the piece. With data converged at the samples the coupling is of order 1, 2, 4 (Ruesch,
// Birken, Monge & Mehl 2021 on waveform iteration; the preCICE oscillator). Polynomials through unequal times are Lagrange's.
// Used by extrapolation.hpp, src/coupling/window.cpp; tested in tests/kernels/coupling and tests/verification/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "kernels/base/assert.hpp"
#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

enum class Interpolation { constant, linear, cubic };

/// The polynomial through (times[k], values[k]) at t; does not allocate where `out` has the size.
inline void lagrange(std::span<const double> times, std::span<const Vector> values, double t, Vector& out) {
  out.setZero(values[0].size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    double weight = 1.0;
    for (std::size_t j = 0; j < times.size(); ++j)
      if (j != k) weight *= (t - times[j]) / (times[k] - times[j]);
    out += weight * values[k];
  }
}

class Waveform {
 public:
  Waveform() = default;
  /// Increasing times, the first at the start of the window. Fewer samples than the kind asks for lower its degree.
  Waveform(Interpolation kind, std::vector<double> times, std::vector<Vector> values)
      : kind_(kind), times_(std::move(times)), values_(std::move(values)) {
    SPINDRIFT_ASSERT(!times_.empty() && times_.size() == values_.size(), "a waveform needs a value at each of its times");
  }
  /// A value that holds.
  static Waveform held(Vector value) { return Waveform(Interpolation::constant, {0.0}, {std::move(value)}); }

  /// Beyond the last sample the last piece goes on.
  void at(double t, Vector& out) const {
    const std::size_t n = times_.size();
    if (n == 1) {
      out = values_[0];
      return;
    }
    // The piece [k-1, k] that holds t; its right end belongs to it.
    std::size_t k = 1;
    while (k + 1 < n && t > times_[k]) ++k;
    if (kind_ == Interpolation::constant) {
      out = values_[k];
      return;
    }
    const std::size_t points = kind_ == Interpolation::linear ? 2 : std::min<std::size_t>(4, n);
    const std::size_t first = points == 2 ? k - 1 : std::min(k >= 2 ? k - 2 : 0, n - points);
    lagrange(std::span(times_).subspan(first, points), std::span(values_).subspan(first, points), t, out);
  }
  Vector at(double t) const {
    Vector value;
    at(t, value);
    return value;
  }
  const Vector& end() const { return values_.back(); }
  void visit(auto& v) {
    int kind = int(kind_);
    v(kind);
    kind_ = Interpolation(kind);
    v(times_), v(values_);
  }

 private:
  Interpolation kind_ = Interpolation::constant;
  std::vector<double> times_;
  std::vector<Vector> values_;
};

}  // namespace spindrift::coupling
