// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/mass_balance.hpp"

#include <algorithm>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

void set_through_faces(FlowTile& tile) {
  const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
  for (const FlowBoundary& boundary : tile.boundaries) {
    const Side side = boundary.where.side;
    AlignedArray<double>& through = tile.sides[std::size_t(side)].through;
    if (is_closed(*boundary.condition) || through.size() > 0) continue;
    through = AlignedArray<double>(std::size_t(open_row(tile.box, direction_of(side)) * extent[along(side)[1]] + row_lanes));
  }
}

MassBalance mass_balance(const FlowTile& tile, const gas::IdealGas& gas, const PhysicalTime& time) {
  MassBalance sum;
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (is_closed(*boundary.condition)) continue;
    const Side side = boundary.where.side;
    const int d = direction_of(side);
    const std::ptrdiff_t row = open_row(tile.box, d);
    const double outward = at_end(side) ? 1.0 : -1.0;
    const double* through = tile.sides[std::size_t(side)].through.data();
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const std::ptrdiff_t place = d == 0 ? k * row + j : (d == 1 ? k : j) * row + i;
      const double out = outward * through[place];
      sum.outflow += std::max(out, 0.0), sum.inflow += std::max(-out, 0.0);
    });
  }
  for_rows(tile.box, [&](int k, int j) {
    double left = 0.0;
    const double* r = tile.residual.data() + tile.inner.at(k, j, 0);
    for (int i = 0; i < tile.box.ni; ++i) left += r[i];
    sum.residual += left;
  });
  if (!time.unsteady()) return sum;
  const double now = time.weights.now / time.dt, old = time.weights.old / time.dt, older = time.weights.older / time.dt,
               oldest = time.weights.oldest / time.dt;
  const TileGeometry& g = *tile.geometry;
  for_rows(tile.box, [&](int k, int j) {
    double gained = 0.0;
    for (int i = 0; i < tile.box.ni; ++i) {
      const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      const std::ptrdiff_t place = tile.inner.at(k, j, i);
      gained += now * g.volume_data.data()[g.cell_box.at(k, j, i)] * gas::density(gas, q) + old * tile.past[0].data()[place];
      if (older != 0.0) gained += older * tile.past[1].data()[place];
      if (oldest != 0.0) gained += oldest * tile.past[2].data()[place];
    }
    sum.growth += gained;
  });
  return sum;
}

}  // namespace spindrift::aero
