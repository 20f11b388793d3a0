// Doubts about bodies in the water: weight against buoyancy, place against bed and surface, loads at the start, where the system
// rests, matrices and damping against the size of the floats, units of surfaces of triangles. Called by doubts.cpp; tested by the
// blunders of tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// Of all bodies and beams [N].
double weight(const FloatingSystem& floating);
/// Units of surfaces of triangles, which a file does not tell: what they displace against the body's mass.
void doubt_meshes(scene::Doubts& doubts, const Scenario& scenario);
/// Draft of the deepest body that the water carries; doubts about bodies below the bed and about weights that the water cannot
/// carry at all, or that hardly press it aside.
double doubt_floating(scene::Doubts& doubts, const FloatingSystem& floating, std::span<const Motion> motions);
/// Damping, matrices and potential flow, against the body that they belong to.
void doubt_linear_loads(scene::Doubts& doubts, const FloatingSystem& floating);
/// Loads that nothing in the scene balances throw a body off at once.
scene::Doubts acceleration_doubts(FloatingSystem& floating, const Start& start);
/// A start that an equilibrium takes the place of: the run would not be the decay test that the scene describes.
scene::Doubts displaced_equilibrium_doubts(const FloatingSystem& floating, const Start& start);
/// Where the floating system would come to rest, or starts at rest, against where it is described.
scene::Doubts statics_doubts(FloatingSystem& floating, const Start& start);

}  // namespace spindrift::coupling
