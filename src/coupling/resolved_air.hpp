// Resolved air as a side of a coupled window: a blade-resolved rotor whose hub goes where the bodies take it, one physical step
// per window or sample. A grid of one sector keeps its periodicity only along and about its axis: such a rotor follows the
// hub's motion along the axis of the start; its thrust and torque turn with the axis as it tilts. Made by make_air(); tested in
// tests/coupled/resolved_air_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/air_side.hpp"

namespace spindrift::coupling {

std::unique_ptr<AirSide> make_resolved_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world);

}  // namespace spindrift::coupling
