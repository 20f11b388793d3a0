// Doubts that follow from the modes of the floating system: those that grow, those that a rotor meets, steps, windows and runs
// that do not fit them. Called by doubts.cpp; tested by the blunders of tests/extremes/blunders.toml.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// Modes that grow by themselves.
scene::Doubts growth_doubts(const FloatingSystem& floating, const Stability& stability);
/// Of one of by_rotor: the gains of its controller on what it stands on.
scene::Doubts tuning_doubts(const Scenario& scenario, const Stability& stability);
/// Beams that this rotor, of so many blades, swings.
scene::Doubts resonance_doubts(const FloatingSystem& floating, const aero::RotorLoads& rotor, int blades, const Start& start,
                               const Stability& stability);
/// The length of the run, of its steps and windows.
scene::Doubts step_doubts(const FloatingSystem& floating, const Stability& stability);

}  // namespace spindrift::coupling
