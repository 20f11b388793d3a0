// Steady waves of any height in any depth as a Fourier series of the stream function: Rienecker & Fenton (1981), J. Fluid Mech.
// 104, 119-137; Fenton (1988), Computers & Geosciences 14, 357-368. In the frame of the wave, y from the bed,
//   psi(x, y) = -u y + sum_j B_j sinh jky / cosh jkh cos jkx,   psi = -Q and (psi_x^2 + psi_y^2)/2 + g eta = R on the surface,
// held at N + 1 points from crest to trough, with mean depth h, height H, and no mean current, so that u is the wave's speed.
// In the frame of the earth these are the harmonics of components.hpp. Called by src/sea/wave_stream_function; tested in
// tests/kernels/waves/stream_function_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/linear/dense.hpp"
#include "kernels/waves/components.hpp"
#include "kernels/waves/dispersion.hpp"

namespace spindrift::waves {

/// A steady wave, crest at x = 0; lengths in units of the depth, speeds of sqrt(g h).
struct StreamFunctionWave {
  double wave_number = 0.0, speed = 0.0;  ///< k h, c / sqrt(g h)
  Eigen::VectorXd surface;                ///< heights over the bed at N + 1 points from crest to trough
  Eigen::VectorXd coefficients;           ///< B_j, j = 1 ... N
};

/// Equations of Rienecker & Fenton for N harmonics. Unknowns: N + 1 heights, N coefficients, speed, Q, R, k.
class StreamFunctionEquations {
 public:
  StreamFunctionEquations(int harmonics, double height, double period) : n_(harmonics), height_(height), period_(period) {}
  Eigen::Index size() const { return 2 * n_ + 5; }
  double& height() { return height_; }

  /// A linear wave.
  Eigen::VectorXd linear() const {
    const double omega = 2.0 * pi / period_, k = waves::wave_number(omega, 1.0, 1.0), c = omega / k;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
    for (int m = 0; m <= n_; ++m) x[m] = 1.0 + 0.5 * height_ * std::cos(m * pi / n_);
    x[n_ + 1] = 0.5 * height_ / c;  // u at the surface: k B_1 = a omega / tanh kh
    x[2 * n_ + 1] = c, x[2 * n_ + 2] = c, x[2 * n_ + 3] = 1.0 + 0.5 * c * c, x[2 * n_ + 4] = k;
    return x;
  }

  /// What is left of the equations at x, and their derivatives.
  void evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& d) const {
    f.setZero(size()), d.setZero(size(), size());
    const Eigen::Index u = 2 * n_ + 1, q = u + 1, r = u + 2, k = u + 3;
    const double speed = x[u], number = x[k];
    for (int m = 0; m <= n_; ++m) {
      const Eigen::Index e = n_ + 1 + m;
      const double eta = x[m];
      double psi = 0.0, along = -speed, up = 0.0;                                    // velocity in the frame of the wave
      double psi_k = 0.0, along_eta = 0.0, up_eta = 0.0, along_k = 0.0, up_k = 0.0;  // their derivatives
      Eigen::VectorXd along_b(n_), up_b(n_);
      for (int j = 1; j <= n_; ++j) {
        const double jk = j * number, b = x[n_ + j], cosine = std::cos(j * m * pi / n_), sine = std::sin(j * m * pi / n_);
        // sinh and cosh of jk eta over cosh jk: no overflow in deep water.
        const double rise = std::exp(jk * (eta - 1.0)), fall = std::exp(-jk * (eta + 1.0)), deep = 1.0 + std::exp(-2.0 * jk);
        const double s = (rise - fall) / deep, c = (rise + fall) / deep, t = std::tanh(jk);
        const double s_k = j * (eta * c - t * s), c_k = j * (eta * s - t * c);
        psi += b * s * cosine, psi_k += b * s_k * cosine;
        along_b[j - 1] = jk * c * cosine, up_b[j - 1] = jk * s * sine;
        along += b * along_b[j - 1], up += b * up_b[j - 1];
        along_eta += jk * jk * b * s * cosine, up_eta += jk * jk * b * c * sine;
        along_k += b * cosine * (j * c + jk * c_k), up_k += b * sine * (j * s + jk * s_k);
        d(m, n_ + j) = s * cosine;
      }
      f[m] = psi - speed * eta + x[q];
      d(m, m) = along, d(m, u) = -eta, d(m, q) = 1.0, d(m, k) = psi_k;
      f[e] = 0.5 * (along * along + up * up) + eta - x[r];
      for (int j = 1; j <= n_; ++j) d(e, n_ + j) = along * along_b[j - 1] + up * up_b[j - 1];
      d(e, m) = along * along_eta + up * up_eta + 1.0, d(e, u) = -along, d(e, r) = -1.0, d(e, k) = along * along_k + up * up_k;
    }
    const Eigen::Index mean = 2 * n_ + 2;
    for (int m = 0; m <= n_; ++m) {
      const double weight = (m == 0 || m == n_ ? 0.5 : 1.0) / n_;
      f[mean] += weight * x[m], d(mean, m) = weight;
    }
    f[mean] -= 1.0;
    f[mean + 1] = x[0] - x[n_] - height_, d(mean + 1, 0) = 1.0, d(mean + 1, n_) = -1.0;
    f[mean + 2] = speed * number * period_ - 2.0 * pi, d(mean + 2, u) = number * period_, d(mean + 2, k) = speed * period_;
  }

  /// Newton's method from x; false where it does not end.
  bool solve(Eigen::VectorXd& x) const {
    Eigen::VectorXd f;
    Eigen::MatrixXd d;
    for (int iteration = 0; iteration < 40; ++iteration) {
      evaluate(x, f, d);
      const Eigen::VectorXd step = dense::solve(d, f);
      if (!step.allFinite()) return false;
      x -= step;
      if (!(x[0] > x[n_]) || !(x[size() - 1] > 0.0) || x.head(n_ + 1).minCoeff() <= 0.0) return false;
      if (step.norm() < 1e-11 * x.norm()) return true;
    }
    return false;
  }

 private:
  int n_;
  double height_, period_;
};

/// The wave of N harmonics, found from lower ones of the same period; nothing where there is none. Height [-] over the depth,
/// period [-] times sqrt(g / h).
inline std::optional<StreamFunctionWave> stream_function_wave(int harmonics, double height, double period) {
  StreamFunctionEquations equations(harmonics, 0.0, period);
  // From low waves up: each guess is the straight line through the two before.
  constexpr int steps = 12;
  Eigen::VectorXd x, before, last;
  for (int i = 1; i <= steps; ++i) {
    equations.height() = height * i / steps;
    if (i == 1)
      x = equations.linear();
    else
      x = i == 2 ? last : Eigen::VectorXd(2.0 * last - before);
    if (!equations.solve(x)) return std::nullopt;
    before = last, last = x;
  }
  StreamFunctionWave wave{x[2 * harmonics + 4], x[2 * harmonics + 1], x.head(harmonics + 1), x.segment(harmonics + 1, harmonics)};
  return wave;
}

/// The same in harmonics of the sea, crest at phase 0. Height, depth [m], period [s]. Nothing where there is no such wave, or 48
/// harmonics do not hold it.
inline std::vector<Component> stream_function_components(double height, double period, double depth, double gravity, double phase,
                                                         double direction) {
  constexpr double enough = 1e-4;  // last harmonic of the elevation over the first
  for (const int n : {8, 16, 24, 32, 48}) {
    const auto wave = stream_function_wave(n, height / depth, period * std::sqrt(gravity / depth));
    if (!wave) continue;
    const double k = wave->wave_number, speed_unit = std::sqrt(gravity * depth);
    std::vector<Component> components;
    for (int j = 1; j <= n; ++j) {
      double amplitude = 0.0;
      for (int m = 0; m <= n; ++m) {
        const double end = m == 0 || m == n ? 0.5 : 1.0;
        amplitude += end * wave->surface[m] * std::cos(j * m * pi / n);
      }
      amplitude *= (j == n ? 1.0 : 2.0) / n;
      components.push_back({.wave_number = j * k / depth,
                            .angular_frequency = j * 2.0 * pi / period,
                            .amplitude = amplitude * depth,
                            .speed_amplitude = j * k * wave->coefficients[j - 1] * std::tanh(j * k) * speed_unit,
                            .phase = j * phase,
                            .direction = direction});
    }
    if (std::abs(components.back().amplitude) < enough * components.front().amplitude) return components;
  }
  return {};
}

}  // namespace spindrift::waves
