// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_jacobian.hpp"

#include "kernels/gas/jacobians.hpp"
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

namespace {

using Block = gas::Block5<Row>;

/// Derivatives of the first-order flux through eight faces by the states on both sides.
SPINDRIFT_INLINE gas::FluxJacobian<Row> convection(const ImplicitSetting& s, const gas::Primitive<Row>& l,
                                                   const gas::Primitive<Row>& r, const gas::Face<Row>& f) {
  if (s.rusanov) return gas::flux_jacobian(gas::Rusanov{}, s.gas, l, r, f);
  if (s.preconditioned_waves) {
    // Waves at the reference speed U instead of c: a velocity jump pushes with rho U, a pressure jump drives a mass dp / U. So
    // pressure and velocity are as strong on the diagonal as beside it at any Mach number, and ILU is as good.
    const gas::RoeMean<Row> m = gas::roe_mean(s.gas, l, r, f);
    const gas::WaveSpeeds<Row> w = gas::wave_speeds(m, f, gas::Roe{}.entropy_fix);
    const Row u = m.u - f.vx, v = m.v - f.vy, z = m.w - f.vz;
    const Row scale = min(max(Row(s.wave_speeds_of_floor * s.floor_speed), sqrt(u * u + v * v + z * z)) * m.inverse_c, Row(1.0));
    const Block D = gas::dissipation_jacobian(s.gas, m, f, w.slow, w.middle, w.fast, scale, 1.0 / scale);
    return {gas::combine(gas::physical_jacobian(s.gas, l, f, Row(0.5)), 0.5, D),
            gas::combine(gas::physical_jacobian(s.gas, r, f, Row(0.5)), -0.5, D)};
  }
  if (s.mach_floor >= 1.0) return gas::flux_jacobian(gas::Roe{}, s.gas, l, r, f);
  return gas::flux_jacobian(gas::RoeLowMach{.mach_floor = s.mach_floor}, s.gas, l, r, f);
}
SPINDRIFT_INLINE void add_viscosity(gas::FluxJacobian<Row>& b, const ImplicitSetting& s, const gas::Primitive<Row>& l,
                                    const gas::Primitive<Row>& r, const gas::Vector<Row>& line, const Row& eddy,
                                    const gas::Face<Row>& f) {
  const gas::Primitive<Row> q = 0.5 * (l + r);
  const gas::Transport<Row> t = gas::transport(s.gas, gas::viscosity(s.gas, gas::absolute_temperature(s.gas, q)), eddy);
  const Block by_right = gas::thin_layer_jacobian(t, gas::face_line(line, f), q.u, q.v, q.w, f);
  b.left = gas::combine(b.left, -1.0, by_right);
  b.right = gas::combine(b.right, 1.0, by_right);
}

/// Adds the lanes of a block to the diagonals of consecutive cells, column by column; `anew`: puts them there.
template <bool anew>
SPINDRIFT_INLINE void to_diagonals(const float (&lanes)[25][8], int first, int last, float sign, const MeanMatrix& a,
                                   std::ptrdiff_t cell) {
  for (int lane = first; lane < last; ++lane) {
    float* at = a.block(cell + lane, a.diagonal);
    for (int e = 0; e < 25; ++e) at[e] = (anew ? 0.0f : at[e]) + sign * lanes[e][lane];
  }
}
/// Puts them into the blocks of a side; the diagonals are there already.
SPINDRIFT_INLINE void to_sides(const float (&lanes)[25][8], int first, int last, float sign, const MeanMatrix& a,
                               std::ptrdiff_t cell, int side) {
  for (int lane = first; lane < last; ++lane)
    for (int e = 0; e < 25; ++e) a.put_side(cell + lane, side, e, sign * lanes[e][lane]);
}
SPINDRIFT_INLINE void to_lanes(const Block& b, const double (&scale)[5][5], float (&lanes)[25][8]) {
  for (int c = 0; c < 5; ++c)
    for (int r = 0; r < 5; ++r) {
      const Row scaled = b.m[r][c] * Row(scale[r][c]);
      for (int lane = 0; lane < 8; ++lane) lanes[c * 5 + r][lane] = float(scaled.v[lane]);
    }
}

struct Entries {
  double scale[5][5];  ///< column unit over row unit
  explicit Entries(const Scales& s) {
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c < 5; ++c) scale[r][c] = s.unknown[std::size_t(c)] / s.residual[std::size_t(r)];
  }
};

/// Faces across one direction of all rows.
void add_faces(FlowTile& tile, const double* state, const double* eddy, int d, const ImplicitSetting& s, const Entries& entries) {
  const TileGeometry& g = *tile.geometry;
  const linear::CellBox& box = tile.box;
  const MeanMatrix a = tile.mean();
  const int extent[3] = {box.ni, box.nj, box.nk};
  const int nk = box.nk + (d == 2), nj = box.nj + (d == 1), ni = box.ni + (d == 0);
  const std::ptrdiff_t step = tile.cells.stride(d), back = box.stride(d);
  const std::size_t component = std::size_t(tile.cells.component);
  alignas(64) float l[25][8], r[25][8];
  for (int k = 0; k < nk; ++k)
    for (int j = 0; j < nj; ++j)
      for (int i = 0; i < ni; i += row_lanes) {
        const double* at = state + tile.cells.at(k, j, i);
        const gas::Primitive<Row> ql = gas::load_primitive<Row>(at - step, component),
                                  qr = gas::load_primitive<Row>(at, component);
        gas::Face<Row> f = load_face(g, d, k, j, i);
        if ((s.mach_floor < 1.0 || s.preconditioned_waves) && g.moving()) add_grid_velocity(g, d, k, j, i, f);
        gas::FluxJacobian<Row> b = convection(s, ql, qr, f);
        const int n = d == 1 ? j : k;
        const auto masked = [&](int end) -> const AlignedArray<double>& { return tile.sides[std::size_t(2 * d + end)].open; };
        if (d > 0) {
          for (const int end : {0, 1})
            if (n == end * extent[d] && masked(end).size() > 0) {
              const Row open = Row::load(masked(end).data() + (d == 1 ? k : j) * open_row(box, d) + i);
              for (int e = 0; e < 25; ++e) b.left.m[e / 5][e % 5] *= open, b.right.m[e / 5][e % 5] *= open;
            }
        } else {
          for (const int end : {0, 1})
            if (const int lane = end * box.ni - i; lane >= 0 && lane < 8 && masked(end).size() > 0) {
              Row open = 1.0;
              open.v[lane] = masked(end).data()[k * open_row(box, 0) + j];
              for (int e = 0; e < 25; ++e) b.left.m[e / 5][e % 5] *= open, b.right.m[e / 5][e % 5] *= open;
            }
        }
        if (s.viscous) {
          const std::ptrdiff_t place = g.cell_box.at(k, j, i), before = place - g.cell_box.stride(d);
          const auto xl = load_vector(g.centre_data.data() + before, g.cell_box.component),
                     xr = load_vector(g.centre_data.data() + place, g.cell_box.component);
          Row turbulent = 0.0;
          if (eddy != nullptr) {
            const double* mu = eddy + tile.gradient_box.at(k, j, i);
            turbulent = 0.5 * (Row::load(mu - tile.gradient_box.stride(d)) + Row::load(mu));
          }
          add_viscosity(b, s, ql, qr, {xr.x - xl.x, xr.y - xl.y, xr.z - xl.z}, turbulent, f);
        }
        to_lanes(b.left, entries.scale, l);
        to_lanes(b.right, entries.scale, r);
        const std::ptrdiff_t right = (std::ptrdiff_t(k) * box.nj + j) * box.ni + i;
        const int used = std::min(8, ni - i);
        // Right of the face: cells that exist; left of it: the same one step back.
        const int right_end = d == 0 ? std::min(8, box.ni - i) : (n < extent[d] ? used : 0);
        if (right_end > 0) {
          to_diagonals<false>(r, 0, right_end, -1.0f, a, right);
          to_sides(l, 0, right_end, -1.0f, a, right, 2 * d);
        }
        const int left_first = d == 0 && i == 0 ? 1 : 0, left_end = d > 0 && n == 0 ? 0 : used;
        if (left_end > left_first) {
          to_diagonals<false>(l, left_first, left_end, 1.0f, a, right - back);
          to_sides(r, left_first, left_end, 1.0f, a, right - back, 2 * d + 1);
        }
      }
}

/// What a cell beyond a boundary adds to the diagonal, as its state follows that of the cell inside; it is no neighbour then.
void fold_boundaries(FlowTile& tile, const Entries& entries, const std::array<double, 3>& wind) {
  const MeanMatrix a = tile.mean();
  for (const FlowBoundary& boundary : tile.boundaries) {
    const BoundaryCondition& condition = *boundary.condition;
    const Side side = boundary.where.side;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const std::ptrdiff_t cell = (std::ptrdiff_t(k) * tile.box.nj + j) * tile.box.ni + i;
      float* diagonal = a.block(cell, a.diagonal);
      auto* beyond = a.side(cell, int(side));
      float numbers[25];
      std::copy_n(beyond, 25, numbers);
      const gas::Face<double> f = outward_face(*tile.geometry, side, k, j, i);
      if (condition.fold != nullptr) condition.fold({diagonal, numbers, f, wind, boundary.temperature.has_value()});
      if (is_closed(condition)) {  // pressure of the cell on the wall
        const double n[3] = {f.nx, f.ny, f.nz};
        for (int c = 1; c < 4; ++c) diagonal[c] += float(n[c - 1] * f.area * entries.scale[c][0]);
        diagonal[4] += float(f.speed * f.area * entries.scale[4][0]);
      }
      std::fill_n(beyond, 25, linear::ShortFloat());
    });
  }
}

/// Volume over the pseudo-step times its matrix, plus volume times rate of the physical step times dW/dQ.
template <class Real>
SPINDRIFT_INLINE gas::Block5<Real> time_block(const ImplicitSetting& s, const gas::Primitive<Real>& q, const Real& pseudo,
                                              const Real& physical) {
  const gas::Thermo<Real> t = gas::thermo(s.gas, q);
  gas::Block5<Real> sum = gas::conserved_by_primitive(s.gas, gas::preconditioned(s.gas, t, reference_squared(s, q)), q);
  const gas::Block5<Real> change = gas::conserved_by_primitive(s.gas, t, q);
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c) sum.m[r][c] = pseudo * sum.m[r][c] + physical * change.m[r][c];
  return sum;
}

/// Volume times the derivatives of omega x (rho u).
SPINDRIFT_INLINE void add_turning(Block& sum, const ImplicitSetting& s, const gas::Primitive<Row>& q, const Row& volume) {
  const auto [x, y, z] = s.omega;
  const gas::Thermo<Row> t = gas::thermo(s.gas, q);
  const Row across[3] = {y * q.w - z * q.v, z * q.u - x * q.w, x * q.v - y * q.u}, mass = volume * t.rho;
  for (int r = 0; r < 3; ++r) {
    sum.m[r + 1][0] += volume * t.rho_p * across[r];
    sum.m[r + 1][4] += volume * t.rho_T * across[r];
  }
  sum.m[1][3] += y * mass, sum.m[1][2] += -z * mass;
  sum.m[2][1] += z * mass, sum.m[2][3] += -x * mass;
  sum.m[3][2] += x * mass, sum.m[3][1] += -y * mass;
}

}  // namespace

void sweep_rates(FlowTile& tile, const double* state, const ImplicitSetting& s) {
  const TileGeometry& g = *tile.geometry;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const gas::Primitive<Row> q = gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      const Row c2 = (s.gas.gamma * s.gas.gas_constant) * gas::absolute_temperature(s.gas, q), r2 = reference_squared(s, q);
      const Row volume = max(Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)), Row(1e-280));
      const Row nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, q)) / gas::density(s.gas, q);
      Row sum = 0.0;
      for (int d = 0; d < tile.directions; ++d) {
        const gas::Face<Row> low = load_face(g, d, k, j, i), high = load_face(g, d, k + (d == 2), j + (d == 1), i + (d == 0));
        for (const auto& f : {low, high}) {
          const auto speeds = gas::preconditioned_speeds(gas::normal_velocity(q, f) - f.speed, c2, r2);
          sum += 0.5 * f.area * max(abs(speeds.slow), abs(speeds.fast));
          if (s.viscous) sum += 2.0 * nu * f.area * f.area / volume;
        }
      }
      double* out = tile.rate.data() + tile.inner.at(k, j, i);
      sum.store(out);
    }
  });
}

void sweep_jacobian(FlowTile& tile, const double* state, const double* eddy, double cfl, const ImplicitSetting& s) {
  const Entries entries(s.scales);
  const MeanMatrix a = tile.mean();
  const TileGeometry& g = *tile.geometry;
  alignas(64) float lanes[25][8];
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const gas::Primitive<Row> q = gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      const Row pseudo = Row::load(tile.rate.data() + tile.inner.at(k, j, i)) * (1.0 / cfl);
      const Row physical = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)) * s.physical_rate;
      gas::Block5<Row> block = time_block(s, q, pseudo, physical);
      if (s.omega != std::array<double, 3>{}) add_turning(block, s, q, Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)));
      to_lanes(block, entries.scale, lanes);
      to_diagonals<true>(lanes, 0, std::min(8, tile.box.ni - i), 1.0f, a,
                         (std::ptrdiff_t(k) * tile.box.nj + j) * tile.box.ni + i);
    }
  });
  for (int d = 0; d < tile.directions; ++d) add_faces(tile, state, eddy, d, s, entries);
  fold_boundaries(tile, entries, s.inflow);
}

void add_pseudo_time(const FlowTile& tile, const double* state, double cfl, const ImplicitSetting& s, const float* z, float* w) {
  const Entries entries(s.scales);
  ImplicitSetting pseudo_only = s;
  pseudo_only.physical_rate = 0.0;
  const std::ptrdiff_t component = tile.gradient_box.component;
  std::ptrdiff_t cell = 0;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const gas::Primitive<Row> q = gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      const auto block =
          time_block<Row>(pseudo_only, q, Row::load(tile.rate.data() + tile.inner.at(k, j, i)) * (1.0 / cfl), Row(0.0));
      const int used = std::min(int(row_lanes), tile.box.ni - i);
      alignas(64) double direction[5][row_lanes] = {}, sum[row_lanes];
      for (int c = 0; c < 5; ++c)
        for (int lane = 0; lane < used; ++lane)
          direction[c][lane] = double(z[tile.gradient_box.at(k, j, i) + c * component + lane]);
      for (int r = 0; r < 5; ++r) {
        Row row = 0.0;
        for (int c = 0; c < 5; ++c) row += block.m[r][c] * (Row(entries.scale[r][c]) * Row::load(direction[c]));
        row.store(sum);
        for (int lane = 0; lane < used; ++lane) w[(cell + lane) * 5 + r] += float(sum[lane]);
      }
      cell += used;
    }
  });
}

}  // namespace spindrift::aero
