// SPDX-License-Identifier: Apache-2.0
#include "kernels/beam/euler_bernoulli.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linear/dense.hpp"

namespace spindrift::beam {

namespace {

void add_end(Eigen::MatrixXd& mass, Eigen::Index first, const EndBody& body) {
  Eigen::Matrix2d m;
  m << body.mass, body.first_moment, body.first_moment, body.inertia;
  mass.block<2, 2>(first, first) += m;
}

}  // namespace

Matrices matrices(const Table& table, const Problem& problem) {
  const int n = problem.elements;
  const double h = table.length() / n;
  const Eigen::Index size = 2 * (n + 1);
  Matrices m{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
  double beyond = 0.0;  // mass of the elements nearer to the end [kg]
  for (int e = n - 1; e >= 0; --e) {
    double own = 0.0;
    detail::integrate(table, e * h, (e + 1) * h, [&](double at, double weight) {
      own += weight * interpolate_linear(table.position, table.mass, table.start() + at);
    });
    detail::integrate(table, e * h, (e + 1) * h, [&](double at, double weight) {
      const double x = at / h - e;
      const detail::Hermite shape(x, h);
      const double mass = interpolate_linear(table.position, table.mass, table.start() + at);
      const double stiffness = interpolate_linear(table.position, table.stiffness, table.start() + at);
      const double tension = problem.tension - problem.weight * (beyond + (1.0 - x) * own);
      m.mass.block<4, 4>(2 * e, 2 * e) += weight * mass * shape.value * shape.value.transpose();
      m.stiffness.block<4, 4>(2 * e, 2 * e) += weight * stiffness * shape.curvature * shape.curvature.transpose();
      m.geometric.block<4, 4>(2 * e, 2 * e) += weight * tension * shape.slope * shape.slope.transpose();
    });
    beyond += own;
  }
  return m;
}

Modes modes(const Table& table, const Problem& problem, int count) {
  const Matrices m = matrices(table, problem);
  const Eigen::Index size = m.mass.rows(), held = problem.base ? 0 : 2, free = size - held;
  Eigen::MatrixXd mass = m.mass, stiffness = m.stiffness + m.geometric;
  add_end(mass, size - 2, problem.tip);
  if (problem.base) add_end(mass, 0, *problem.base);
  // Slopes in units of 1/h, so that the entries of the matrices compare.
  const double h = table.length() / problem.elements;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(size);
  for (Eigen::Index k = 1; k < size; k += 2) unit[k] = 1.0 / h;
  const Eigen::MatrixXd scaled_mass = unit.asDiagonal() * mass * unit.asDiagonal(),
                        scaled_stiffness = unit.asDiagonal() * stiffness * unit.asDiagonal();
  const dense::SymmetricEigenpairs eigen =
      dense::symmetric_eigenpairs(scaled_stiffness.bottomRightCorner(free, free), scaled_mass.bottomRightCorner(free, free));
  Modes result;
  for (int k = 0; k <= problem.elements; ++k) result.node.push_back(k * h);
  result.shapes.setZero(size, count);
  for (int k = 0; k < count; ++k) {
    result.omega.push_back(std::sqrt(std::max(0.0, eigen.values[k])));
    result.shapes.col(k).tail(free) = unit.tail(free).cwiseProduct(eigen.vectors.col(k));
    if (result.shapes(size - 2, k) < 0.0) result.shapes.col(k) *= -1.0;
  }
  return result;
}

double deflection(std::span<const double> node, const Eigen::VectorXd& shape, double at) {
  const std::size_t e = interval(node, at);
  const double h = node[e + 1] - node[e];
  return detail::Hermite((at - node[e]) / h, h).value.dot(shape.segment<4>(Eigen::Index(2 * e)));
}
double slope(std::span<const double> node, const Eigen::VectorXd& shape, double at) {
  const std::size_t e = interval(node, at);
  const double h = node[e + 1] - node[e];
  return detail::Hermite((at - node[e]) / h, h).slope.dot(shape.segment<4>(Eigen::Index(2 * e)));
}

}  // namespace spindrift::beam
