// Newton's method on r(x) = 0 with the Jacobian by forward differences, one evaluation per row of the interface (Fernandez &
// Moubachir 2005 use the exact one; for a few rows differences are cheaper to have). The Jacobian is formed at the first iterate
// of a window and again wherever a step reduced the residual by less than a factor of ten. Used by solve_window.hpp; tested in
// tests/kernels/coupling and tests/verification/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/scheme.hpp"
#include "kernels/linear/dense.hpp"

namespace spindrift::coupling {

class Newton {
 public:
  static constexpr std::string_view name = "newton";
  static constexpr double difference = 1e-6, keep_below = 0.1;
  /// `smallest`: least trial step in units of x.
  explicit Newton(double smallest) : smallest_(smallest) {}

  void begin_window() { clear(); }
  Vector next(const Vector& x, const Vector& r) {
    if (row_ >= 0) {
      jacobian_.col(row_) = (r - r_) / step_;
      if (++row_ < int(x.size())) return trial();
      row_ = -1;
      return step();
    }
    const bool keep = jacobian_.size() > 0 && r.norm() <= keep_below * r_.norm();
    x_ = x, r_ = r;
    if (keep) return step();
    jacobian_.resize(x.size(), x.size());
    step_ = std::max(smallest_, difference * std::max(x.cwiseAbs().maxCoeff(), r.cwiseAbs().maxCoeff()));
    row_ = 0;
    return trial();
  }
  void end_window(bool) { clear(); }
  void clear() {
    row_ = -1;
    jacobian_.resize(0, 0), x_.resize(0), r_.resize(0);
  }
  int columns() const { return int(jacobian_.cols()); }
  bool probing() const { return row_ >= 0; }
  void visit(auto& v) { v(row_), v(step_), v(jacobian_), v(x_), v(r_); }

 private:
  Vector trial() const {
    Vector x = x_;
    x[row_] += step_;
    return x;
  }
  Vector step() const { return x_ - dense::solve(jacobian_, r_); }

  double smallest_, step_ = 0.0;
  int row_ = -1;  ///< being tried
  Matrix jacobian_;
  Vector x_, r_;
};
static_assert(Scheme<Newton>);

}  // namespace spindrift::coupling
