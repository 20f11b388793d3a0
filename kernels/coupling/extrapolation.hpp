// Predictors: interface data beyond the last window by the polynomial of order 0, 1 or 2 through the last values, windows of any
// lengths. While fewer windows have passed the order is lower. Order 1 on unequal windows is
// v_n + (dt_new / dt_old)(v_n - v_{n-1}), as the second-order staggered schemes of Farhat, van der Zee & Geuzaine (2006) use it.
// Used by staggered.hpp, src/coupling/window.cpp; tested in tests/kernels/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/waveform.hpp"

namespace spindrift::coupling {

class Extrapolation {
 public:
  explicit Extrapolation(int order) : order_(order) {}

  void add(double t, Vector value) {
    times_.push_back(t), values_.push_back(std::move(value));
    if (int(times_.size()) > order_ + 1) times_.erase(times_.begin()), values_.erase(values_.begin());
  }
  bool empty() const { return times_.empty(); }
  const Vector& last() const { return values_.back(); }
  std::size_t windows() const { return values_.size(); }
  void at(double t, Vector& out) const { lagrange(times_, values_, t, out); }
  Vector at(double t) const {
    Vector value;
    at(t, value);
    return value;
  }
  void visit(auto& v) { v(times_), v(values_); }

 private:
  int order_;
  std::vector<double> times_;
  std::vector<Vector> values_;
};

}  // namespace spindrift::coupling
