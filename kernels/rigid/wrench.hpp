// Force and moment on a rigid body: the load half of what the physics modules exchange.
// A wrench carries the point its moment is taken about, so that two of them cannot be added by mistake.
// Used by every module that loads a body; tested in tests/kernels/rigid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kernels/base/assert.hpp"

namespace spindrift {

/// Force [N] and moment [N m] about `point` [m], all in the earth frame.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();

  /// Adds a force acting at the earth position `at`.
  void add_force(const Eigen::Vector3d& f, const Eigen::Vector3d& at) {
    force += f;
    moment += (at - point).cross(f);
  }
  void add_moment(const Eigen::Vector3d& m) { moment += m; }

  /// The same load about another point.
  Wrench about(const Eigen::Vector3d& other) const { return {force, moment + (point - other).cross(force), other}; }

  Wrench& operator+=(const Wrench& w) {
    SPINDRIFT_ASSERT(w.point == point, "wrenches about different points are added");
    force += w.force;
    moment += w.moment;
    return *this;
  }
};

}  // namespace spindrift
