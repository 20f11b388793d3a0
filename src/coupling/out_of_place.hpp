// Bodies, rotors and blades that have come to where no model of the scene holds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kernels/base/failure.hpp"
#include "src/coupling/floating_system.hpp"

namespace spindrift::coupling {

/// What is out of place at the state's time: a blade that bends by more than a third of its length. Beside a sea without
/// particles also a body in the bed, which carries nothing, by more than a tenth of its size, and a rotor in the water, whose
/// blades know air alone. Tested in tests/src/coupling/out_of_place_test.cpp.
std::optional<NumericalFailure> out_of_place(const FloatingSystem& floating, const bodies::BodiesState& state);

/// Whether water fills the sea to z = 0 from side to side, where statics have it. Boxes of particles may not.
bool has_level_water(const Scenario& scenario);

/// Throws scene::SceneError where a body in a sea of particles reaches more than a spacing into another one, or into bed, walls
/// or obstacles: contact would throw it off. Bodies that a joint or a beam ties to what they reach into may, as a pile or a flap
/// does.
void require_room(const FloatingSystem& floating, const bodies::BodiesState& start);

}  // namespace spindrift::coupling
