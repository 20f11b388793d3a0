// Limits on steps and windows that the linearised floating system of start.hpp does not have: lines that snap taut, and loose
// coupling of rotor and bodies. Scenes beyond them are refused, by `check` and by `run` alike.
// Tested in tests/src/coupling/limits_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/bodies/linearise.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// Throws scene::SceneError where a line without weight, when it snaps taut, needs more pieces of the scene's step than are made
/// (bodies::System::watch); one that sags is named when it does. @pre the start has been made.
void require_followed_lines(FloatingSystem& floating);

/// Throws scene::SceneError where the scheme is loose and the window beyond its limit, or the blades' air too heavy for any,
/// unless coupling.accept_unstable: then what is accepted.
scene::Doubts require_stable_coupling(FloatingSystem& floating, const bodies::BodiesState& state,
                                      const bodies::Linearisation& linearisation);

/// Throws scene::SceneError where the blades that bend are faster than the bodies' step can follow, heavier than their body, or
/// sink too far under their own weight. Called before a start is sought, which such blades may not have.
void require_bending_blades(const FloatingSystem& floating);

/// All limits of a start: of what is linearised there (start.hpp), of lines and of the coupling. What `check` and `run` refuse,
/// and what is accepted beyond them.
scene::Doubts require_limits(FloatingSystem& floating, const bodies::BodiesState& state, const Stability& stability);

}  // namespace spindrift::coupling
