// Doubts about mooring lines. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/moorings/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::moorings {

/// `depth_m`: of the water, negative where the scene has no sea. `weight_N`: of all bodies together.
scene::Doubts line_doubts(const std::vector<scene::Named<LineOptions>>& lines, double depth_m, double weight_N);

}  // namespace spindrift::moorings
