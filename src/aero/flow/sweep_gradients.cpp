// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_gradients.hpp"

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

void sweep_gradients(FlowTile& tile, const double* state) {
  const TileGeometry& g = *tile.geometry;
  const int variables = 4 + tile.turbulence;
  const std::ptrdiff_t out_component = tile.gradient_box.component;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      gas::Vector<Row> low[3], high[3];
      for (int d = 0; d < tile.directions; ++d) {
        const BoxLayout& box = g.face_box[d];
        low[d] = load_vector(g.face_data[d].data() + box.at(k, j, i), box.component);
        high[d] = load_vector(g.face_data[d].data() + box.at(k + (d == 2), j + (d == 1), i + (d == 0)), box.component);
      }
      // Lanes beyond the row have no volume.
      const Row half = 0.5 / max(Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)), Row(1e-280));
      double* out = tile.gradients.data() + tile.gradient_box.at(k, j, i);
      for (int v = 0; v < variables; ++v) {
        const double* at = state + tile.cells.at(k, j, i) + (v + 1) * tile.cells.component;
        const Row here = Row::load(at);
        gas::Vector<Row> sum{0.0, 0.0, 0.0};
        for (int d = 0; d < tile.directions; ++d) {
          const std::ptrdiff_t step = tile.cells.stride(d);
          // The cell's own value times its closed surface is nothing; left out, a uniform field has no gradient to the last bit.
          const Row down = Row::load(at - step) - here, up = Row::load(at + step) - here;
          gas::add_face_pair(sum, down, low[d], up, high[d]);
        }
        (sum.x * half).store(out + (3 * v) * out_component);
        (sum.y * half).store(out + (3 * v + 1) * out_component);
        (sum.z * half).store(out + (3 * v + 2) * out_component);
      }
    }
  });
}

void fill_boundary_gradients(FlowTile& tile) {
  const int components = gradient_components(tile.turbulence);
  for (const FlowBoundary& boundary : tile.boundaries) {
    const Side side = boundary.where.side;
    const std::ptrdiff_t out = (at_end(side) ? 1 : -1) * tile.gradient_box.stride(direction_of(side));
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      double* at = tile.gradients.data() + tile.gradient_box.at(k, j, i);
      for (int c = 0; c < components; ++c) at[out + c * tile.gradient_box.component] = at[c * tile.gradient_box.component];
      if (tile.turbulence > 0 && boundary.condition == Condition::no_slip)  // on the wall, between both, there is no eddy viscosity
        for (int c = 0; c < 2; ++c) {
          const std::ptrdiff_t place = (3 * (4 + tile.turbulence) + c) * tile.gradient_box.component;
          at[out + place] = -at[place];
        }
    });
  }
}

}  // namespace spindrift::aero
