// Doubts about a scene as a whole: those of its modules, and those that only the floating system can tell (weight against
// buoyancy, accelerations at the start, modes that grow, statics far from the start, step and window against what moves). Printed
// by `spindrift check` and logged as warnings by `spindrift run`; tested by tests/coupled/blunders_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// `start` and `stability`: as make_start and stability gave them. Changes nothing in the floating system but its scratch.
scene::Doubts doubts(FloatingSystem& floating, const Start& start, const Stability& stability);
/// Those that need no start: of a floating system whose start cannot be found.
scene::Doubts doubts_as_described(const FloatingSystem& floating);
/// What the particles are too coarse for, though the scene may mean it: waves and drafts by few particles.
std::vector<std::string> resolution_notes(const FloatingSystem& floating);
/// Of a scene of the air alone.
scene::Doubts air_doubts(const Scenario& scenario);

}  // namespace spindrift::coupling
