// What among the loads of a floating system sets in at once: lines that snap taut. The bodies' steps follow them (bodies::Onset).
// Called by start.cpp; what no step can follow is refused by limits.cpp; tested in tests/src/coupling/limits_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/bodies/model.hpp"
#include "src/bodies/state.hpp"
#include "src/coupling/floating_system.hpp"

namespace spindrift::coupling {

/// One for each line that may snap taut, in the order of the scene: the rate from the mobility of its ends in this state, joints
/// and added mass included, along the line as it is and along the axes. The system must outlive them.
std::vector<bodies::Onset> line_onsets(FloatingSystem& floating, const bodies::BodiesState& state);

}  // namespace spindrift::coupling
