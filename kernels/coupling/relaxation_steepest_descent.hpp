// Relaxation by steepest descent (Kuettler & Wall 2008, section 3.4): along r the factor omega = -r.r / (r . J r), J = dr/dx,
// makes the residual orthogonal to the step. J r comes from one more evaluation at x + delta r, so that an iteration costs two.
// Used by solve_window.hpp; tested in tests/kernels/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

class RelaxationSteepestDescent {
 public:
  static constexpr std::string_view name = "steepest_descent";
  /// `probe`: the trial step over r; also the factor where the curvature along r has no use (not falling).
  explicit RelaxationSteepestDescent(double probe) : probe_(probe) {}

  void begin_window() { probing_ = false; }
  Vector next(const Vector& x, const Vector& r) {
    if (!probing_) {
      probing_ = true;
      x_ = x, r_ = r;
      return x + probe_ * r;
    }
    probing_ = false;
    const double curvature = r_.dot(r - r_) / probe_;
    const double omega = curvature < 0.0 ? -r_.squaredNorm() / curvature : probe_;
    return x_ + omega * r_;
  }
  void end_window(bool) { clear(); }
  void clear() { probing_ = false, x_.resize(0), r_.resize(0); }
  int columns() const { return 0; }
  bool probing() const { return probing_; }
  void visit(auto& v) { v(probing_), v(x_), v(r_); }

 private:
  double probe_;
  bool probing_ = false;
  Vector x_, r_;
};
static_assert(Scheme<RelaxationSteepestDescent>);

}  // namespace spindrift::coupling
