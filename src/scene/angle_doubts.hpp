// Angles of a scene that look as if they were given in radians where the key says degrees. Called by src/app and
// src/aero/turbine_doubts.cpp; tested in tests/src/scene/angle_doubts_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/scene/doubt.hpp"

namespace spindrift::scene {

/// Three or more digits that are, as radians, a round number of degrees: 0.0873 (5), 0.2618 (15), 1.5708 (90).
bool looks_like_radians(double degrees);
Doubt doubt_of_angle(const std::string& key, double degrees);

/// Of every key in degrees of a scene (Document::echo), phases of waves and lists longer than a vector excepted.
Doubts angle_doubts(const std::string& echo);

}  // namespace spindrift::scene
