// SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/differences.hpp"

namespace spindrift::coupling {

namespace {

void push_front(Matrix& m, const Vector& column) {
  Matrix wider(column.size(), m.cols() + 1);
  wider.col(0) = column;
  if (m.cols() > 0) wider.rightCols(m.cols()) = m;
  m = std::move(wider);
}

void erase(Matrix& m, Eigen::Index i) {
  const Eigen::Index after = m.cols() - i - 1;
  if (after > 0) m.middleCols(i, after) = m.rightCols(after).eval();
  m.conservativeResize(Eigen::NoChange, m.cols() - 1);
}

}  // namespace

void Differences::add(const Vector& v, const Vector& w) {
  if (!v.allFinite() || !w.allFinite() || v.squaredNorm() == 0.0) return;
  push_front(v_, v), push_front(w_, w);
  age_.insert(age_.begin(), 0);
  factorise();
}

void Differences::end_window() {
  for (int& age : age_) ++age;
  while (!age_.empty() && age_.back() > options_.reuse) remove(age_.size() - 1);
  factorise();
}

void Differences::clear() {
  v_.resize(0, 0), w_.resize(0, 0);
  age_.clear();
  factorise();
}

Vector Differences::fit(const Vector& target) const { return r_.triangularView<Eigen::Upper>().solve(q_.transpose() * target); }

Vector Differences::map(const Vector& change) const { return w_ * fit(change); }

Vector Differences::span(const Vector& c) const { return v_ * c; }

void Differences::remove(std::size_t i) {
  erase(v_, Eigen::Index(i)), erase(w_, Eigen::Index(i));
  age_.erase(age_.begin() + std::ptrdiff_t(i));
}

void Differences::factorise() {
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

}  // namespace spindrift::coupling
