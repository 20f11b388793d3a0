// What the options of a sea of particles come to, for particle_plan.cpp and particle_problems.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/sea/particle_sea.hpp"

namespace spindrift::sea {

/// Walls, bed and boxes of the tank, at rest.
sph::TankPlan tank_of(const SeaOptions& options, const SeaEnvironment& environment);

/// Depth that sets the speed of sound: of the deepest water of the scene [m].
double deepest_water(const SeaOptions& options, double water_depth);

}  // namespace spindrift::sea
