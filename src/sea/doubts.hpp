// Doubts about waves, water and its resolution. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/scene/doubt.hpp"
#include "src/sea/options.hpp"

namespace spindrift::sea {

scene::Doubts wave_doubts(const WavesOptions& waves, const SeaEnvironment& environment);
/// `draft_m`: of the deepest body that floats, 0 where there is none.
scene::Doubts sea_doubts(const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& environment, double draft_m);

/// Length of a linear wave [m].
double wave_length(double period_s, const SeaEnvironment& environment);

}  // namespace spindrift::sea
