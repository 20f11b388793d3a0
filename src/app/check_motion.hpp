// What `check` says of how a floating system rests and moves: static equilibrium, modes and steps, frequencies, loose coupling.
// Called by check.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/coupling/floating_system.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/start.hpp"

namespace spindrift::app {

/// Of a source of load "rotor.a": "rotor a".
std::string spoken(std::string name);
/// Where it is under the mean loads; none where the water is not level or no rest was found, which is told.
void print_statics(coupling::FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability);
/// Of bodies, lines and blades, and the largest step that is stable.
void print_modes(coupling::FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability);
/// Rotors against waves and platform, and which loose schemes will do. @pre there is a rotor
void print_frequencies_and_coupling(coupling::FloatingSystem& floating, const coupling::Start& start,
                                    const coupling::Stability& stability);

}  // namespace spindrift::app
