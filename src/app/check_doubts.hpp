// Doubts as `check` prints them. Called by check.cpp and check_air.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::app {

void print_doubts(scene::Doubts doubts, const scene::Doubts& more);
/// A start that cannot be found is refused; what looks like the slip behind it is told first, where `prints`.
coupling::Start start_or_doubts(coupling::FloatingSystem& floating, const scene::Doubts& angles, bool prints);

}  // namespace spindrift::app
