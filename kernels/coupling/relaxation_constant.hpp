// Fixed-point iteration with a constant factor: x + omega r; omega = 1 is the undamped (Gauss-Seidel or Jacobi) fixed point.
// Convergence on a linear interface of added-mass ratio m needs omega < 2 / (1 + m) (Causin, Gerbeau & Nobile 2005).
// Used by solve_window.hpp, also as the fallback of other schemes. Tested in tests/kernels/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

class RelaxationConstant {
 public:
  static constexpr std::string_view name = "relaxation";
  explicit RelaxationConstant(double omega) : omega_(omega) {}
  void begin_window() {}
  Vector next(const Vector& x, const Vector& r) { return x + omega_ * r; }
  void end_window(bool) {}
  void clear() {}
  int columns() const { return 0; }
  bool probing() const { return false; }
  void visit(auto&) {}

 private:
  double omega_;
};
static_assert(Scheme<RelaxationConstant>);

}  // namespace spindrift::coupling
