// Doubts about how a turbine is operated: its operating table, its controller's constants and events. Called by
// src/coupling/rotor_doubts.cpp; tested by the blunders of tests/extremes/blunders.toml and
// tests/src/aero/turbine_control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/scene/doubt.hpp"

namespace spindrift::aero {

struct ControlOptions;

/// Of files that can be read, for blades of this length [m].
scene::Doubts operation_doubts(const std::string& path, double radius);
scene::Doubts controller_doubts(const std::string& path, double radius);
/// Of the controller's events, and of the curve that it pitches the blades on, if any.
scene::Doubts control_doubts(const ControlOptions& control, const std::string& curve = "");

}  // namespace spindrift::aero
