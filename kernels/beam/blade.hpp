// Bending modes of a twisted blade that is clamped at its root, and what a pull along the blade adds to their stiffness: cubic
// Hermite elements in both planes (Cook, Malkus, Plesha & Witt 2002, sections 2.3, 11.3, 18.3), tied by the twist of the
// principal axes. Used by src/aero/flexible_blades.cpp; tested in tests/kernels/beam/blade_test.cpp. Theory:
// docs/theory/structure.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kernels/base/interpolation.hpp"
#include "kernels/beam/euler_bernoulli.hpp"

namespace spindrift::beam {

/// What varies along a blade, straight lines between positions that increase. x is downwind, y ahead, at a pitch of zero.
struct BladeTable {
  std::vector<double> position;    ///< from the root along the blade's axis, beginning at 0 [m]
  std::vector<double> mass;        ///< [kg/m]
  std::vector<double> flap, edge;  ///< stiffness E I against bending square to the chord and along it [N m2]
  std::vector<double> twist;       ///< of the chord out of the rotor's plane, nose into the wind positive [rad]
};

/// The slowest modes of a blade at rest; generalised mass 1, stiffness omega^2.
class BladeModes {
 public:
  static constexpr int count = 3;  ///< of a usual blade first flapwise, first edgewise, second flapwise
  using Shape = Eigen::Matrix<double, 2, count>;
  using Square = Eigen::Matrix<double, count, count>;

  static constexpr int elements = 24;

  explicit BladeModes(const BladeTable& table);

  double length() const { return length_; }
  const std::array<double, count>& omega() const { return omega_; }  ///< rising [rad/s]

  /// Displacement of a section at this distance from the root by modes of amplitude 1, rows x and y, and its slope.
  Shape value(double at) const;
  Shape slope(double at) const;

 private:
  double length_;
  std::array<double, count> omega_{};
  std::vector<double> node_;  ///< distances from the root [m]
  Eigen::MatrixXd nodal_;     ///< deflections and slopes of the nodes in turn, of x and then of y; a column for each mode
};

/// A piece of a blade: what loads that go with its mass, and pulls along the blade, do to the modes.
struct BladePoint {
  double at, mass;                ///< distance from the root [m], [kg]
  BladeModes::Shape value;        ///< of the modes there
  BladeModes::Square shortening;  ///< the point comes inward by q^T shortening q / 2 [1/m]
};

/// Of a point at this distance from the root: integral of the products of the slopes from the root to it.
BladeModes::Square blade_shortening(const BladeModes& modes, double at);

/// Two points to an element, that keep its mass, first and second moment.
std::vector<BladePoint> blade_points(const BladeTable& table, const BladeModes& modes);

/// Stiffness that a pull along the blade adds, `per_mass(at)` [m/s2] outward on every piece of mass: the work of its shortening.
template <class PerMass>
BladeModes::Square tension_stiffness(const std::vector<BladePoint>& points, const PerMass& per_mass) {
  BladeModes::Square k = BladeModes::Square::Zero();
  for (const BladePoint& p : points) k += p.mass * per_mass(p.at) * p.shortening;
  return k;
}

}  // namespace spindrift::beam
