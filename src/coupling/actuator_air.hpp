// Actuator disc and lines as a side of a coupled window: the grid stands in the earth's frame and the rotor goes through it where
// the bodies take it, one physical step per window or sample. So the blades meet wake and inflow as the platform moves.
// Method: docs/theory/actuator.md. Made by make_air(); tested in tests/coupled/actuator_air_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/air_side.hpp"

namespace spindrift::coupling {

std::unique_ptr<AirSide> make_actuator_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world);

}  // namespace spindrift::coupling
