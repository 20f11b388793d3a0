// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

#include <cmath>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

namespace {

gas::Primitive<double> load(const FlowTile& tile, const double* state, std::ptrdiff_t at) {
  return gas::load_primitive<double>(state + at, std::size_t(tile.cells.component));
}

/// Index step from a cell out of the tile through a side.
std::ptrdiff_t outward(const BoxLayout& box, Side side) { return (at_end(side) ? 1 : -1) * box.stride(direction_of(side)); }

int cells_across(const FlowTile& tile, Side side) {
  const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
  return extent[direction_of(side)];
}

/// Share of the difference of the two cells at a face by which a value changes from the first of them to the face.
double wall_weight(const TileGeometry& g, Side side, int k, int j, int i) {
  const std::ptrdiff_t here = g.cell_box.at(k, j, i), in = -outward(g.cell_box, side);
  const double v = g.volume_data.data()[here];
  return v / (v + g.volume_data.data()[here + in]);
}

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

gas::Primitive<double> BoundaryFace::next() const {
  return deep ? load(tile, state, tile.cells.at(k, j, i) - outward(tile.cells, boundary.where.side)) : inside;
}

gas::Vector<double> BoundaryFace::wall_velocity() const {
  return aero::wall_velocity(*tile.geometry, boundary.where.side, k, j, i, setting);
}

gas::Primitive<double> BoundaryFace::stream() const {
  const auto place = [&] { return face_centre(*tile.geometry, boundary.where.side, k, j, i); };
  if (!setting.wind.steady()) {
    const Eigen::Vector3d u = setting.wind.velocity(place(), 0.0);
    return {setting.stream.p, u.x(), u.y(), u.z(), setting.stream.T};
  }
  if (setting.profile.uniform()) return setting.stream;
  return stream_at(setting.stream, setting.profile, place().z());
}

double BoundaryFace::weight() const { return wall_weight(*tile.geometry, boundary.where.side, k, j, i); }

Eigen::Vector3d InflowPlane::acceleration(const Eigen::Vector3d& cell, double extent) const {
  constexpr double reach = 4.0;
  const double along = normal.dot(cell - centre);
  if (std::abs(along) > reach * width + extent) return Eigen::Vector3d::Zero();
  const double share = std::erf((along + 0.5 * extent) / width) - std::erf((along - 0.5 * extent) / width);
  return share / (2.0 * extent) * push(cell);
}

void fill_boundaries(FlowTile& tile, double* state, const BoundarySetting& s) {
  const TileGeometry& g = *tile.geometry;
  for (const FlowBoundary& boundary : tile.boundaries) {
    const BoundaryCondition& condition = *boundary.condition;
    const Side side = boundary.where.side;
    const std::ptrdiff_t out = outward(tile.cells, side), component = tile.cells.component;
    const bool deep = cells_across(tile, side) > 1;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const std::ptrdiff_t cell = tile.cells.at(k, j, i);
      const gas::Primitive<double> inside_mean = load(tile, state, cell);
      const gas::Face<double> f = outward_face(g, side, k, j, i);
      const Ghosts ghosts = condition.ghosts({tile, state, boundary, s, k, j, i, deep, f, inside_mean});
      gas::store_primitive(state + cell + out, std::size_t(component), ghosts.first);
      gas::store_primitive(state + cell + 2 * out, std::size_t(component), ghosts.second);
      if (tile.turbulence == 0) return;
      double inside[2], ghost[2];
      for (int t = 0; t < tile.turbulence; ++t) ghost[t] = inside[t] = state[cell + (mean_unknowns + t) * component];
      if (condition.wall_law && tile.turbulence == 2) {
        // As inside: no flux of k; omega of that cell is given by the law of the wall.
      } else if (sticks(condition)) {
        gas::Primitive<double> wall = inside_mean;
        wall.T = 0.5 * (inside_mean.T + ghosts.first.T);
        const double nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, wall)) / gas::density(s.gas, wall);
        s.wall_carried(inside, nu, g.wall_distance_data.data()[g.inner_box.at(k, j, i)], ghost);
      } else if (!is_wall(condition) && gas::normal_velocity(inside_mean, f) < f.speed) {
        for (int t = 0; t < tile.turbulence; ++t) ghost[t] = s.carried[std::size_t(t)];
      }
      for (int t = 0; t < tile.turbulence; ++t)
        state[cell + out + (mean_unknowns + t) * component] = state[cell + 2 * out + (mean_unknowns + t) * component] = ghost[t];
    });
  }
}

double wall_pressure(const FlowTile& tile, const double* state, Side side, int k, int j, int i) {
  const std::ptrdiff_t cell = tile.cells.at(k, j, i), in = -outward(tile.cells, side);
  if (cells_across(tile, side) < 2) return state[cell];
  return state[cell] + wall_weight(*tile.geometry, side, k, j, i) * (state[cell] - state[cell + in]);
}

void add_wall_pressure(FlowTile& tile, const double* state, double* residual) {
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (!is_closed(*boundary.condition)) continue;
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
    if (!is_closed(*boundary.condition)) continue;
    const Side side = boundary.where.side;
    const int d = direction_of(side);
    const auto [a, b] = along(side);
    const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
    const std::ptrdiff_t row = open_row(tile.box, d);
    const auto mark = [&, b = b](AlignedArray<double>& flags, double elsewhere) {
      if (flags.size() == 0) {
        flags = AlignedArray<double>(std::size_t(row * extent[b] + row_lanes));
        for (double& flag : flags.span()) flag = elsewhere;
      }
      for (int m = boundary.where.low[1]; m < boundary.where.high[1]; ++m)
        for (int n = boundary.where.low[0]; n < boundary.where.high[0]; ++n) flags.data()[m * row + n] = 1.0 - elsewhere;
    };
    mark(tile.sides[std::size_t(side)].open, 1.0);
    if (boundary.condition->wall_law) mark(tile.sides[std::size_t(side)].law, 0.0);
    static_cast<void>(a);
  }
}

}  // namespace spindrift::aero
