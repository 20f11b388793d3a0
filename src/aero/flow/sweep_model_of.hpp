// The sweeps of sweep_model.hpp written once for any model that meets the concept of kernels/turbulence/model.hpp.
// Instantiated in model_*.cpp; tested in tests/verification/air/closures_test.cpp and wall_function_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/preconditioner.hpp"
#include "kernels/linear/stencil_matrix.hpp"
#include "kernels/turbulence/model.hpp"
#include "kernels/turbulence/wall_layer.hpp"
#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/sweep_gradients.hpp"
#include "src/aero/flow/sweep_model.hpp"

namespace spindrift::aero {

/// Longest side of eight cells and the cube root of their volume; sides as volume over the mean face across. A planar grid has
/// its own two only.
SPINDRIFT_INLINE void measure_cells(const FlowTile& tile, int k, int j, int i, Row& longest_side, Row& width) {
  const TileGeometry& g = *tile.geometry;
  const Row volume = max(Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)), Row(1e-280));
  longest_side = 0.0;
  for (int d = 0; d < tile.directions; ++d) {
    const gas::Face<Row> low = load_face(g, d, k, j, i), high = load_face(g, d, k + (d == 2), j + (d == 1), i + (d == 0));
    longest_side = max(longest_side, volume / (0.5 * (low.area + high.area)));
  }
  width = power(volume, 1.0 / 3.0);
}

/// What any model gives the flow; all that a model without transported quantities has.
template <class Model>
struct ClosuresOf {
  static constexpr int n = Model::equations;

  struct Cell {
    turbulence::Flow<Row> flow;
    turbulence::Turbulence<Row, n> model;
  };
  static SPINDRIFT_INLINE Cell load_cell(const FlowTile& tile, const double* state, const ViscousSetting& s, int k, int j,
                                         int i) {
    const std::ptrdiff_t c = tile.cells.component, g = tile.gradient_box.component;
    const double* at = state + tile.cells.at(k, j, i);
    const double* slope = tile.gradients.data() + tile.gradient_box.at(k, j, i);
    const gas::Primitive<Row> q = gas::load_primitive<Row>(at, std::size_t(c));
    Cell cell;
    const Row T = gas::absolute_temperature(s.gas, q);
    // Lanes beyond the row have no distance; where a grid has no wall it is infinite.
    const Row distance = min(
        max(Row::load(tile.geometry->wall_distance_data.data() + tile.geometry->inner_box.at(k, j, i)), Row(1e-12)), Row(1e12));
    cell.flow.rho = gas::density(s.gas, q), cell.flow.mu = gas::viscosity(s.gas, T), cell.flow.distance = distance;
    cell.flow.u = load_vector(slope, g), cell.flow.v = load_vector(slope + 3 * g, g), cell.flow.w = load_vector(slope + 6 * g, g);
    // Of the pressure's gradient, gamma M^2 times smaller, nothing is kept.
    const gas::Vector<Row> t = load_vector(slope + 9 * g, g);
    const Row factor = -cell.flow.rho / T;
    cell.flow.density_gradient = {factor * t.x, factor * t.y, factor * t.z};
    if constexpr (Model::sees_grid) measure_cells(tile, k, j, i, cell.flow.longest_side, cell.flow.width);
    for (int m = 0; m < n; ++m) {
      cell.model.q[m] = Row::load(at + (mean_unknowns + m) * c);
      cell.model.gradient[m] = load_vector(slope + (12 + 3 * m) * g, g);
    }
    return cell;
  }

  static void closures(FlowTile& tile, const double* state, const ViscousSetting& s) {
    const Model model;
    const std::ptrdiff_t g = tile.gradient_box.component;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; i += row_lanes) {
        const Cell cell = load_cell(tile, state, s, k, j, i);
        const turbulence::Closure<Row, n> closure = model.closure(cell.flow, cell.model);
        double* out = tile.gradients.data() + tile.gradient_box.at(k, j, i) + eddy_component(n) * g;
        closure.eddy_viscosity.store(out);
        closure.pressure.store(out + g);
        for (int m = 0; m < n; ++m) closure.diffusivity[m].store(out + (2 + m) * g);
      }
    });
  }
  static ModelSweeps table() {
    ModelSweeps t;
    t.closures = closures;
    return t;
  }
};

template <class Model>
struct SweepsOf : ClosuresOf<Model> {
  using Base = ClosuresOf<Model>;
  using Base::n, Base::load_cell, typename Base::Cell;

  /// Diffusive fluxes of the model's quantities through the eight faces below the cells at (k, j, i).
  static SPINDRIFT_INLINE void face_fluxes(const FlowTile& tile, const double* state, int d, int k, int j, int i,
                                           Row (&flux)[n]) {
    const TileGeometry& geometry = *tile.geometry;
    const gas::Face<Row> f = load_face(geometry, d, k, j, i);
    const double* x = geometry.centre_data.data() + geometry.cell_box.at(k, j, i);
    const gas::Vector<Row> xl = load_vector(x - geometry.cell_box.stride(d), geometry.cell_box.component),
                           xr = load_vector(x, geometry.cell_box.component);
    gas::Vector<Row> line{xr.x - xl.x, xr.y - xl.y, xr.z - xl.z};
    line.x = select(abs(line.x * f.nx + line.y * f.ny + line.z * f.nz) <= Row(0.0), Row(1.0), line.x);  // lanes beyond the row
    const gas::FaceLine<Row> across = gas::face_line(line, f);
    const double* at = state + tile.cells.at(k, j, i) + mean_unknowns * tile.cells.component;
    const double* slope = tile.gradients.data() + tile.gradient_box.at(k, j, i);
    const std::ptrdiff_t g = tile.gradient_box.component, back = tile.gradient_box.stride(d);
    for (int m = 0; m < n; ++m) {
      const double* q = at + m * tile.cells.component;
      const double* gradient = slope + (12 + 3 * m) * g;
      const double* diffusivity = slope + (eddy_component(n) + 2 + m) * g;
      const gas::Vector<Row> slope_on_face = gas::face_gradient(load_vector(gradient - back, g), load_vector(gradient, g),
                                                                Row::load(q) - Row::load(q - tile.cells.stride(d)), across);
      const Row on_face = 0.5 * (Row::load(diffusivity - back) + Row::load(diffusivity));
      flux[m] = turbulence::diffused(on_face, slope_on_face, f);
    }
  }

  static void residual(FlowTile& tile, const double* state, double* residual, const ViscousSetting& s) {
    const linear::CellBox& box = tile.box;
    const BoxLayout& inner = tile.inner;
    const Model model;
    alignas(64) double row[n][longest_row + 2 * row_lanes];
    for_rows(box, [&](int k, int j) {
      for (int i = 0; i <= box.ni; i += row_lanes) {
        Row flux[n];
        face_fluxes(tile, state, 0, k, j, i, flux);
        for (int m = 0; m < n; ++m) flux[m].store(row[m] + i);
      }
      for (int i = 0; i < box.ni; i += row_lanes) {
        const Cell cell = load_cell(tile, state, s, k, j, i);
        const turbulence::Source<Row, n> source = model.source(cell.flow, cell.model);
        const Row volume = Row::load(tile.geometry->volume_data.data() + tile.geometry->cell_box.at(k, j, i));
        for (int m = 0; m < n; ++m) {
          double* to = residual + inner.at(k, j, i) + (mean_unknowns + m) * inner.component;
          (Row::load(to) + (Row::load(row[m] + i + 1) - Row::load(row[m] + i)) - volume * source.rate[m]).store(to);
        }
      }
    });
    for (int d = 1; d < tile.directions; ++d) {
      const int last = d == 1 ? box.nj : box.nk, others = d == 1 ? box.nk : box.nj;
      for (int a = 0; a < others; ++a)
        for (int b = 0; b <= last; ++b) {
          const int k = d == 1 ? a : b, j = d == 1 ? b : a;
          for (int i = 0; i < box.ni; i += row_lanes) {
            Row flux[n];
            face_fluxes(tile, state, d, k, j, i, flux);
            for (int m = 0; m < n; ++m) {
              double* to = residual + inner.at(k, j, i) + (mean_unknowns + m) * inner.component;
              if (b < last) (Row::load(to) - flux[m]).store(to);
              if (b > 0) (Row::load(to - inner.stride(d)) + flux[m]).store(to - inner.stride(d));
            }
          }
        }
    }
    if constexpr (n == 2) hold_wall_cells(tile, state, residual, s);
  }

  /// What the closure's own layer makes of a first cell: omega [1/s] and k omega [m2/s3].
  struct LawTurbulence {
    double omega = 0.0, k_omega = 0.0;
    /// Of the layer on one wall. A wall where nothing moves has the sublayer's omega.
    static LawTurbulence of(const turbulence::WallLaw& law, const WallCell& cell) {
      const double nu = cell.mu / cell.rho, u = turbulence::friction_velocity(law, cell.speed, cell.distance, nu);
      if (!(u > 0.0)) return {6.0 * nu / (Model::wall_beta * cell.distance * cell.distance), 0.0};
      const double y_plus = u * cell.distance / nu, omega = u * u / nu * law.omega(y_plus);
      return {omega, u * u * law.k(y_plus) * omega};
    }
  };
  /// Whether the cell has a face with a wall function on this side of the tile.
  static bool has_law(const FlowTile& tile, Side side, int k, int j, int i) {
    const int d = direction_of(side), extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk}, at[3] = {i, j, k};
    const auto& law = tile.sides[std::size_t(side)].law;
    if (law.size() == 0 || at[d] != (at_end(side) ? extent[d] - 1 : 0)) return false;
    const auto [a, b] = along(side);
    return law.data()[at[b] * open_row(tile.box, d) + at[a]] > 0.0;
  }
  /// Calls body(k, j, i, density, turbulence of the law) once for each cell at walls with a wall function. In a corner that is
  /// the mean over the cell's faces there, by their areas.
  template <class Body>
  static void for_law_cells(const FlowTile& tile, const double* state, const gas::IdealGas& gas, Body&& body) {
    for (const FlowBoundary& boundary : tile.boundaries) {
      if (!boundary.condition->wall_law) continue;
      const Side side = boundary.where.side;
      for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
        std::array<double, 6> areas{};
        double area = 0.0;
        for (int n = 0; n < 2 * tile.directions; ++n) {
          if (!has_law(tile, Side(n), k, j, i)) continue;
          if (n < int(side)) return;  // the cell's turn was on that side
          areas[std::size_t(n)] = outward_face(*tile.geometry, Side(n), k, j, i).area;
          area += areas[std::size_t(n)];
        }
        LawTurbulence mean;
        double rho = 0.0;
        for (int n = int(side); n < 2 * tile.directions; ++n) {
          if (areas[std::size_t(n)] == 0.0) continue;
          const WallCell cell = wall_cell(tile, state, gas, Side(n), k, j, i);
          const LawTurbulence law = LawTurbulence::of(*tile.wall_law, cell);
          const double share = areas[std::size_t(n)] / area;
          mean.omega += share * law.omega, mean.k_omega += share * law.k_omega, rho = cell.rho;
        }
        body(k, j, i, rho, mean);
      });
    }
  }
  /// In first cells of walls with a wall function omega is the law's, by a source that leaves nothing else, and k is made at the
  /// rate at which the law's own layer destroys it: in the logarithmic layer that is its production, below it diffusion's share
  /// too, so that k is the law's there. With the model's own production, mu_t times the law's slope squared, any k would balance
  /// its destruction.
  static void hold_wall_cells(FlowTile& tile, const double* state, double* residual, const ViscousSetting& s) {
    for_law_cells(tile, state, s.gas, [&](int k, int j, int i, double rho, const LawTurbulence& law) {
      const int row = i / row_lanes * row_lanes;
      const Cell cell = load_cell(tile, state, s, k, j, row);
      const double volume = tile.geometry->volume_data.data()[tile.geometry->cell_box.at(k, j, i)];
      const double q[2] = {cell.model.q[0][i - row], cell.model.q[1][i - row]};
      double* to = residual + tile.inner.at(k, j, i) + mean_unknowns * tile.inner.component;
      const double destroyed = Model::beta_star * rho * (q[0] * q[1] - law.k_omega);
      to[0] += volume * (Model{}.source(cell.flow, cell.model).rate[0][i - row] + destroyed);
      to[tile.inner.component] = volume * rho * law.omega * (q[1] - law.omega);
    });
  }

  /// Upwind convection by the mean of both sides' mass flux, diffusion, source, time; one cell after the other, as it is not
  /// often made.
  static void matrix(FlowTile& tile, const double* state, double cfl, const ImplicitSetting& s) {
    const linear::StencilMatrix<n> a = tile.model<n>();
    const linear::CellBox& box = tile.box;
    const TileGeometry& g = *tile.geometry;
    std::fill_n(tile.turbulence_matrix.data(), tile.turbulence_matrix.size(), 0.0f);
    double unit[2][2] = {{1, 1}, {1, 1}};
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) unit[r][c] = s.scales.model_unknown[std::size_t(c)] / s.scales.model_residual[std::size_t(r)];
    const ViscousSetting viscous{.gas = s.gas};
    for_rows(box, [&](int k, int j) {
      for (int i = 0; i < box.ni; i += row_lanes) {
        const Cell cell = load_cell(tile, state, viscous, k, j, i);
        const turbulence::SourceJacobian<Row, n> source = Model{}.source_jacobian(cell.flow, cell.model);
        const Row volume = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i));
        const Row time =
            cell.flow.rho * (Row::load(tile.rate.data() + tile.inner.at(k, j, i)) * (1.0 / cfl) + volume * s.physical_rate);
        for (int lane = 0; lane < std::min(8, box.ni - i); ++lane) {
          float* block = a.block((std::ptrdiff_t(k) * box.nj + j) * box.ni + i + lane, 0);
          for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c)
              block[c * n + r] = float(unit[r][c] * ((r == c ? time[lane] : 0.0) - volume[lane] * source.m[r][c][lane]));
        }
      }
    });
    if constexpr (n == 2)
      for_rows(box, [&](int k, int j) {
        for (int i = 0; i < box.ni; ++i)
          a.block((std::ptrdiff_t(k) * box.nj + j) * box.ni + i, 0)[0] += float(
              unit[0][0] * growth_damping(tile.residual.data()[tile.inner.at(k, j, i) + mean_unknowns * tile.inner.component],
                                          state[tile.cells.at(k, j, i) + mean_unknowns * tile.cells.component]));
      });
    const int extent[3] = {box.ni, box.nj, box.nk};
    const std::ptrdiff_t aux = tile.gradient_box.component;
    for (int d = 0; d < tile.directions; ++d)
      for (int k = 0; k < box.nk + (d == 2); ++k)
        for (int j = 0; j < box.nj + (d == 1); ++j)
          for (int i = 0; i < box.ni + (d == 0); i += row_lanes) {
            const gas::Face<Row> f = load_face(g, d, k, j, i);
            const double* at = state + tile.cells.at(k, j, i);
            const std::ptrdiff_t step = tile.cells.stride(d), back = tile.gradient_box.stride(d);
            const auto l = gas::load_primitive<Row>(at - step, std::size_t(tile.cells.component)),
                       r = gas::load_primitive<Row>(at, std::size_t(tile.cells.component));
            const Row mass = 0.5 * f.area *
                             (gas::density(s.gas, l) * (gas::normal_velocity(l, f) - f.speed) +
                              gas::density(s.gas, r) * (gas::normal_velocity(r, f) - f.speed));
            const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
            const auto xl = load_vector(x - g.cell_box.stride(d), g.cell_box.component),
                       xr = load_vector(x, g.cell_box.component);
            const Row across = max((xr.x - xl.x) * f.nx + (xr.y - xl.y) * f.ny + (xr.z - xl.z) * f.nz, Row(1e-280));
            const double* diffusivity = tile.gradients.data() + tile.gradient_box.at(k, j, i) + (eddy_component(n) + 2) * aux;
            const int along = d == 0 ? i : d == 1 ? j : k;
            for (int m = 0; m < n; ++m, diffusivity += aux) {
              const Row spread = 0.5 * (Row::load(diffusivity - back) + Row::load(diffusivity)) * f.area / across;
              for (int lane = 0; lane < std::min(8, box.ni + (d == 0) - i); ++lane) {
                const int place = along + (d == 0 ? lane : 0);
                const std::ptrdiff_t right = (std::ptrdiff_t(k) * box.nj + j) * box.ni + i + lane, left = right - box.stride(d);
                const double forward = std::max(mass[lane], 0.0), backward = std::min(mass[lane], 0.0), w = spread[lane];
                const int entry = m * n + m;
                if (place < extent[d]) {  // the face's mass leaves with the left value where forward
                  a.block(right, 0)[entry] += float(unit[m][m] * (-backward + w));
                  a.side(right, 2 * d)[entry] = float(-unit[m][m] * (forward + w));
                }
                if (place > 0) {
                  a.block(left, 0)[entry] += float(unit[m][m] * (forward + w));
                  a.side(left, 2 * d + 1)[entry] = float(unit[m][m] * (backward - w));
                }
              }
            }
          }
    for (const FlowBoundary& boundary : tile.boundaries) {
      const Side side = boundary.where.side;
      for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
        const std::ptrdiff_t cell = (std::ptrdiff_t(k) * box.nj + j) * box.ni + i;
        float *diagonal = a.block(cell, 0), *beyond = a.side(cell, int(side));
        // A resolved wall's ghost has the opposite sign; what an open boundary brings in is given.
        const bool sticks = aero::sticks(*boundary.condition) && !(n == 2 && boundary.condition->wall_law);
        const float follow = sticks ? -1.0f : is_wall(*boundary.condition) ? 1.0f : 0.0f;
        for (int e = 0; e < n * n; ++e) diagonal[e] += follow * beyond[e], beyond[e] = 0.0f;
      });
    }
    if constexpr (n == 2)
      for_law_cells(tile, state, s.gas, [&](int k, int j, int i, double rho, const LawTurbulence& law) {
        const std::ptrdiff_t cell = (std::ptrdiff_t(k) * box.nj + j) * box.ni + i;
        a.block(cell, a.diagonal)[1] = 0.0f;
        for (int side = 0; side < 2 * tile.directions; ++side) a.side(cell, side)[1] = a.side(cell, side)[3] = 0.0f;
        const double volume = g.volume_data.data()[g.cell_box.at(k, j, i)];
        const double time = tile.rate.data()[tile.inner.at(k, j, i)] / cfl + volume * s.physical_rate;
        a.block(cell, 0)[3] = float(unit[1][1] * rho * (time + volume * law.omega));
      });
  }

  static void multiply(FlowTile& tile, const float* x, float* y) {
    const BoxLayout& box = tile.gradient_box;
    linear::multiply(tile.model<n>(), x, {box.origin, box.row, box.plane, box.component}, y);
  }
  static void wall(const double* inside, double nu, double distance, double* ghost) {
    const auto on_wall = Model{}.wall(distance, nu);
    for (int m = 0; m < n; ++m) ghost[m] = 2.0 * on_wall[std::size_t(m)] - inside[m];
  }
  static std::array<double, 2> far_field(double nu, double speed, double sound_speed) {
    std::array<double, 2> all{};
    const auto values = Model{}.far_field(nu, speed, sound_speed);
    for (std::size_t m = 0; m < std::size_t(n); ++m) all[m] = values[m];
    return all;
  }
  static const turbulence::WallLaw& wall_law() {
    static const turbulence::WallLaw law = turbulence::WallLayer<Model>().law();
    return law;
  }
  static ModelSweeps table() {
    ModelSweeps t = Base::table();
    t.equations = n, t.residual = residual, t.matrix = matrix, t.multiply = multiply, t.wall = wall, t.far_field = far_field,
    t.wall_law = wall_law;
    const gas::Vector<double> none{0.0, 0.0, 0.0};
    turbulence::Turbulence<double, n> still{};  // on the wall: nothing but what makes the model's quotients defined
    if constexpr (n == 2) still.q[1] = 1.0;
    const auto closure = Model{}.closure(turbulence::Flow<double>{1.0, 1.0, 1.0, none, none, none}, still);
    for (std::size_t m = 0; m < std::size_t(n); ++m) t.lowest[m] = Model::lowest[m], t.wall_spread[m] = closure.diffusivity[m];
    return t;
  }
};

/// Keys of a closure that transports one quantity, and of one that transports k too.
inline std::vector<std::string> one_equation_keys() { return {"wall_distance", "wind_eddy_viscosity"}; }
inline std::vector<std::string> two_equation_keys() { return {"wall_distance", "wind_eddy_viscosity", "wind_intensity"}; }

}  // namespace spindrift::aero
