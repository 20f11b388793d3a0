// Doubts about times: windows, steps and rows against the waves, tables and events against the run, what is written and how
// often. Called by doubts.cpp; tested by the blunders of tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/floating_system.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

scene::Doubts time_doubts(const FloatingSystem& floating);

}  // namespace spindrift::coupling
