// Names of the modes of bodies that beams connect: linearise.hpp names a mode after the body that moves most, which calls a
// tower's bending "surge of nacelle". Used by src/coupling/start.cpp; tested in tests/src/bodies/beams_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "src/bodies/beams.hpp"
#include "src/bodies/linearise.hpp"

namespace spindrift::bodies {

/// Names the modes of a system with beams anew. Bodies on the ends of beams count to those that carry the beams, but for what
/// deforms a beam: "bending in x of tower" (its own axis), "torsion of tower".
/// @pre `linearisation` is of this system at this state, where its chart is open.
void name_modes(Linearisation& linearisation, System& system, const BodiesState& state, std::span<const Beam> beams);

/// Whether a mode of this name is a beam's extension or twist: far above what waves and passing blades drive.
bool stretches_or_twists(std::string_view mode);

}  // namespace spindrift::bodies
