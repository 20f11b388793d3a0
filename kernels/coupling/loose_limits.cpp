// SPDX-License-Identifier: Apache-2.0
#include "kernels/coupling/loose_limits.hpp"

#include <Eigen/Eigenvalues>
#include <complex>

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

double largest_root(std::vector<double> c) {
  while (c.size() > 1 && c.back() == 0.0) c.pop_back();
  const auto n = Eigen::Index(c.size()) - 1;
  if (n <= 0) return 0.0;
  Matrix companion = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) companion(i + 1, i) = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) companion(i, n - 1) = -c[std::size_t(i)] / c[std::size_t(n)];
  return Eigen::EigenSolver<Matrix>(companion, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace spindrift::coupling
