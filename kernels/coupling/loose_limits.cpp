// SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "kernels/coupling/scheme.hpp"
#include "kernels/linear/dense.hpp"

namespace spindrift::coupling {

double largest_root(std::vector<double> c) {
  while (c.size() > 1 && c.back() == 0.0) c.pop_back();
  const auto n = Eigen::Index(c.size()) - 1;
  if (n <= 0) return 0.0;
  Matrix companion = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) companion(i + 1, i) = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) companion(i, n - 1) = -c[std::size_t(i)] / c[std::size_t(n)];
  return dense::eigenvalues(companion).cwiseAbs().maxCoeff();
}

double growth(const LooseLoop& loop, const Staggering& scheme, double window) {
  const Eigen::Index n = loop.matrix.rows(), m = loop.input.cols();
  const Matrix one = Matrix::Identity(m, m);
  // exp of the window with the load's powers of time beside x: its last columns are what y = 1, t, t^2 / 2 do to x.
  Matrix rates = Matrix::Zero(n + 3 * m, n + 3 * m);
  rates.topLeftCorner(n, n) = loop.matrix, rates.block(0, n, n, m) = loop.input;
  rates.block(n, n + m, m, m) = rates.block(n + m, n + 2 * m, m, m) = one;
  const Matrix over = dense::exponential(window * rates);
  const Matrix y0 = over.block(0, n, n, m), y1 = over.block(0, n + m, n, m) / window,
               y2 = 2.0 * over.block(0, n + 2 * m, n, m) / (window * window);  // by 1, t / window and its square

  // State: x, y at the motion before, the loads now and of two windows before; what the loads do by their polynomial in time.
  Matrix step = Matrix::Zero(n + 4 * m, n + 4 * m);
  std::array<Matrix, 3> by_load{y0, Matrix::Zero(n, m), Matrix::Zero(n, m)};
  if (scheme.load_order == 1) by_load = {y0 + y1, -y1, Matrix::Zero(n, m)};
  if (scheme.load_order == 2) by_load = {y0 + 1.5 * y1 + 0.5 * y2, -2.0 * y1 - y2, 0.5 * y1 + 0.5 * y2};
  step.topLeftCorner(n, n) = over.topLeftCorner(n, n);
  for (Eigen::Index k = 0; k < 3; ++k) step.block(0, n + (1 + k) * m, n, m) = by_load[std::size_t(k)];
  step.block(n, 0, m, n) = loop.output;
  if (scheme.serial)
    step.middleRows(n + m, m) = loop.output * step.topRows(n);
  else
    step.block(n + m, 0, m, n) = (scheme.extrapolates_motion() ? 2.0 : 1.0) * loop.output;
  if (scheme.extrapolates_motion()) step.block(n + m, n, m, m) = -one;
  step.block(n + 2 * m, n + m, m, m) = step.block(n + 3 * m, n + 2 * m, m, m) = one;
  return dense::eigenvalues(step).cwiseAbs().maxCoeff();
}

double window_limit(const LooseLoop& loop, const Staggering& scheme, double rate, double shortest, double longest) {
  const auto grows = [&](double window) { return !(growth(loop, scheme, window) <= std::exp(rate * window)); };
  constexpr double factor = 1.15;
  double below = 0.0;
  for (double window = shortest; window <= longest; below = window, window *= factor) {
    if (!grows(window)) continue;
    double high = window;
    for (int k = 0; k < 12; ++k) {
      const double middle = 0.5 * (below + high);
      (middle > 0.0 && grows(middle) ? high : below) = middle;
    }
    return below;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace spindrift::coupling
