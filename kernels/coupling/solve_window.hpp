// A window iterated until its parts agree, and what is done where they do not. Fallback, in order: clear what the scheme has
// learned and relax (a few evaluations with a small constant factor), retry the scheme from there, then cut what is left of the
// window in halves. The window is abstract: a pure function of a snapshot and of interface data, which can therefore be repeated.
// Used by src/coupling/window.cpp; tested in tests/kernels/coupling, tests/verification/coupling and tests/extremes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <tuple>

#include "kernels/coupling/relaxation_constant.hpp"

namespace spindrift::coupling {

/// A window, or the piece of it that is next.
template <class W>
concept RepeatableWindow = requires(W window, const Vector& x) {
  { window.evaluate(x) } -> std::convertible_to<Vector>;  ///< runs the piece from its snapshot on data x; what the parts return
  { window.guess() } -> std::convertible_to<Vector>;      ///< x predicted for the piece
  window.accept();                                        ///< the piece last evaluated stands; the next begins where it ends
  { window.done() } -> std::convertible_to<bool>;         ///< no piece is left
  { window.halve() } -> std::convertible_to<bool>;        ///< pieces of half the length from here on; false: cannot be cut
};

struct IterationLimits {
  double relative = 1e-6;    ///< of the piece's first residual
  double absolute = 0.0;     ///< in units of x
  double of_output = 0.0;    ///< of the size of what the parts return: window.size_of(output) where it has that, else the norm
  int max_evaluations = 50;  ///< of one attempt, probes included
  double diverged = 1e4;     ///< times the first residual, or the first x where that is more: given up
  double fallback_relaxation = 0.05;
  int fallback_steps = 5;
  int max_cuts = 3;  ///< halvings of a window
};

/// What ended the iteration of a piece: a tolerance that was met, or the limit that was hit.
enum class Bound { relative, absolute, evaluations, divergence, not_finite };
inline constexpr std::string_view bound_name(Bound b) {
  constexpr std::array<std::string_view, 5> names{"relative tolerance", "absolute tolerance", "evaluation limit", "divergence",
                                                  "a value that is not finite"};
  return names[std::size_t(b)];
}
inline constexpr bool converged(Bound b) { return b == Bound::relative || b == Bound::absolute; }

/// How a window went, all pieces and attempts together.
struct WindowLog {
  int evaluations = 0;  ///< of the coupled window, probes included
  int probes = 0;
  int retries = 0;  ///< attempts after clearing and relaxing
  int cuts = 0;
  int columns = 0;                              ///< kept at the end
  double first_residual = 0.0, residual = 0.0;  ///< of the last attempt
  Bound bound = Bound::relative;                ///< of the last attempt
  bool ok() const { return converged(bound); }
};

namespace detail {

template <class Window>
double size_of(const Window& window, const Vector& output) {
  if constexpr (requires { window.size_of(output); })
    return window.size_of(output);
  else
    return output.norm();
}

/// One attempt from x on; x becomes the last iterate.
template <RepeatableWindow Window, Scheme S>
Bound attempt(Window& window, S& scheme, Vector& x, const IterationLimits& limits, int max_evaluations, WindowLog& log) {
  scheme.begin_window();
  log.first_residual = 0.0;
  const double scale = x.norm();
  Vector trial = x;
  for (int k = 0; k < max_evaluations; ++k) {
    const bool probe = scheme.probing();
    Vector output;
    if constexpr (requires { scheme.evaluate(window, trial); })
      output = scheme.evaluate(window, trial);
    else
      output = window.evaluate(trial);
    ++log.evaluations;
    log.probes += probe;
    const Vector r = output - trial;
    log.residual = r.norm();
    if (!std::isfinite(log.residual)) return Bound::not_finite;
    if (k == 0) log.first_residual = log.residual;
    if (!probe) x = trial;
    if (log.residual <= std::max(limits.absolute, limits.of_output * size_of(window, output))) return Bound::absolute;
    if (log.residual <= limits.relative * log.first_residual) return Bound::relative;
    if (log.residual > limits.diverged * std::max(log.first_residual, scale)) return Bound::divergence;
    trial = scheme.next(trial, r);
    if (!trial.allFinite()) return Bound::divergence;
  }
  return Bound::evaluations;
}

}  // namespace detail

/// Solves the whole window. On return with log.ok() every piece has been accepted; else the pieces before the failing one have,
/// and the caller goes back to its own snapshot.
template <RepeatableWindow Window, Scheme S>
WindowLog solve_window(Window& window, S& scheme, const IterationLimits& limits) {
  WindowLog log;
  while (!window.done()) {
    Vector x = window.guess();
    log.bound = detail::attempt(window, scheme, x, limits, limits.max_evaluations, log);
    if (!log.ok() && limits.fallback_steps > 0) {
      scheme.end_window(false);
      scheme.clear();
      ++log.retries;
      x = window.guess();
      RelaxationConstant relax(limits.fallback_relaxation);
      log.bound = detail::attempt(window, relax, x, limits, limits.fallback_steps, log);
      if (log.bound == Bound::evaluations) log.bound = detail::attempt(window, scheme, x, limits, limits.max_evaluations, log);
    }
    log.columns = scheme.columns();
    scheme.end_window(log.ok());
    if (log.ok()) {
      window.accept();
    } else {
      if (log.cuts == limits.max_cuts || !window.halve()) return log;
      ++log.cuts;
    }
  }
  return log;
}

// Two parts make a window in two ways; each is a fixed point to any scheme.

/// Gauss-Seidel: S(F(x)). Parts: Vector first(x), Vector second(y).
template <class Parts>
Vector evaluate_serial(Parts& parts, const Vector& x) {
  const Vector y = parts.first(x);
  return y.allFinite() ? Vector(parts.second(y)) : Vector(Vector::Constant(x.size(), std::numeric_limits<double>::quiet_NaN()));
}

/// Jacobi: both at once on z = (x, y), of which x has `rows` rows: (S(y), F(x)). Parts that can advance at once have both(x, y),
/// which returns (F(x), S(y)).
template <class Parts>
Vector evaluate_parallel(Parts& parts, const Vector& z, Eigen::Index rows) {
  Vector x, y;
  if constexpr (requires { parts.both(z.head(rows), z.tail(z.size() - rows)); })
    std::tie(y, x) = parts.both(z.head(rows), z.tail(z.size() - rows));
  else
    y = parts.first(z.head(rows)), x = parts.second(z.tail(z.size() - rows));
  Vector output(z.size());
  output << x, y;
  return output;
}

}  // namespace spindrift::coupling
