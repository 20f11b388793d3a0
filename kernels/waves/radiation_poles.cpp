// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/radiation_poles.hpp"

#include <algorithm>
#include <numeric>

#include "kernels/linear/dense.hpp"

namespace spindrift::waves {

RadiationPoles fit_radiation_poles(std::span<const double> samples, double h, double tolerance, int most_poles) {
  const Eigen::Index count = Eigen::Index(samples.size()), half = (count + 1) / 2;
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(samples.data(), count);
  Eigen::MatrixXd hankel(half, half);
  for (Eigen::Index i = 0; i < half; ++i)
    for (Eigen::Index j = 0; j < half; ++j) hankel(i, j) = y[i + j];
  // Symmetric: the sizes of its eigenvalues are its singular values.
  const dense::SymmetricEigenpairs eigen = dense::symmetric_eigenpairs(hankel);
  std::vector<Eigen::Index> largest(static_cast<std::size_t>(half));
  std::iota(largest.begin(), largest.end(), 0);
  const auto size = [&](Eigen::Index k) { return std::abs(eigen.values[k]); };
  std::stable_sort(largest.begin(), largest.end(), [&](Eigen::Index a, Eigen::Index b) { return size(a) > size(b); });
  RadiationPoles best;
  best.error = std::sqrt(y.squaredNorm() / double(count));
  if (best.error <= tolerance) return best;
  const Eigen::Index most = std::min<Eigen::Index>(most_poles, half - 1);
  for (Eigen::Index order = 1; order <= most; ++order) {
    if (size(largest[std::size_t(order - 1)]) <= 1e-14 * size(largest[0])) break;
    // One sample later is one application of the system's matrix: U shifted by a row.
    Eigen::MatrixXd u(half, order);
    for (Eigen::Index k = 0; k < order; ++k) u.col(k) = eigen.vectors.col(largest[std::size_t(k)]);
    const Eigen::MatrixXd shift = dense::least_squares(u.topRows(half - 1), Eigen::MatrixXd(u.bottomRows(half - 1)));
    // U holds the observability matrix up to a change of base, which keeps the eigenvalues.
    const Eigen::VectorXcd roots = dense::eigenvalues(shift);
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
    const Eigen::VectorXd c = dense::least_squares(base.leftCols(columns), y);
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
