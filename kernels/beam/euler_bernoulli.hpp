// Bending modes of a straight Euler-Bernoulli beam in one plane by finite elements: cubic Hermite shapes, consistent mass, rigid
// bodies at its ends, geometric stiffness of an axial force. Elements: Cook, Malkus, Plesha & Witt (2002), Concepts and
// Applications of Finite Element Analysis, 4th ed., sections 2.3, 11.3 and 18.3. Used by modal_link.hpp and src/bodies/beams.cpp;
// tested in tests/kernels/beam. Theory: docs/theory/structure.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "kernels/base/interpolation.hpp"

namespace spindrift::beam {

/// What varies along a beam, straight lines between positions that do not decrease; two equal ones make a step.
struct Table {
  std::vector<double> position;   ///< from the start to the end [m]
  std::vector<double> mass;       ///< [kg/m]
  std::vector<double> stiffness;  ///< against bending, E I [N m2]

  double start() const { return position.front(); }
  double length() const { return position.back() - position.front(); }
};

/// A rigid body at an end of the beam, as its motion in the plane sees it.
struct EndBody {
  double mass = 0.0;          ///< [kg]
  double first_moment = 0.0;  ///< mass times the distance of its centre of mass from the end, along the beam's direction [kg m]
  double inertia = 0.0;       ///< about the end [kg m2]
};

struct Problem {
  EndBody tip;
  std::optional<EndBody> base;  ///< absent: the start is clamped; else it is free and carries this body
  double tension = 0.0;         ///< in the beam at its end [N]
  double weight = 0.0;          ///< acceleration [m/s2] by which the beam's own mass presses on what is below; 0: not counted
  int elements = 24;
};

/// Deflections and slopes of the nodes in turn, 2 (elements + 1) rows. Shapes have generalised mass 1, stiffness omega^2.
struct Modes {
  std::vector<double> node;   ///< positions from the start [m]
  std::vector<double> omega;  ///< rising [rad/s]; 0 for motions of the whole
  Eigen::MatrixXd shapes;     ///< a column for each
};

namespace detail {

inline constexpr std::array<double, 4> gauss_point{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                                   0.8611363115940526};
inline constexpr std::array<double, 4> gauss_weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                                    0.3478548451374538};

/// Integrates over [from, to] (distances from the start) what is smooth between the table's positions: f(distance, weight).
template <class F>
void integrate(const Table& table, double from, double to, F&& f) {
  double left = from;
  const auto piece = [&](double right) {
    const double half = 0.5 * (right - left), middle = 0.5 * (right + left);
    if (half > 0.0)
      for (std::size_t g = 0; g < gauss_point.size(); ++g) f(middle + half * gauss_point[g], half * gauss_weight[g]);
    left = std::max(left, right);
  };
  for (const double position : table.position)
    if (const double at = position - table.start(); at > left && at < to) piece(at);
  piece(to);
}

/// Hermite shapes of an element of length h at x = 0..1: values, first and second derivatives along the beam.
struct Hermite {
  Eigen::Vector4d value, slope, curvature;
  Hermite(double x, double h)
      : value(1 - x * x * (3 - 2 * x), h * x * (1 - x) * (1 - x), x * x * (3 - 2 * x), -h * x * x * (1 - x)),
        slope(-6 * x * (1 - x) / h, (1 - x) * (1 - 3 * x), 6 * x * (1 - x) / h, x * (3 * x - 2)),
        curvature((12 * x - 6) / (h * h), (6 * x - 4) / h, (6 - 12 * x) / (h * h), (6 * x - 2) / h) {}
};

inline void add_end(Eigen::MatrixXd& mass, Eigen::Index first, const EndBody& body) {
  Eigen::Matrix2d m;
  m << body.mass, body.first_moment, body.first_moment, body.inertia;
  mass.block<2, 2>(first, first) += m;
}

}  // namespace detail

/// Mass and stiffness over all nodes, both ends free, end bodies not included.
struct Matrices {
  Eigen::MatrixXd mass, stiffness, geometric;  ///< geometric: of the axial force, to be added to the stiffness
};

inline Matrices matrices(const Table& table, const Problem& problem) {
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

/// The first `count` modes, the slowest first.
inline Modes modes(const Table& table, const Problem& problem, int count) {
  const Matrices m = matrices(table, problem);
  const Eigen::Index size = m.mass.rows(), held = problem.base ? 0 : 2, free = size - held;
  Eigen::MatrixXd mass = m.mass, stiffness = m.stiffness + m.geometric;
  detail::add_end(mass, size - 2, problem.tip);
  if (problem.base) detail::add_end(mass, 0, *problem.base);
  // Slopes in units of 1/h, so that the entries of the matrices compare.
  const double h = table.length() / problem.elements;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(size);
  for (Eigen::Index k = 1; k < size; k += 2) unit[k] = 1.0 / h;
  const Eigen::MatrixXd scaled_mass = unit.asDiagonal() * mass * unit.asDiagonal(),
                        scaled_stiffness = unit.asDiagonal() * stiffness * unit.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled_stiffness.bottomRightCorner(free, free),
                                                                        scaled_mass.bottomRightCorner(free, free));
  Modes result;
  for (int k = 0; k <= problem.elements; ++k) result.node.push_back(k * h);
  result.shapes.setZero(size, count);
  for (int k = 0; k < count; ++k) {
    result.omega.push_back(std::sqrt(std::max(0.0, eigen.eigenvalues()[k])));
    result.shapes.col(k).tail(free) = unit.tail(free).cwiseProduct(eigen.eigenvectors().col(k));
    if (result.shapes(size - 2, k) < 0.0) result.shapes.col(k) *= -1.0;
  }
  return result;
}

/// Deflection of a shape given by its nodes, at a distance from the start.
inline double deflection(std::span<const double> node, const Eigen::VectorXd& shape, double at) {
  const std::size_t e = interval(node, at);
  const double h = node[e + 1] - node[e];
  return detail::Hermite((at - node[e]) / h, h).value.dot(shape.segment<4>(Eigen::Index(2 * e)));
}
inline double slope(std::span<const double> node, const Eigen::VectorXd& shape, double at) {
  const std::size_t e = interval(node, at);
  const double h = node[e + 1] - node[e];
  return detail::Hermite((at - node[e]) / h, h).slope.dot(shape.segment<4>(Eigen::Index(2 * e)));
}

}  // namespace spindrift::beam
