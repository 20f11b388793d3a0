// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow_tiles.hpp"

#include <string>
#include <utility>
#include <vector>

#include "runtime/mpi/stop_request.hpp"
#include "src/aero/flow/poisson.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/tile_balance.hpp"

namespace spindrift::aero {

std::unique_ptr<GridStore> flow_tiles(const MultiBlockGrid& grid, Tiling tiling, const FlowOptions& o,
                                      const runtime::World& world, bool moves, std::vector<int> rank_of_tile) {
  if (rank_of_tile.empty()) rank_of_tile = ranks_by_cells(tiling, world.size);
  auto store = std::make_unique<GridStore>(std::move(tiling), std::move(rank_of_tile), world.rank);
  runtime::give_up_together(world.comm, [&] { store->build_all(grid, moves); });
  std::vector<std::string> no_slip;
  for (const PatchOptions& b : o.boundaries)
    if (sticks(b.condition)) no_slip.push_back(b.patch);
  if (o.wall_distance == "poisson") {
    fill_wall_distance_by_poisson(*store, no_slip, world.comm);
  } else {
    runtime::give_up_together(world.comm, [&] { fill_wall_distance(*store, wall_surface(grid, no_slip)); });
  }
  return store;
}

}  // namespace spindrift::aero
