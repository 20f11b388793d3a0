// What the rotor does at the start, beside what its operating table says there and at rated power: a line of `spindrift check`
// that shows a wrong speed, pitch or wind before the run does. Tested in tests/coupled/program_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"

namespace spindrift::app {

/// Of rotors that bodies carry.
void print_rotors_at_start(coupling::FloatingSystem& floating, const coupling::Start& start);
/// Of one that stands in resolved air.
void print_rotor_at_start(const coupling::Scenario& scenario);

}  // namespace spindrift::app
