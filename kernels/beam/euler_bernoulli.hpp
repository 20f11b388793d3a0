// Bending modes of a straight Euler-Bernoulli beam in one plane by finite elements: cubic Hermite shapes, consistent mass, rigid
// bodies at its ends, geometric stiffness of an axial force. Elements: Cook, Malkus, Plesha & Witt (2002), Concepts and
// Applications of Finite Element Analysis, 4th ed., sections 2.3, 11.3 and 18.3. Used by modal_link.hpp and src/bodies/beams.cpp;
// tested in tests/kernels/beam. Theory: docs/theory/structure.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
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

}  // namespace detail

/// Mass and stiffness over all nodes, both ends free, end bodies not included.
struct Matrices {
  Eigen::MatrixXd mass, stiffness, geometric;  ///< geometric: of the axial force, to be added to the stiffness
};

Matrices matrices(const Table& table, const Problem& problem);

/// The first `count` modes, the slowest first.
Modes modes(const Table& table, const Problem& problem, int count);

/// Deflection of a shape given by its nodes, at a distance from the start.
double deflection(std::span<const double> node, const Eigen::VectorXd& shape, double at);
double slope(std::span<const double> node, const Eigen::VectorXd& shape, double at);

}  // namespace spindrift::beam
