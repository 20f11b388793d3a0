// The small dense part of the Krylov methods: coefficients from dot products, without a vector in sight. Vectors live in tiles;
// the tasks of src/aero/flow make them, reduce their dot products once per iteration and ask these structs what to do with them.
// GMRES: Saad & Schultz (1986), right-preconditioned; flexible: Saad (1993). GCG: Eisenstat, Elman & Schultz (1983).
// Tested in tests/kernels/linear/krylov_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace spindrift::linear {

inline constexpr int max_krylov = 40;  ///< most vectors of a cycle

/// The Hessenberg matrix of GMRES, reduced by rotations as it grows.
/// Classical Gram-Schmidt with one reduction: (w, v_0) ... (w, v_j) and (w, w) together; the norm of what remains follows by
/// Pythagoras. Loses digits where w lies nearly among the v; then `breakdown` says that the cycle should end here.
class Gmres {
 public:
  void start(double residual_norm) {
    columns_ = 0;
    g_.fill(0.0);
    g_[0] = residual_norm;
    breakdown_ = false;
  }
  int columns() const { return columns_; }
  bool breakdown() const { return breakdown_; }
  double residual_norm() const { return std::abs(g_[columns_]); }

  /// dots: (w, v_0) ... (w, v_j), (w, w) with j = columns(). After it next_scale() and projections() say what v_{j+1} is.
  void append(std::span<const double> dots) {
    const int j = columns_;
    double rest = dots[j + 1];
    for (int r = 0; r <= j; ++r) h_[r][j] = raw_[r] = dots[r], rest -= dots[r] * dots[r];
    breakdown_ = !(rest > 1e-6 * dots[j + 1]);  // float vectors carry seven digits: what is left would be noise
    const double length = std::sqrt(std::max(rest, 0.0));
    scale_ = breakdown_ ? 0.0 : 1.0 / length;
    for (int r = 0; r < j; ++r) {
      const double a = h_[r][j], b = h_[r + 1][j];
      h_[r][j] = c_[r] * a + s_[r] * b;
      h_[r + 1][j] = -s_[r] * a + c_[r] * b;
    }
    const double radius = std::hypot(h_[j][j], length);
    c_[j] = radius > 0.0 ? h_[j][j] / radius : 1.0;
    s_[j] = radius > 0.0 ? length / radius : 0.0;
    h_[j][j] = radius;
    g_[j + 1] = -s_[j] * g_[j];
    g_[j] *= c_[j];
    ++columns_;
  }
  /// v_{j+1} = (w - sum projections[r] v_r) * next_scale().
  std::span<const double> projections() const { return {raw_.data(), std::size_t(columns_)}; }
  double next_scale() const { return scale_; }

  /// x = sum y_r z_r minimises the residual over the columns so far.
  void solve(std::span<double> y) const {
    for (int r = columns_ - 1; r >= 0; --r) {
      double sum = g_[r];
      for (int c = r + 1; c < columns_; ++c) sum -= h_[r][c] * y[c];
      y[r] = h_[r][r] != 0.0 ? sum / h_[r][r] : 0.0;
    }
  }

 private:
  int columns_ = 0;
  bool breakdown_ = false;
  double scale_ = 0.0;
  std::array<std::array<double, max_krylov>, max_krylov + 1> h_{};
  std::array<double, max_krylov + 1> g_{}, raw_{};
  std::array<double, max_krylov> c_{}, s_{};
};

/// Generalised conjugate gradients with all directions of a cycle kept: p = z + sum beta_r p_r with A p orthogonal to all A p_r,
/// then x += alpha p, r -= alpha A p. One reduction: with w = A z, (w, q_0) ... (w, q_{j-1}), (w, w), (r, w); q = A p of unit
/// length.
class Gcg {
 public:
  void start(double residual_norm) { columns_ = 0, square_ = residual_norm * residual_norm, breakdown_ = false; }
  int columns() const { return columns_; }
  bool breakdown() const { return breakdown_; }
  double residual_norm() const { return std::sqrt(std::max(0.0, square_)); }

  /// After it: p_j = (z - sum projections[r] p_r) scale, q_j = (w - sum projections[r] q_r) scale, x += alpha p_j, r -= alpha
  /// q_j.
  void append(std::span<const double> dots) {
    const int j = columns_;
    double rest = dots[j];
    for (int r = 0; r < j; ++r) beta_[r] = dots[r], rest -= dots[r] * dots[r];
    breakdown_ = !(rest > 1e-6 * dots[j]);
    scale_ = breakdown_ ? 0.0 : 1.0 / std::sqrt(rest);
    alpha_ = dots[j + 1] * scale_;  // r is orthogonal to all q_r
    square_ -= alpha_ * alpha_;
    ++columns_;
  }
  std::span<const double> projections() const { return {beta_.data(), std::size_t(columns_ - 1)}; }
  double scale() const { return scale_; }
  double alpha() const { return alpha_; }

 private:
  int columns_ = 0;
  bool breakdown_ = false;
  double square_ = 0.0, scale_ = 0.0, alpha_ = 0.0;
  std::array<double, max_krylov> beta_{};
};

}  // namespace spindrift::linear
