// Pairs of differences (v, w), newest first, of this window and some before it, and the least-squares map v -> w that they span:
// what the quasi-Newton schemes learn from. Columns that add nothing new are dropped by a QR filter from the newest to the
// oldest: v is kept where its part across the newer ones exceeds `filter` |v| ("QR2" of Haelterman, Bogaers, Scheufele, Uekermann
// & Mehl 2016, Comput. Struct. 171). Used by iqn_ils.hpp, ibqn_ls.hpp, interface_gmres.hpp; tested in tests/kernels/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

struct LearningOptions {
  int reuse = 0;         ///< windows before this one whose columns stay
  double filter = 1e-6;  ///< least new part of a column over its size
};

class Differences {
 public:
  explicit Differences(LearningOptions options) : options_(options) {}

  int columns() const { return int(v_.cols()); }
  const Matrix& images() const { return w_; }
  int in_this_window() const { return int(std::count(age_.begin(), age_.end(), 0)); }

  /// A pair that is not finite or does not move teaches nothing and is left out.
  void add(const Vector& v, const Vector& w) {
    if (!v.allFinite() || !w.allFinite() || v.squaredNorm() == 0.0) return;
    push_front(v_, v), push_front(w_, w);
    age_.insert(age_.begin(), 0);
    factorise();
  }
  void end_window() {
    for (int& age : age_) ++age;
    while (!age_.empty() && age_.back() > options_.reuse) remove(age_.size() - 1);
    factorise();
  }
  void clear() {
    v_.resize(0, 0), w_.resize(0, 0);
    age_.clear();
    factorise();
  }

  /// c with V c nearest to `target`.
  Vector fit(const Vector& target) const { return r_.triangularView<Eigen::Upper>().solve(q_.transpose() * target); }
  /// The map from a change of v to a change of w: W fit(change).
  Vector map(const Vector& change) const { return w_ * fit(change); }
  /// V c.
  Vector span(const Vector& c) const { return v_ * c; }

  /// Factors follow from the columns, and so are not saved.
  void visit(auto& visitor) {
    visitor(v_), visitor(w_), visitor(age_);
    factorise();
  }

 private:
  static void push_front(Matrix& m, const Vector& column) {
    Matrix wider(column.size(), m.cols() + 1);
    wider.col(0) = column;
    if (m.cols() > 0) wider.rightCols(m.cols()) = m;
    m = std::move(wider);
  }
  static void erase(Matrix& m, Eigen::Index i) {
    const Eigen::Index after = m.cols() - i - 1;
    if (after > 0) m.middleCols(i, after) = m.rightCols(after).eval();
    m.conservativeResize(Eigen::NoChange, m.cols() - 1);
  }
  void remove(std::size_t i) {
    erase(v_, Eigen::Index(i)), erase(w_, Eigen::Index(i));
    age_.erase(age_.begin() + std::ptrdiff_t(i));
  }

  /// Q R of the columns that pass the filter, by Gram-Schmidt applied twice; the others are dropped for good.
  void factorise() {
    q_.resize(v_.rows(), v_.cols());
    r_.setZero(v_.cols(), v_.cols());
    Eigen::Index kept = 0;
    while (kept < v_.cols()) {
      const double size = v_.col(kept).norm();
      Vector across = v_.col(kept);
      for (int pass = 0; pass < 2; ++pass) {
        const Vector along = q_.leftCols(kept).transpose() * across;
        r_.col(kept).head(kept) += along;
        across -= q_.leftCols(kept) * along;
      }
      const double left = across.norm();
      if (kept < v_.rows() && left > options_.filter * size) {
        q_.col(kept) = across / left;
        r_(kept, kept) = left;
        ++kept;
      } else {
        remove(std::size_t(kept));
        r_.col(kept).setZero();
      }
    }
    q_.conservativeResize(Eigen::NoChange, kept);
    r_.conservativeResize(kept, kept);
  }

  LearningOptions options_;
  Matrix v_, w_, q_, r_;
  std::vector<int> age_;  ///< windows since each column was learned
};

}  // namespace spindrift::coupling
