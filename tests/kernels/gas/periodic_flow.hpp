// A small explicit solver of the Euler equations on a uniform periodic square: nothing but the kernels, MUSCL and a flux, and a
// three-stage Runge-Kutta step (Shu & Osher 1988), to measure what the kernels alone are worth.
// Used by tests/kernels/gas/smooth_flow_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/gas/flux.hpp"
#include "kernels/gas/muscl.hpp"

namespace spindrift::gas::testing {

using Row = Wide<double, 8>;

class PeriodicFlow {
 public:
  /// n cells in x and y, a multiple of 8, of size `size` [m] together.
  PeriodicFlow(const IdealGas& gas, int n, double size)
      : gas_(gas), n_(n), h_(size / n), row_(std::size_t(n) + 8), layer_(row_ * (n + 4)) {
    w_.resize(5 * layer_), q_.resize(5 * layer_), rate_.resize(5 * layer_), start_.resize(5 * layer_);
  }
  double cell() const { return h_; }
  int cells() const { return n_; }
  double x(int i) const { return (i + 0.5) * h_; }
  Primitive<double> at(int j, int i) const { return load_primitive<double>(w_.data() + place(j, i), layer_); }

  template <class Start>
  void start(Start&& exact) {
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) {
        const Primitive<double> w = exact(x(i), x(j));
        store_primitive(w_.data() + place(j, i), layer_, w);
        store_conserved(q_.data() + place(j, i), layer_, conserved(gas_, w));
      }
  }

  template <class Scheme, class Limiter>
  void step(const Scheme& scheme, const Limiter& limiter, double dt) {
    start_ = q_;
    const double old_share[3] = {0.0, 0.75, 1.0 / 3.0};
    for (const double old : old_share) {
      find_rate(scheme, limiter);
      for (int j = 0; j < n_; ++j)
        for (int i = 0; i < n_; i += Row::size) {
          const std::size_t c = place(j, i);
          const auto before = load_conserved<Row>(start_.data() + c, layer_), now = load_conserved<Row>(q_.data() + c, layer_),
                     change = load_conserved<Row>(rate_.data() + c, layer_);
          const auto next = old * before + (1.0 - old) * (now + dt * change);
          store_conserved(q_.data() + c, layer_, next);
          store_primitive(w_.data() + c, layer_, primitive(gas_, next));
        }
    }
  }

  double kinetic_energy() const {
    double sum = 0;
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) sum += density(gas_, at(j, i)) * kinetic(at(j, i));
    return sum * h_ * h_;
  }
  /// Mean absolute error of a component (0 p ... 4 T) against exact(x, y).
  template <class Exact>
  double error(int component, Exact&& exact) const {
    double sum = 0;
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) {
        const Primitive<double> a = at(j, i), b = exact(x(i), x(j));
        sum += std::abs(*(&a.p + component) - *(&b.p + component));
      }
    return sum / (double(n_) * n_);
  }

 private:
  std::size_t place(int j, int i) const { return std::size_t(j + 2) * row_ + std::size_t(i + 2); }

  void wrap() {
    for (int c = 0; c < 5; ++c) {
      double* w = w_.data() + std::size_t(c) * layer_;
      for (int j = 0; j < n_; ++j)
        for (int g = 0; g < 2; ++g) w[place(j, n_ + g)] = w[place(j, g)], w[place(j, -1 - g)] = w[place(j, n_ - 1 - g)];
      for (int g = 0; g < 2; ++g)
        for (int i = 0; i < n_; ++i) w[place(n_ + g, i)] = w[place(g, i)], w[place(-1 - g, i)] = w[place(n_ - 1 - g, i)];
    }
  }

  template <class Scheme, class Limiter>
  void find_rate(const Scheme& scheme, const Limiter& limiter) {
    wrap();
    const auto face = [&](std::size_t right, std::size_t step, double nx, double ny) {
      const auto load = [&](std::size_t at) { return load_primitive<Row>(w_.data() + at, layer_); };
      const auto s = muscl(gas_, limiter, load(right - 2 * step), load(right - step), load(right), load(right + step));
      return scheme(gas_, s.l, s.r, Face<Row>{Row(nx), Row(ny), Row(0.0), Row(1.0 / h_), Row(0.0)});
    };
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; i += Row::size) {
        const std::size_t c = place(j, i);
        // Each face twice: simple, and both computations give the same bits.
        const auto sum =
            (face(c, 1, 1.0, 0.0) - face(c + 1, 1, 1.0, 0.0)) + (face(c, row_, 0.0, 1.0) - face(c + row_, row_, 0.0, 1.0));
        store_conserved(rate_.data() + c, layer_, sum);
      }
  }

  IdealGas gas_;
  int n_;
  double h_;
  std::size_t row_, layer_;
  std::vector<double> w_, q_, rate_, start_;
};

}  // namespace spindrift::gas::testing
