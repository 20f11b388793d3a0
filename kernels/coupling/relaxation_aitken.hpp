// Aitken's dynamic relaxation for vectors (Irons & Tuck 1969; Kuettler & Wall 2008, Comput. Mech. 43, eq. 44):
// omega_k = -omega_{k-1} r_{k-1} . (r_k - r_{k-1}) / |r_k - r_{k-1}|^2. A window starts with the last factor of the one before,
// in size at most the first factor given. Used by solve_window.hpp; tested in tests/kernels/coupling. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

class RelaxationAitken {
 public:
  static constexpr std::string_view name = "aitken";
  explicit RelaxationAitken(double first) : first_(first), omega_(first) {}

  void begin_window() { last_.resize(0); }
  Vector next(const Vector& x, const Vector& r) {
    if (last_.size() == 0) {
      omega_ = std::copysign(std::min(std::abs(omega_), first_), omega_);
    } else {
      const Vector change = r - last_;
      if (const double size = change.squaredNorm(); size > 0.0) omega_ *= -last_.dot(change) / size;
      if (omega_ == 0.0) omega_ = first_;  // r orthogonal to its change: start again rather than stand still
    }
    last_ = r;
    return x + omega_ * r;
  }
  void end_window(bool converged) {
    last_.resize(0);
    if (!converged) omega_ = first_;
  }
  void clear() { omega_ = first_, last_.resize(0); }
  int columns() const { return 0; }
  bool probing() const { return false; }
  void visit(auto& v) { v(omega_), v(last_); }

 private:
  double first_, omega_;
  Vector last_;
};
static_assert(Scheme<RelaxationAitken>);

}  // namespace spindrift::coupling
