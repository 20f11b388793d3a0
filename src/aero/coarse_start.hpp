// Grid sequencing: a steady march of a resolved rotor begins with the flow of a grid of half the resolution, where the wake and
// what it induces settle for an eighth of the cost a pseudo-step. Called by src/run/flow_simulation.cpp; tested in
// tests/src/aero/coarse_start_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/resolved_rotor.hpp"

namespace spindrift::aero {

/// The same rotor on a grid of half the resolution: numbers of cells halved, first cells twice as high.
ResolvedRotorSetup coarser(const ResolvedRotorSetup& setup);

/// The flow of `from` as the state of `to` (transfer.hpp), whose grid has the same blocks with other numbers of cells: hub to tip
/// and tip to outer radius each by its own share. `from` must be whole on this process, `to` may be a part.
void interpolate(const ResolvedRotor& from, ResolvedRotor& to);

/// Marches the coarser rotor `steps` pseudo-steps and hands its flow to `fine`. Every rank makes the same coarse flow for itself:
/// no message, and the same bits on any number of them. The load is the coarse grid's.
RotorLoad start_from_coarser(const ResolvedRotorSetup& setup, int steps, ResolvedRotor& fine);

}  // namespace spindrift::aero
