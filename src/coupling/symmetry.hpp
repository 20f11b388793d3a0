// A sea of particles that is one half of a whole (sea.tank.sides_y = "symmetric") or of two dimensions: what a scene must be for
// that, and what holds its bodies in the plane: nothing of the water does. Used by scenario.cpp, floating_system.cpp and
// src/app/smaller_choices.cpp; tested in tests/coupled/symmetric_half_test.py, planar_sea_test.py and refused_scenes.py there.
// SPDX-License-Identifier: Apache-2.0
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

/// What leaves the plane of a sea of two dimensions, one sentence each with its key: bodies with shapes as they start, and
/// drivers.
std::vector<sea::OptionProblem> out_of_plane_problems(const Scenario& scenario);

/// A planar joint to the earth for each body with shapes, "symmetry_BODY" beside a plane of symmetry and "plane_BODY" in a sea of
/// two dimensions: its reaction is what the whole sea and all other loads would move the body out of the plane with. None in
/// other seas, nor where a joint to the earth keeps the body in the plane.
std::vector<bodies::Joint> joints_in_plane(const Scenario& scenario);

}  // namespace spindrift::coupling
