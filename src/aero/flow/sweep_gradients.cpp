// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_gradients.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/turbulence/wall_law.hpp"
#include "src/aero/flow/boundary.hpp"
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

namespace {

/// `to` = factor (I - 2 n n^T) applied to the gradient of one scalar.
void mirror(const double* from, std::ptrdiff_t c, double factor, const double (&n)[3], double* to) {
  const double across = 2.0 * (from[0] * n[0] + from[c] * n[1] + from[2 * c] * n[2]);
  for (int d = 0; d < 3; ++d) to[d * c] = factor * (from[d * c] - across * n[d]);
}

}  // namespace

double distance_to_wall(const FlowTile& tile, Side side, int k, int j, int i) {
  const TileGeometry& g = *tile.geometry;
  const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk}, at[3] = {i, j, k};
  const bool corner = std::ranges::any_of(tile.boundaries, [&](const FlowBoundary& other) {
    const auto &low = other.where.low, &high = other.where.high;
    const int d = direction_of(other.where.side);
    const auto [a, b] = along(other.where.side);
    return other.where.side != side && sticks(*other.condition) && at[d] == (at_end(other.where.side) ? extent[d] - 1 : 0) &&
           at[a] >= low[0] && at[a] < high[0] && at[b] >= low[1] && at[b] < high[1];
  });
  if (!corner) return g.wall_distance_data.data()[g.inner_box.at(k, j, i)];
  const gas::Face<double> f = outward_face(g, side, k, j, i);
  const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
  const Eigen::Vector3d centre(x[0], x[g.cell_box.component], x[2 * g.cell_box.component]);
  return std::abs((face_centre(g, side, k, j, i) - centre).dot(Eigen::Vector3d(f.nx, f.ny, f.nz)));
}

WallCell wall_cell(const FlowTile& tile, const double* state, const gas::IdealGas& gas, Side side, int k, int j, int i) {
  const gas::Face<double> f = outward_face(*tile.geometry, side, k, j, i);
  const std::ptrdiff_t at = tile.cells.at(k, j, i), out = (at_end(side) ? 1 : -1) * tile.cells.stride(direction_of(side));
  const auto q = gas::load_primitive<double>(state + at, std::size_t(tile.cells.component)),
             ghost = gas::load_primitive<double>(state + at + out, std::size_t(tile.cells.component));
  double u = 0.5 * (q.u - ghost.u), v = 0.5 * (q.v - ghost.v), w = 0.5 * (q.w - ghost.w);  // the wall has the mean of both
  const double across = u * f.nx + v * f.ny + w * f.nz;
  u -= across * f.nx, v -= across * f.ny, w -= across * f.nz;
  return {u,
          v,
          w,
          std::sqrt(u * u + v * v + w * w),
          distance_to_wall(tile, side, k, j, i),
          gas::density(gas, q),
          gas::viscosity(gas, gas::absolute_temperature(gas, q))};
}

void set_wall_law_gradients(FlowTile& tile, const double* state, const gas::IdealGas& gas) {
  const std::ptrdiff_t c = tile.gradient_box.component;
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (!boundary.condition->wall_law) continue;
    const Side side = boundary.where.side;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const gas::Face<double> f = outward_face(*tile.geometry, side, k, j, i);
      const double n[3] = {f.nx, f.ny, f.nz};
      const WallCell cell = wall_cell(tile, state, gas, side, k, j, i);
      if (!(cell.speed > 0.0)) return;
      const double rate = turbulence::wall_law_rate(*tile.wall_law, cell.speed, cell.distance, cell.mu / cell.rho) / cell.speed;
      double* at = tile.gradients.data() + tile.gradient_box.at(k, j, i);
      double now[3], along_wall = 0.0;
      for (int v = 0; v < 3; ++v) {
        now[v] = at[3 * v * c] * n[0] + at[(3 * v + 1) * c] * n[1] + at[(3 * v + 2) * c] * n[2];
        along_wall += now[v] * n[v];
      }
      const double law[3] = {-rate * cell.u, -rate * cell.v, -rate * cell.w};  // n points into the wall
      for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 3; ++d) at[(3 * v + d) * c] += (law[v] - (now[v] - along_wall * n[v])) * n[d];
    });
  }
}

void fill_boundary_gradients(FlowTile& tile, const double* state, const gas::IdealGas& gas,
                             const std::array<double, 2>& wall_spread) {
  const std::ptrdiff_t c = tile.gradient_box.component;
  const int carried = tile.turbulence, eddy = 3 * (4 + carried), components = gradient_components(carried, tile.eddies);
  for (const FlowBoundary& boundary : tile.boundaries) {
    const Side side = boundary.where.side;
    const std::ptrdiff_t out = (at_end(side) ? 1 : -1) * tile.gradient_box.stride(direction_of(side));
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const double* at = tile.gradients.data() + tile.gradient_box.at(k, j, i);
      double* ghost = tile.gradients.data() + tile.gradient_box.at(k, j, i) + out;
      if (!is_wall(*boundary.condition)) {
        for (int m = 0; m < components; ++m) ghost[m * c] = at[m * c];
        return;
      }
      const bool sticks = aero::sticks(*boundary.condition);
      const gas::Face<double> f = outward_face(*tile.geometry, side, k, j, i);
      const double n[3] = {f.nx, f.ny, f.nz};
      // A wall at rest turns velocities and what turbulence carries about (of a moving one the velocity may vary along it: there
      // the cell's gradient is taken); a mirror turns the velocity's normal component.
      const bool moves = sticks && tile.geometry->moving();
      const bool free = boundary.condition->wall_law && carried == 2;  // k does not pass such a wall
      for (int v = 0; v < 4 + carried; ++v)
        if (moves && v < 3)
          for (int d = 0; d < 3; ++d) ghost[(3 * v + d) * c] = at[(3 * v + d) * c];
        else
          mirror(at + 3 * v * c, c, sticks && v != 3 && !(free && v > 3) ? -1.0 : 1.0, n, ghost + 3 * v * c);
      if (!sticks)
        for (int d = 0; d < 3; ++d) {
          const double across = 2.0 * (ghost[d * c] * n[0] + ghost[(3 + d) * c] * n[1] + ghost[(6 + d) * c] * n[2]);
          for (int v = 0; v < 3; ++v) ghost[(3 * v + d) * c] -= across * n[v];
        }
      if (!tile.eddies) return;
      for (int m = eddy; m < components; ++m) ghost[m * c] = at[m * c];
      if (!sticks) return;
      ghost[eddy * c] = -at[eddy * c];  // on the wall there is no eddy viscosity
      if (!free) ghost[(eddy + 1) * c] = -at[(eddy + 1) * c];
      if (boundary.condition->wall_law) {
        // The face's share is such that half the difference of cell and ghost over the distance gives the law's friction.
        const WallCell cell = wall_cell(tile, state, gas, side, k, j, i);
        ghost[eddy * c] +=
            2.0 * (turbulence::wall_viscosity(*tile.wall_law, cell.speed, cell.distance, cell.rho, cell.mu) - cell.mu);
      }
      const std::size_t component = std::size_t(tile.cells.component);
      const double* cell = state + tile.cells.at(k, j, i);
      const double* beyond = cell + (at_end(side) ? 1 : -1) * tile.cells.stride(direction_of(side));
      const auto wall = 0.5 * (gas::load_primitive<double>(cell, component) + gas::load_primitive<double>(beyond, component));
      const double mu = gas::viscosity(gas, gas::absolute_temperature(gas, wall));
      for (int t = 0; t < carried; ++t)
        ghost[(eddy + 2 + t) * c] = 2.0 * wall_spread[std::size_t(t)] * mu - at[(eddy + 2 + t) * c];
    });
  }
}

}  // namespace spindrift::aero
