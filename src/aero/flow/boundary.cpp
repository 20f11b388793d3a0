// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

#include <cmath>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

namespace {

gas::Primitive<double> load(const FlowTile& tile, const double* state, std::ptrdiff_t at) {
  return gas::load_primitive<double>(state + at, std::size_t(tile.cells.component));
}

gas::Primitive<double> ghost_state(const FlowBoundary& boundary, const gas::Primitive<double>& inside, const gas::Face<double>& f,
                                   const gas::Vector<double>& wall, const gas::Primitive<double>& stream,
                                   const BoundarySetting& s) {
  switch (boundary.condition) {
    case Condition::wall_law:
    case Condition::no_slip: {
      gas::Primitive<double> ghost = gas::no_slip_ghost(inside, wall);
      if (boundary.temperature) ghost.T = gas::isothermal_ghost(s.gas, inside.T, *boundary.temperature);
      return ghost;
    }
    case Condition::slip:
    case Condition::symmetry:
      return gas::mirrored(inside, f);
    case Condition::inflow_velocity:
      return gas::inflow_velocity(inside, stream);
    case Condition::inflow_stagnation:
      return gas::inflow_reservoir(s.gas, inside, s.profile.uniform() ? s.reservoir : reservoir_of(s.gas, stream));
    case Condition::outflow_pressure:
      return gas::outflow_pressure(s.gas, inside, stream, f);
    case Condition::far_field:
      break;
  }
  return gas::far_field(s.gas, inside, stream, f, s.reference_speed);
}

/// Behind a slip wall along which the flow turns, pressure and what moves along the wall vary across it: ghosts are the straight
/// line through the two cells inside. Mirror images have a kink at the wall, which the reconstruction of the next face answers
/// with a jump.
struct SlipGhosts {
  gas::Primitive<double> first, second;
};
SlipGhosts slip_ghosts(const gas::Primitive<double>& inside, const gas::Primitive<double>& next, const gas::Face<double>& f,
                       double weight, bool all) {
  const gas::Primitive<double> mirror = gas::mirrored(inside, f), mirror_next = gas::mirrored(next, f);
  const double slope = 2.0 * weight;  // from the cell to its ghost, over the difference of both cells
  SlipGhosts g{mirror, mirror_next};
  g.first.p = inside.p + slope * (inside.p - next.p), g.second.p = g.first.p + (inside.p - next.p);
  if (!all) return g;
  const double un = gas::normal_velocity(inside, f), un_next = gas::normal_velocity(next, f), du = un - un_next;
  const gas::Primitive<double> d{0.0, inside.u - next.u - du * f.nx, inside.v - next.v - du * f.ny, inside.w - next.w - du * f.nz,
                                 inside.T - next.T};
  const double ghost = 2.0 * f.speed - un, ghost_next = 2.0 * f.speed - un_next;
  const auto along = [&](double share, double normal) {
    const double shift = normal - un;
    return gas::Primitive<double>{0.0, inside.u + share * d.u + shift * f.nx, inside.v + share * d.v + shift * f.ny,
                                  inside.w + share * d.w + shift * f.nz, inside.T + share * d.T};
  };
  const double p = g.first.p, p_next = g.second.p;
  g.first = along(slope, ghost), g.second = along(slope + 1.0, ghost_next);
  g.first.p = p, g.second.p = p_next;
  return g;
}

/// Index step from a cell out of the tile through a side.
std::ptrdiff_t outward(const BoxLayout& box, Side side) { return (at_end(side) ? 1 : -1) * box.stride(direction_of(side)); }

}  // namespace

gas::Reservoir reservoir_of(const gas::IdealGas& gas, const gas::Primitive<double>& stream) {
  const double T = gas::absolute_temperature(gas, stream), T0 = T + gas::kinetic(stream) / gas.cp();
  const double speed = std::sqrt(2.0 * gas::kinetic(stream)), inverse = speed > 0.0 ? 1.0 / speed : 0.0;
  return {gas::absolute_pressure(gas, stream) * std::pow(T0 / T, gas.gamma / (gas.gamma - 1.0)), T0, stream.u * inverse,
          stream.v * inverse, stream.w * inverse};
}

Eigen::Vector3d face_centre(const TileGeometry& g, Side side, int k, int j, int i) {
  const int d = direction_of(side);
  const auto [a, b] = along(side);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int n = 0; n < 4; ++n) {
    int at[3] = {i, j, k};
    at[d] += at_end(side) ? 1 : 0, at[a] += n % 2, at[b] += n / 2;
    for (int c = 0; c < 3; ++c) sum[c] += g.node_data.data()[c * g.node_box.component + g.node_box.at(at[2], at[1], at[0])];
  }
  return sum / 4.0;
}

gas::Vector<double> wall_velocity(const TileGeometry& g, Side side, int k, int j, int i, const BoundarySetting& s) {
  if (!g.moving() || (s.dt <= 0.0 && !s.turning)) return {0.0, 0.0, 0.0};
  const int d = direction_of(side), end = at_end(side) ? 1 : 0;
  const auto [a, b] = along(side);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int n = 0; n < 4; ++n) {
    int at[3] = {i, j, k};
    at[d] += end, at[a] += n % 2, at[b] += n / 2;
    if (s.turning) {
      const double* x = g.node_data.data() + g.node_box.at(at[2], at[1], at[0]);
      sum += g.rate.velocity + g.rate.omega.cross(Eigen::Vector3d(x[0], x[g.node_box.component], x[2 * g.node_box.component]));
    } else {
      sum += node_velocity(g, s.weights, s.dt, at[2], at[1], at[0]);
    }
  }
  sum /= 4.0;
  return {sum[0], sum[1], sum[2]};
}

void fill_boundaries(FlowTile& tile, double* state, const BoundarySetting& s) {
  const TileGeometry& g = *tile.geometry;
  for (const FlowBoundary& boundary : tile.boundaries) {
    const Side side = boundary.where.side;
    const std::ptrdiff_t out = outward(tile.cells, side), component = tile.cells.component;
    const bool deep = (direction_of(side) == 0 ? tile.box.ni : direction_of(side) == 1 ? tile.box.nj : tile.box.nk) > 1;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const std::ptrdiff_t cell = tile.cells.at(k, j, i);
      const gas::Face<double> f = outward_face(g, side, k, j, i);
      const gas::Vector<double> wall =
          boundary.condition == Condition::no_slip ? wall_velocity(g, side, k, j, i, s) : gas::Vector<double>{0.0, 0.0, 0.0};
      const gas::Primitive<double> first = load(tile, state, cell);
      // A wall's second ghost mirrors the second cell; behind an open boundary both are alike.
      const gas::Primitive<double> second = is_wall(boundary.condition) && deep ? load(tile, state, cell - out) : first;
      SlipGhosts ghosts{};
      if (boundary.condition == Condition::slip && deep) {
        const std::ptrdiff_t here = g.cell_box.at(k, j, i), in = -outward(g.cell_box, side);
        const double v = g.volume_data.data()[here], weight = v / (v + g.volume_data.data()[here + in]);
        ghosts = slip_ghosts(first, second, f, weight, s.inviscid);
      } else {
        const gas::Primitive<double> stream = s.profile.uniform() || is_wall(boundary.condition)
                                                  ? s.stream
                                                  : stream_at(s.stream, s.profile, face_centre(g, side, k, j, i).z());
        ghosts = {ghost_state(boundary, first, f, wall, stream, s), ghost_state(boundary, second, f, wall, stream, s)};
      }
      gas::store_primitive(state + cell + out, std::size_t(component), ghosts.first);
      gas::store_primitive(state + cell + 2 * out, std::size_t(component), ghosts.second);
      if (tile.turbulence == 0) return;
      double inside[2], ghost[2];
      for (int t = 0; t < tile.turbulence; ++t) ghost[t] = inside[t] = state[cell + (mean_unknowns + t) * component];
      if (boundary.condition == Condition::no_slip && boundary.law && tile.turbulence == 2) {
        // As inside: no flux of k; omega of that cell is given by the law of the wall.
      } else if (boundary.condition == Condition::no_slip) {
        const double nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, first)) / gas::density(s.gas, first);
        s.wall_carried(inside, nu, g.wall_distance_data.data()[g.inner_box.at(k, j, i)], ghost);
      } else if (!is_wall(boundary.condition) && gas::normal_velocity(first, f) < f.speed) {
        for (int t = 0; t < tile.turbulence; ++t) ghost[t] = s.carried[std::size_t(t)];
      }
      for (int t = 0; t < tile.turbulence; ++t)
        state[cell + out + (mean_unknowns + t) * component] = state[cell + 2 * out + (mean_unknowns + t) * component] = ghost[t];
    });
  }
}

double wall_pressure(const FlowTile& tile, const double* state, Side side, int k, int j, int i) {
  const int d = direction_of(side), extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
  const std::ptrdiff_t cell = tile.cells.at(k, j, i), in = -outward(tile.cells, side);
  if (extent[d] < 2) return state[cell];
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t here = g.cell_box.at(k, j, i), step = -outward(g.cell_box, side);
  const double v = g.volume_data.data()[here], weight = v / (v + g.volume_data.data()[here + step]);
  return state[cell] + weight * (state[cell] - state[cell + in]);
}

void add_wall_pressure(FlowTile& tile, const double* state, double* residual) {
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (!is_closed(boundary.condition)) continue;
    const Side side = boundary.where.side;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const gas::Conserved<double> flux =
          gas::wall_flux(wall_pressure(tile, state, side, k, j, i), outward_face(*tile.geometry, side, k, j, i));
      double* at = residual + tile.inner.at(k, j, i);
      const std::ptrdiff_t c = tile.inner.component;
      at[c] += flux.mx, at[2 * c] += flux.my, at[3 * c] += flux.mz, at[4 * c] += flux.E;
    });
  }
}

void set_open_faces(FlowTile& tile) {
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (!is_closed(boundary.condition)) continue;
    const Side side = boundary.where.side;
    const int d = direction_of(side);
    const auto [a, b] = along(side);
    const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
    const std::ptrdiff_t row = open_row(tile.box, d);
    const auto mark = [&](AlignedArray<double>& flags, double elsewhere) {
      if (flags.size() == 0) {
        flags = AlignedArray<double>(std::size_t(row * extent[b] + row_lanes));
        for (double& flag : flags.span()) flag = elsewhere;
      }
      for (int m = boundary.where.low[1]; m < boundary.where.high[1]; ++m)
        for (int n = boundary.where.low[0]; n < boundary.where.high[0]; ++n) flags.data()[m * row + n] = 1.0 - elsewhere;
    };
    mark(tile.open[std::size_t(side)], 1.0);
    if (boundary.law) mark(tile.law[std::size_t(side)], 0.0);
    static_cast<void>(a);
  }
}

}  // namespace spindrift::aero
