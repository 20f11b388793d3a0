// Radiation memory as decaying oscillations, K(t) = sum Re{c exp(p t)}, so that its convolution with a velocity is a state for
// each pole. Poles by the singular values of the Hankel matrix of K's samples (Kung 1978, 12th Asilomar conference, 705; for
// floating bodies Kristiansen, Hjulstad & Egeland 2005, Ocean Eng. 32, 2195), c by least squares. Theory:
// docs/theory/sea_engineering.md. Used by src/sea/radiation.cpp; tested in tests/kernels/waves/radiation_poles_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

namespace spindrift::waves {

/// Sum of Re{c exp(p t)}, one of each pair of complex poles.
struct RadiationPoles {
  std::vector<std::complex<double>> pole, weight;  ///< p [1/s], Re p < 0; c
  double error = 0.0;                              ///< root mean square, of the samples [their unit]

  double at(double t) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < pole.size(); ++k) sum += (weight[k] * std::exp(pole[k] * t)).real();
    return sum;
  }
};

/// int_0^s exp(p (s - x)) v(x) dx for v straight from v0 at 0 to v1 at s; exact.
inline std::complex<double> pole_response(std::complex<double> p, double s, double v0, double v1) {
  const std::complex<double> z = p * s;
  std::complex<double> first, second;  // (e^z - 1) / z, (e^z - 1 - z) / z^2
  if (std::abs(z) < 0.1) {
    std::complex<double> term = 1.0;
    for (int n = 1; n <= 8; ++n) first += term / double(n), second += term / double(n * (n + 1)), term *= z / double(n);
  } else {
    first = (std::exp(z) - 1.0) / z, second = (first - 1.0) / z;
  }
  return s * (v0 * first + (v1 - v0) * second);
}

/// The fewest poles (`most_poles` at most, pairs counted twice) that reproduce K at 0, h, 2h ... to a root mean square of
/// `tolerance`; the best found where none does. At least nine samples.
inline RadiationPoles fit_radiation_poles(std::span<const double> samples, double h, double tolerance, int most_poles = 24) {
  const Eigen::Index count = Eigen::Index(samples.size()), half = (count + 1) / 2;
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(samples.data(), count);
  Eigen::MatrixXd hankel(half, count - half + 1);
  for (Eigen::Index i = 0; i < hankel.rows(); ++i)
    for (Eigen::Index j = 0; j < hankel.cols(); ++j) hankel(i, j) = y[i + j];
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(hankel, Eigen::ComputeThinU);
  RadiationPoles best;
  best.error = std::sqrt(y.squaredNorm() / double(count));
  if (best.error <= tolerance) return best;
  const Eigen::Index most = std::min<Eigen::Index>(most_poles, hankel.cols() - 1);
  for (Eigen::Index order = 1; order <= most; ++order) {
    if (svd.singularValues()[order - 1] <= 1e-14 * svd.singularValues()[0]) break;
    // One sample later is one application of the system's matrix: U shifted by a row.
    const Eigen::MatrixXd u = svd.matrixU().leftCols(order);
    const Eigen::MatrixXd shift = u.topRows(half - 1).colPivHouseholderQr().solve(u.bottomRows(half - 1));
    // U holds the observability matrix up to a change of base, which keeps the eigenvalues.
    const Eigen::VectorXcd roots = Eigen::EigenSolver<Eigen::MatrixXd>(shift, false).eigenvalues();
    RadiationPoles fit;
    for (const std::complex<double>& root : roots) {
      const bool decays = std::abs(root) > 1e-12 && std::abs(root) < 1.0 - 1e-9;
      const bool sampled = root.imag() > 0.0 || (root.imag() == 0.0 && root.real() > 0.0);  // one of a pair; no sign changes
      if (decays && sampled) fit.pole.push_back(std::log(root) / h);
    }
    if (fit.pole.empty()) continue;
    Eigen::MatrixXd base(count, 2 * Eigen::Index(fit.pole.size()));
    Eigen::Index columns = 0;
    for (const std::complex<double>& p : fit.pole) {
      for (Eigen::Index n = 0; n < count; ++n) {
        const std::complex<double> e = std::exp(p * (double(n) * h));
        base(n, columns) = e.real();
        if (p.imag() != 0.0) base(n, columns + 1) = -e.imag();
      }
      columns += p.imag() != 0.0 ? 2 : 1;
    }
    const Eigen::VectorXd c = base.leftCols(columns).colPivHouseholderQr().solve(y);
    Eigen::Index column = 0;
    for (const std::complex<double>& p : fit.pole) {
      fit.weight.emplace_back(c[column], p.imag() != 0.0 ? c[column + 1] : 0.0);
      column += p.imag() != 0.0 ? 2 : 1;
    }
    fit.error = std::sqrt((base.leftCols(columns) * c - y).squaredNorm() / double(count));
    if (fit.error < best.error) best = fit;
    if (best.error <= tolerance) break;
  }
  return best;
}

}  // namespace spindrift::waves
