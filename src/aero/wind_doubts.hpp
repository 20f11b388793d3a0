// Doubts about the wind: its speed, its profile, events and tables, turbulence. Called by doubts.cpp; tested by the blunders of
// tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/wind_options.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::aero {

/// `radius` of the rotor that meets it [m], 0 where the scene does not say.
scene::Doubts wind_doubts(const WindOptions& wind, double radius, bool over_water);

}  // namespace spindrift::aero
