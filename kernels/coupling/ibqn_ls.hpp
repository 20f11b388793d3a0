// Interface block quasi-Newton with approximate Jacobians from least-squares models of both parts (Vierendeels, Lanoye, Degroote
// & Verdonck 2007, Comput. Struct. 85), IBQN-LS. Parts: y~ = F(x), x~ = S(y), with models M_F, M_S of their derivatives. In turn
//   dx: (I - M_S M_F) dx = (x~ - x) + M_S (y~ - y),  y~ = F(x + dx),  dy: (I - M_F M_S) dy = (y~ - y) + M_F (x~ - x),  x~ = S(y +
//   dy).
// The systems are solved in the span of the columns (Woodbury), whose number is small. F and S see different steps, so this
// scheme evaluates the parts itself (`evaluate`). Used by solve_window.hpp; tested in tests/kernels/coupling and
// tests/verification/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/differences.hpp"
#include "kernels/linear/dense.hpp"

namespace spindrift::coupling {

class IbqnLs {
 public:
  static constexpr std::string_view name = "ibqn_ls";
  IbqnLs(double relaxation, LearningOptions learning) : relaxation_(relaxation), first_(learning), second_(learning) {}

  void begin_window() { forget_last(); }

  /// x~ for x: both parts evaluated once, the second on data corrected by the models. Window: first(x) -> y~, second(y) -> x~.
  template <class Window>
  Vector evaluate(Window& window, const Vector& x) {
    const Vector y_output = window.first(x);
    if (!y_output.allFinite()) return Vector::Constant(x.size(), y_output.sum());  // not finite: for the driver to see
    if (x_.size() > 0) first_.add(x - x_, y_output - y_output_);
    Vector y = y_output;
    if (x_.size() > 0 && both_know()) y = y_ + solve(first_, second_, (y_output - y_) + first_.map(x_output_ - x));
    const Vector x_output = window.second(y);
    if (x_.size() > 0) second_.add(y - y_, x_output - x_output_);
    x_ = x, y_ = y, y_output_ = y_output, x_output_ = x_output;
    return x_output;
  }
  Vector next(const Vector& x, const Vector& r) {
    if (!both_know()) return x + relaxation_ * r;
    return x + solve(second_, first_, r + second_.map(y_output_ - y_));
  }
  void end_window(bool converged) {
    forget_last();
    for (Differences* d : {&first_, &second_}) converged ? d->end_window() : d->clear();
  }
  void clear() { forget_last(), first_.clear(), second_.clear(); }
  int columns() const { return first_.columns() + second_.columns(); }
  bool probing() const { return false; }
  void visit(auto& v) {
    first_.visit(v), second_.visit(v);
    for (Vector* x : {&x_, &y_, &x_output_, &y_output_}) v(*x);
  }

 private:
  bool both_know() const { return first_.columns() > 0 && second_.columns() > 0; }
  void forget_last() {
    for (Vector* x : {&x_, &y_, &x_output_, &y_output_}) x->resize(0);
  }
  /// (I - A B)^-1 b with A = Wa fit_a, B = Wb fit_b: I - Wa K fit_b with K = fit_a Wb.
  static Vector solve(const Differences& a, const Differences& b, const Vector& side) {
    Matrix k(a.columns(), b.columns()), back(b.columns(), a.columns());
    for (Eigen::Index j = 0; j < k.cols(); ++j) k.col(j) = a.fit(b.images().col(j));
    for (Eigen::Index j = 0; j < back.cols(); ++j) back.col(j) = b.fit(a.images().col(j));
    const Matrix system = Matrix::Identity(k.cols(), k.cols()) - back * k;
    return side + a.images() * (k * dense::solve(system, b.fit(side)));
  }

  double relaxation_;
  Differences first_, second_;
  Vector x_, y_, x_output_, y_output_;  ///< of the last evaluation
};
static_assert(Scheme<IbqnLs>);

}  // namespace spindrift::coupling
