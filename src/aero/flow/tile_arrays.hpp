// The tiles of this rank with all that the solver keeps of them, and loops over their cells. Owned by FlowSolver, shared by its
// parts; tested through tests/src/aero/flow. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

#include "kernels/gas/state.hpp"
#include "src/aero/flow/flow_setting.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

struct TileArrays {
  /// Arrays as the setting needs them, conditions by patch of the tiling. Throws std::invalid_argument where they do not go
  /// together. The grid must outlive this and have been built.
  TileArrays(GridStore& grid, const FlowSetting& setting, std::span<const PatchCondition> conditions, const ModelSweeps& model);
  TileArrays(const TileArrays&) = delete;
  TileArrays& operator=(const TileArrays&) = delete;

  /// What the tiling says of an owned tile.
  const Tile& of(const FlowTile& tile) const { return grid.tiling().tiles[std::size_t(tile.index)]; }
  /// By its index in the tiling.
  FlowTile& owned(int index) { return tiles[std::size_t(local[std::size_t(index)])]; }
  bool planar() const { return grid.tiling().planar; }
  long cells() const;  ///< of all ranks
  std::size_t bytes() const;

  GridStore& grid;
  std::vector<FlowTile> tiles;  ///< owned, in the order of the tiling
  std::vector<int> local;       ///< by tile of the tiling: index in tiles, -1 elsewhere
};

/// body(k, j, i, centre [m]) for every cell of a tile.
template <class Body>
void for_centres(const FlowTile& tile, Body&& body) {
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t c = g.cell_box.component;
  for (int k = 0; k < tile.box.nk; ++k)
    for (int j = 0; j < tile.box.nj; ++j)
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
        body(k, j, i, Eigen::Vector3d(x[0], x[c], x[2 * c]));
      }
}

/// A source of conserved amounts [per m3 and s], for manufactured solutions: rate(centre, values) fills one value per unknown.
template <class Body>
void set_source(std::span<FlowTile> tiles, Body&& rate) {
  for (FlowTile& tile : tiles) {
    tile.source = AlignedArray<double>(tile.inner.size(tile.unknowns()));
    for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
      std::array<double, mean_unknowns + 2> values{};
      rate(x, values);
      for (int n = 0; n < tile.unknowns(); ++n)
        tile.source.data()[tile.inner.at(k, j, i) + n * tile.inner.component] = values[std::size_t(n)];
    });
  }
}

/// Adds body(centre) [m/s] to the velocity of every cell.
template <class Body>
void add_velocity(std::span<FlowTile> tiles, Body&& body) {
  for (FlowTile& tile : tiles)
    for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
      const Eigen::Vector3d more = body(x);
      for (int d = 0; d < 3; ++d) tile.state.data()[tile.cells.at(k, j, i) + (1 + d) * tile.cells.component] += more[d];
    });
}

}  // namespace spindrift::aero
