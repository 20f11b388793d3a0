// Grid sequencing: a steady march of a resolved rotor begins with the flow of a grid of half the resolution, where the wake and
// what it induces settle for an eighth of the cost a pseudo-step. Called by src/run/flow_simulation.cpp; tested in
// tests/src/aero/coarse_start_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/environment.hpp"
#include "src/aero/resolved_rotor.hpp"

namespace spindrift::aero {

/// The same rotor on a grid of half the resolution: numbers of cells halved, first cells twice as high.
ResolvedRotorSetup coarser(const ResolvedRotorSetup& setup);

/// The flow of `from` as the state of `to` (transfer.hpp), whose grid has the same blocks with other numbers of cells: hub to tip
/// and tip to outer radius each by its own share. Both may be spread over the ranks of `comm`. Collective.
void interpolate(const ResolvedRotor& from, ResolvedRotor& to, MPI_Comm comm = MPI_COMM_SELF);

/// Marches the coarser rotor `steps` pseudo-steps, its tiles spread over the ranks of `world`, and hands its flow to `fine`, with
/// the same bits on any number of them. The load is the coarse grid's.
RotorLoad start_from_coarser(const ResolvedRotorSetup& setup, int steps, ResolvedRotor& fine,
                             const runtime::World& world = {.comm = MPI_COMM_SELF, .rank = 0, .size = 1});

}  // namespace spindrift::aero
