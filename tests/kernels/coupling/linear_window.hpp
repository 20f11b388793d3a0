// Six rows that react linearly: loads of a rigid body whose fluid weighs r times as much, seen by any scheme. Used by tests of
// schemes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <functional>

#include "kernels/coupling/ibqn_ls.hpp"
#include "kernels/coupling/interface_gmres.hpp"
#include "kernels/coupling/iqn_ils.hpp"
#include "kernels/coupling/newton.hpp"
#include "kernels/coupling/relaxation_aitken.hpp"
#include "kernels/coupling/relaxation_steepest_descent.hpp"
#include "kernels/coupling/solve_window.hpp"

namespace spindrift::coupling::test {

/// F(x) = b - r A x with eigenvalues of A from 0.1 to 1 (symmetric), S(y) = B y with B near the identity.
class LinearWindow {
 public:
  explicit LinearWindow(double r) : r_(r), a_(6, 6), b_(6, 6), load_(6) {
    Matrix skew(6, 6);
    for (int i = 0; i < 6; ++i) {
      load_[i] = std::sin(1.0 + i);
      for (int j = 0; j < 6; ++j) skew(i, j) = 0.3 * std::sin(1.0 * (i - j)), b_(i, j) = (i == j) + 0.05 * std::cos(3.0 * i + j);
    }
    const Matrix one = Matrix::Identity(6, 6), q = (one + skew).partialPivLu().solve(one - skew);  // Cayley: orthogonal
    a_ = q * Vector{{1.0, 0.8, 0.5, 0.3, 0.2, 0.1}}.asDiagonal() * q.transpose();
  }
  Vector first(const Vector& x) { return load_ - r_ * (a_ * x); }
  Vector second(const Vector& y) { return b_ * y; }
  Vector evaluate(const Vector& x) { return evaluate_serial(*this, last_ = x); }
  Vector guess() const { return Vector::Zero(6); }
  void accept() { done_ = true; }
  bool done() const { return done_; }
  bool halve() const { return false; }
  void again() { done_ = false; }
  /// The next window's load.
  void load(double angle) { load_ = load_ * std::cos(angle) + Vector::LinSpaced(6, -1.0, 1.0) * std::sin(angle); }

 private:
  double r_;
  Matrix a_, b_;
  Vector load_, last_;
  bool done_ = false;
};

}  // namespace spindrift::coupling::test
