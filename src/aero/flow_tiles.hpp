// Tiles of a flow's grid on this rank, with their distances to the walls: what stands between a grid and a solver on it. Used by
// src/run/flow_case.cpp and src/coupling/actuator_air.cpp; tested through them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// Spread over the ranks of `world`, by their cells where `rank_of_tile` is empty. `moves`: whether the grid will. Collective.
std::unique_ptr<GridStore> flow_tiles(const MultiBlockGrid& grid, Tiling tiling, const FlowOptions& options,
                                      const runtime::World& world, bool moves = false, std::vector<int> rank_of_tile = {});

}  // namespace spindrift::aero
