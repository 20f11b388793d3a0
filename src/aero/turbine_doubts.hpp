// Doubts about the blades of a turbine file: units and signs of its planform, its polars and its cone. Called by
// src/coupling/doubts.cpp; tested by the blunders of
// tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/scene/doubt.hpp"

namespace spindrift::aero {

/// Of a turbine file that can be read.
scene::Doubts turbine_doubts(const std::string& path);

}  // namespace spindrift::aero
