// A sea of particles that is one half of a whole (sea.tank.sides_y = "symmetric"): what a scene must be for that, and what holds
// its bodies in the plane: nothing of the water does. Used by scenario.cpp, floating_system.cpp and src/app/smaller_choices.cpp;
// tested in tests/coupled/symmetric_half_test.py and refused_scenes.py there. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/bodies/model.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// The mirror image in the plane y = `plane` [m].
inline Eigen::Vector3d image_across(double plane, Eigen::Vector3d x) {
  x.y() = 2.0 * plane - x.y();
  return x;
}

/// What is not symmetrical about the plane y = `plane` [m], one sentence each with its key: bodies with shapes and how they
/// start, drivers that turn them out of it, waves; and what halves cannot have.
std::vector<sea::OptionProblem> symmetry_problems(const Scenario& scenario, double plane);

/// A planar joint to the earth for each body with shapes, "symmetry_BODY": its reaction is what the whole sea and all other loads
/// would move the body out of the plane with. None where the sea is no half, or a joint to the earth keeps the body in the plane.
std::vector<bodies::Joint> joints_of_symmetry(const Scenario& scenario);

}  // namespace spindrift::coupling
