// A mooring line as a table of tension against the distance between its ends, e.g. from a static analysis or a test of a fibre
// rope. Practice: precomputed nonlinear force-displacement relations, Karimirad & Moan (2012), Marine Structures 25. Called
// through src/moorings; tested in tests/kernels/mooring/line_table_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernels/base/interpolation.hpp"
#include "kernels/mooring/line.hpp"

namespace spindrift {

/// Views of a checked table: distances strictly increasing, tensions not decreasing (so that the line never releases energy by
/// stretching), slopes by monotone_slopes. Below the table the first tension holds (a slack line stays slack); beyond it the last
/// slope of `slope` continues.
struct LineTable {
  static constexpr std::string_view name = "table";
  std::span<const double> distance;  ///< [m]
  std::span<const double> tension;   ///< [N]
  std::span<const double> slope;     ///< dT/dl at the nodes [N/m]

  ValueAndSlope at(double length) const {
    if (length < distance.front()) return {tension.front(), 0.0};
    if (length > distance.back()) return {tension.back() + slope.back() * (length - distance.back()), slope.back()};
    return interpolate_hermite(distance, tension, slope, length);
  }

  LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& /*rate: a table has no damping*/) const {
    return chord_forces(span, at(span.norm()).value);
  }

  Eigen::Matrix3d stiffness(const Eigen::Vector3d& span) const {
    const auto [force, rate] = at(span.norm());
    return chord_stiffness(span, force, rate);
  }
};
static_assert(MooringLine<LineTable>);

}  // namespace spindrift
