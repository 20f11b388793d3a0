// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/tile_arrays.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/mass_balance.hpp"
#include "src/aero/flow/sweep.hpp"
#include "src/aero/flow/sweep_gradients.hpp"

namespace spindrift::aero {

std::size_t FlowTile::bytes() const {
  std::size_t sum = state.bytes() + trial.bytes() + source.bytes() + driving.bytes() + gradients.bytes() + residual.bytes() +
                    rate.bytes() + mean_matrix.bytes() + turbulence_matrix.bytes() + direction.bytes();
  for (const auto& v : past) sum += v.bytes();
  for (const auto& v : vectors) sum += v.bytes();
  for (const auto& v : directions_kept) sum += v.bytes();
  for (const SideFaces& side : sides) sum += side.open.bytes() + side.law.bytes() + side.through.bytes();
  return sum;
}

TileArrays::TileArrays(GridStore& store, const FlowSetting& setting, std::span<const PatchCondition> conditions,
                       const ModelSweeps& model)
    : grid(store) {
  const Tiling& tiling = grid.tiling();
  if (model.closures != nullptr && tiling.planar && closures().named(setting.turbulence).resolves_eddies)
    throw std::invalid_argument("flow: " + setting.turbulence + " resolves eddies: the grid must have three dimensions");
  local.assign(std::size_t(tiling.size()), -1);
  for (const int index : grid.owned()) {
    local[std::size_t(index)] = int(tiles.size());
    const Tile& from = tiling.tiles[std::size_t(index)];
    if (from.ni > longest_row)
      throw std::invalid_argument("flow: a tile has rows of " + std::to_string(from.ni) + " cells; the sweeps hold " +
                                  std::to_string(longest_row));
    FlowTile& t = tiles.emplace_back();
    t.geometry = &grid[index];
    t.index = index;
    if (!setting.frame_omega.isZero()) turn_frame(*t.geometry, setting.frame_omega, setting.frame_centre, tiling.planar);
    if (setting.time_order > 2 && t.geometry->history) keep_third_step(*t.geometry);
    t.directions = tiling.planar ? 2 : 3;
    t.along_wall = from.along_wall, t.ends_along_wall = from.ends_along_wall;
    t.turbulence = model.equations;
    t.eddies = model.closures != nullptr;
    t.cells = cell_layout(from, state_ghosts, tiling.planar);
    t.gradient_box = cell_layout(from, gradient_ghosts, tiling.planar);
    t.inner = BoxLayout(from.ni, from.nj, from.nk);
    t.box = {from.ni, from.nj, from.nk};
    for (const TileBoundary& where : tiling.boundary(index)) {
      if (std::size_t(where.patch) >= conditions.size()) throw std::invalid_argument("flow: a patch has no condition");
      const PatchCondition& c = conditions[std::size_t(where.patch)];
      const BoundaryCondition& condition = aero::of(c.condition);
      if (condition.wall_law && model.equations == 0)
        throw std::invalid_argument("flow: the law of the wall goes with models that transport turbulence");
      if (c.temperature && std::ranges::find(condition.keys, "temperature_K") == condition.keys.end())
        throw std::invalid_argument("flow: only walls resolved to the wall can be held at a temperature");
      if (condition.wall_law) t.wall_law = &model.wall_law();
      t.boundaries.push_back({where, &condition, c.loads, c.temperature});
    }
    const int unknowns = t.unknowns();
    t.state = AlignedArray<double>(t.cells.size(unknowns));
    t.trial = AlignedArray<double>(t.cells.size(unknowns));
    t.gradients = AlignedArray<double>(t.gradient_box.size(gradient_components(t.turbulence, t.eddies)));
    t.residual = AlignedArray<double>(t.inner.size(unknowns));
    t.rate = AlignedArray<double>(t.inner.size(1));
    for (int n = 0; n < setting.past_levels(); ++n) t.past[std::size_t(n)] = AlignedArray<double>(t.inner.size(unknowns));
    t.mean_matrix = AlignedArray<float>(MeanMatrix::size(t.box, t.directions));
    if (t.turbulence == 1) t.turbulence_matrix = AlignedArray<float>(linear::StencilMatrix<1>::size(t.box, t.directions));
    if (t.turbulence == 2) t.turbulence_matrix = AlignedArray<float>(linear::StencilMatrix<2>::size(t.box, t.directions));
    t.direction = AlignedArray<float>(t.gradient_box.size(unknowns));
    set_open_faces(t);
    set_through_faces(t);
  }
}

long TileArrays::cells() const {
  long sum = 0;
  for (const Tile& tile : grid.tiling().tiles) sum += tile.count();
  return sum;
}

std::size_t TileArrays::bytes() const {
  std::size_t sum = 0;
  for (const FlowTile& tile : tiles) sum += tile.bytes();
  return sum;
}

}  // namespace spindrift::aero
