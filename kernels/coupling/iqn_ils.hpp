// Interface quasi-Newton with the inverse Jacobian from a least-squares model (Degroote, Bathe & Vierendeels 2009, Comput.
// Struct. 87), IQN-ILS: with V = [changes of r], W = [changes of x~], x_next = x~ + W c where V c is nearest to -r. The first
// step of a window without columns is relaxed. Columns of earlier windows stay as long as asked for. Used by solve_window.hpp;
// tested in tests/kernels/coupling and tests/verification/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/differences.hpp"

namespace spindrift::coupling {

class IqnIls {
 public:
  static constexpr std::string_view name = "iqn_ils";
  IqnIls(double relaxation, LearningOptions learning) : relaxation_(relaxation), learned_(learning) {}

  void begin_window() { r_.resize(0); }
  Vector next(const Vector& x, const Vector& r) {
    const Vector output = x + r;
    if (r_.size() > 0) learned_.add(r - r_, output - output_);
    r_ = r, output_ = output;
    if (learned_.columns() == 0) return x + relaxation_ * r;
    return output + learned_.map(-r);
  }
  /// A window that failed taught nothing to rely on.
  void end_window(bool converged) {
    r_.resize(0), output_.resize(0);
    converged ? learned_.end_window() : learned_.clear();
  }
  void clear() { r_.resize(0), output_.resize(0), learned_.clear(); }
  int columns() const { return learned_.columns(); }
  bool probing() const { return false; }
  void visit(auto& v) { v(r_), v(output_), learned_.visit(v); }

 private:
  double relaxation_;
  Differences learned_;
  Vector r_, output_;
};
static_assert(Scheme<IqnIls>);

}  // namespace spindrift::coupling
