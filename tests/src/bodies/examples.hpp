// Small systems that several tests of the bodies module use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "src/bodies/loads.hpp"
#include "src/bodies/system.hpp"

namespace spindrift::bodies::examples {

using Eigen::Vector3d;

inline Body body(std::string name, double mass, const Vector3d& inertia, const Vector3d& position) {
  Body b;
  b.name = std::move(name);
  b.mass = mass;
  b.inertia = inertia.asDiagonal();
  b.initial.position = position;
  return b;
}

/// A slender uniform rod from a to b (its long axis is body x when attitude turns x into it); inertia across m L2 / 12, along
/// small.
inline Body rod(std::string name, double mass, const Vector3d& a, const Vector3d& b, double along = 1e-4) {
  const double length = (b - a).norm(), across = mass * length * length / 12.0;
  Body rod = body(std::move(name), mass, {along * across, across, across}, 0.5 * (a + b));
  rod.initial.attitude = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), b - a);
  return rod;
}

inline Joint joint(std::string name, JointType type, int i, int j, const Vector3d& point,
                   const Vector3d& axis = Vector3d::UnitX()) {
  Joint result;
  result.name = std::move(name);
  result.type = type;
  result.i = i;
  result.j = j;
  result.point = point;
  result.axis = axis;
  return result;
}

/// Steps to the end; the test fails with the system's own words when a step does.
inline void run(System& system, BodiesState& state, double step_s, long steps) {
  for (long n = 0; n < steps; ++n) {
    const StepReport report = system.advance(state, step_s, 1);
    if (!report.ok()) { FAIL("step " << n << ": " << system.describe(report)); }
  }
}

inline BodiesState start(System& system) {
  Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  return assembly.state;
}

}  // namespace spindrift::bodies::examples
