// The stiffness a line reports against central differences of its force: shared by the tests of all mooring models.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mooring/line.hpp"

namespace spindrift {

/// -d(on_fairlead)/d(fairlead) by central differences of fourth order, step [m].
template <MooringLine L>
Eigen::Matrix3d difference_stiffness(const L& line, const Eigen::Vector3d& span, double step) {
  Eigen::Matrix3d k;
  const auto pull = [&](int axis, double by) {
    return line.forces(span + by * Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero()).on_fairlead;
  };
  for (int axis = 0; axis < 3; ++axis)
    k.col(axis) = -(8 * (pull(axis, step) - pull(axis, -step)) - (pull(axis, 2 * step) - pull(axis, -2 * step))) / (12 * step);
  return k;
}

}  // namespace spindrift
