// What makes two mooring-line models interchangeable: the vector between their ends in, the forces on both ends out.
// Used by src/moorings/moorings.cpp; each model is tested in tests/kernels/mooring.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <string_view>

namespace spindrift {

/// What a line does to the two things it ties together; earth axes, z up.
struct LineForces {
  Eigen::Vector3d on_fairlead = Eigen::Vector3d::Zero();  ///< [N]
  Eigen::Vector3d on_anchor = Eigen::Vector3d::Zero();  ///< [N]; differs from -on_fairlead by the weight and bed load of the line
  double fairlead_tension = 0.0;                        ///< [N], negative where a spring pushes
  double anchor_tension = 0.0;                          ///< [N]
};

/// A massless line between anchor and fairlead. `span` = fairlead - anchor [m], `rate` = its time derivative [m/s].
/// stiffness(span) = -d(on_fairlead)/d(fairlead) [N/m] at rest, for linearisation; singular limits are said where they occur.
template <class L>
concept MooringLine = requires(const L line, const Eigen::Vector3d& span, const Eigen::Vector3d& rate) {
  { line.forces(span, rate) } -> std::same_as<LineForces>;
  { line.stiffness(span) } -> std::same_as<Eigen::Matrix3d>;
  { L::name } -> std::convertible_to<std::string_view>;
};

/// Stiffness of a force of magnitude `tension` along the straight line between the ends: axial slope dT/dl and the geometric part
/// T/l.
inline Eigen::Matrix3d chord_stiffness(const Eigen::Vector3d& span, double tension, double axial_slope) {
  const double length = span.norm();
  const Eigen::Vector3d n = span / length;
  return axial_slope * n * n.transpose() + tension / length * (Eigen::Matrix3d::Identity() - n * n.transpose());
}

/// Equal and opposite forces along the straight line between the ends. At zero length there is no direction and no force.
inline LineForces chord_forces(const Eigen::Vector3d& span, double tension) {
  const double length = span.norm();
  if (length == 0.0) return {.fairlead_tension = tension, .anchor_tension = tension};
  const Eigen::Vector3d pull = -tension / length * span;
  return {pull, -pull, tension, tension};
}

}  // namespace spindrift
