// What `check` says of resolved air: grids, patches, first cells, far sides, cost. Called by check.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "runtime/mpi/environment.hpp"
#include "src/app/commands.hpp"
#include "src/app/cost.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::app {

/// Whether the grid of a resolved rotor on bodies can be made and shared out; of no other scene.
void require_grid(const coupling::FloatingSystem& floating, const coupling::Start& start, int ranks);
/// Of the air round bodies, its cost; absent where patches lack a condition.
std::optional<PartCost> print_air(const coupling::FloatingSystem& floating, const coupling::Start& start, bool calibrate,
                                  int ranks);
/// All that is said of a scene of air alone; begun at `begin_s` of processor time. bad_input where patches lack a condition.
ExitCode check_air_alone(const coupling::Scenario& scenario, const scene::Doubts& angles, bool calibrate,
                         const runtime::World& world, double begin_s);

}  // namespace spindrift::app
