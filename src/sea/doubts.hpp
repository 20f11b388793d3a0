// Doubts about waves, water and its resolution. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/scene/doubt.hpp"
#include "src/sea/options.hpp"

namespace spindrift::sea {

scene::Doubts wave_doubts(const WavesOptions& waves, const SeaEnvironment& environment);
/// `draft_m`: of the deepest body that floats, 0 where there is none.
/// What the bodies are to the sea: their draft [m], 0 where none floats, and the speed at which they meet it [m/s].
struct BodiesInSea {
  double draft = 0.0, entry_speed = 0.0;
};
scene::Doubts sea_doubts(const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& environment,
                         const BodiesInSea& bodies);

/// Length of a linear wave [m].
double wave_length(double period_s, const SeaEnvironment& environment);

}  // namespace spindrift::sea
