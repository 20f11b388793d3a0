// Roots in one unknown. Of an increasing function of a positive unknown: Newton steps kept inside a bracket, halved whenever
// Newton leaves it or stalls (Dahlquist & Bjoerck 1974, section 6.2). Of any function between two signs: Chandrupatla (1997).
// Used by kernels/mooring/line_catenary.hpp and kernels/rotor/blade_element.hpp; tested in tests/kernels/base/root_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace spindrift {

struct ValueAndSlope {
  double value, slope;
};

struct Root {
  double x;
  int evaluations;
  bool converged;
};

/// Solves f(x) = 0 for x > 0, f increasing and returning ValueAndSlope. `guess` > 0 need not be good: the bracket grows from it
/// by factors of 8. Stops when x is known to `relative_tolerance`; numerical trouble is reported in `converged`.
template <class F>
Root increasing_root(F&& f, double guess, double relative_tolerance = 4 * std::numeric_limits<double>::epsilon()) {
  constexpr int max_evaluations = 400;  // 8^-343 underflows: more than any bracket search can need
  constexpr double rounding_step = 1e-9;
  double low = 0.0, high = std::numeric_limits<double>::infinity(), x = guess, last = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= max_evaluations; ++n) {
    const auto [value, slope] = f(x);
    if (value == 0.0) return {x, n, true};
    (value < 0.0 ? low : high) = x;
    if (low > 0.0 && high - low <= relative_tolerance * x) return {x, n, true};
    double next = x - value / slope;
    const double step = std::abs(next - x);
    const bool falling = std::abs(value) < 0.5 * last;
    // A Newton step this small that no longer gains is the rounding of f itself.
    if (step <= (falling ? relative_tolerance : rounding_step) * x) return {next, n, true};
    const bool newton = falling && next > std::max(low, x / 8) && next < std::min(high, 8 * x);
    last = std::abs(value);
    if (!newton) {
      if (high == std::numeric_limits<double>::infinity())
        next = 8 * x;
      else if (low == 0.0)
        next = x / 8;
      else
        next = high > 4 * low ? std::sqrt(low) * std::sqrt(high) : 0.5 * (low + high);
      last = std::numeric_limits<double>::infinity();
    }
    x = next;
  }
  return {x, max_evaluations, false};
}

/// Solves f(x) = 0 between `a` and `b`, where f has the values fa and fb of opposite sign: bisection or inverse quadratic
/// interpolation, whichever is safe. Chandrupatla (1997), Adv. Eng. Software 28, 145. Stops within `tolerance` of a sign change.
template <class F>
Root bracketed_root(F&& f, double a, double fa, double b, double fb, double tolerance) {
  constexpr int max_evaluations = 100;
  double c = a, fc = fa, t = 0.5;  // c: the end that was left last; next point a + t (b - a)
  for (int n = 1; n <= max_evaluations; ++n) {
    const double x = a + t * (b - a), fx = f(x);
    if ((fx > 0.0) == (fa > 0.0))
      c = a, fc = fa;
    else
      c = b, fc = fb, b = a, fb = fa;
    a = x, fa = fx;
    const double best = std::abs(fa) < std::abs(fb) ? a : b, limit = tolerance / std::abs(b - a);
    if (fa == 0.0 || limit > 0.5) return {best, n, true};
    const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    t = 0.5;
    if (phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi)
      t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
    t = std::clamp(t, limit, 1.0 - limit);
  }
  return {a, max_evaluations, false};
}

}  // namespace spindrift
