// Interface-GMRES (Michler, van Brummelen & de Borst 2005, Int. J. Numer. Meth. Fluids 47): Newton iteration on r(x) = 0 whose
// linear problem is solved by a Krylov method on the interface, each vector costing one evaluation at x plus a finite step along
// it. The next direction is what is left of the linear residual; steps and the changes of r they cause are kept through the
// window and as many windows on as asked for ("reuse of Krylov vectors"). Newton steps when the linear residual is below
// `forcing`. Used by solve_window.hpp; tested in tests/kernels/coupling and tests/verification/coupling. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include "kernels/coupling/differences.hpp"

namespace spindrift::coupling {

class InterfaceGmres {
 public:
  static constexpr std::string_view name = "interface_gmres";
  static constexpr double forcing = 0.1;  ///< linear residual over r at which Newton steps
  /// `relaxation`: length of a trial step over the linear residual.
  InterfaceGmres(double relaxation, LearningOptions learning) : relaxation_(relaxation), learned_(learning) {}

  void begin_window() { probing_ = false, tried_ = 0; }
  Vector next(const Vector& x, const Vector& r) {
    if (probing_) {
      learned_.add(r - r_, x - x_);
    } else {
      x_ = x, r_ = r, tried_ = 0;
    }
    const Vector c = learned_.columns() > 0 ? learned_.fit(-r_) : Vector();
    const Vector left = c.size() > 0 ? Vector(r_ + learned_.span(c)) : r_;
    const bool enough = left.norm() <= forcing * r_.norm();
    // A space that fills the interface, or probes that no longer add to it, leave nothing to try.
    if (enough || tried_ >= int(x.size())) {
      probing_ = false;
      return c.size() > 0 ? Vector(x_ + learned_.images() * c) : Vector(x_ + relaxation_ * r_);
    }
    probing_ = true;
    ++tried_;
    return x_ + relaxation_ * left;
  }
  void end_window(bool converged) {
    probing_ = false;
    x_.resize(0), r_.resize(0);
    converged ? learned_.end_window() : learned_.clear();
  }
  void clear() { end_window(false); }
  int columns() const { return learned_.columns(); }
  bool probing() const { return probing_; }
  void visit(auto& v) { v(probing_), v(tried_), v(x_), v(r_), learned_.visit(v); }

 private:
  double relaxation_;
  Differences learned_;
  bool probing_ = false;
  int tried_ = 0;
  Vector x_, r_;  ///< where Newton stands
};
static_assert(Scheme<InterfaceGmres>);

}  // namespace spindrift::coupling
