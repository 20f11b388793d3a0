// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_viscous.hpp"

#include "src/aero/flow/sweep_gradients.hpp"
#include "src/aero/flow/sweep_model.hpp"

namespace spindrift::aero {

namespace {

template <class Real>
SPINDRIFT_INLINE gas::Vector<Real> load3(const double* at, std::ptrdiff_t component) {
  return {gas::load_number<Real>(at), gas::load_number<Real>(at + component), gas::load_number<Real>(at + 2 * component)};
}
template <class Real>
SPINDRIFT_INLINE gas::Gradients<Real> load_gradients(const double* at, std::ptrdiff_t c) {
  return {load3<Real>(at, c), load3<Real>(at + 3 * c, c), load3<Real>(at + 6 * c, c), load3<Real>(at + 9 * c, c)};
}

/// Laminar flux through the face between the cells at `left` and `right` (places in cells, gradients and centres).
template <class Real>
struct Pair {
  const double *state, *gradients, *centres;
  std::ptrdiff_t step, gradient_step, centre_step;  ///< from left to right
};
template <class Real>
SPINDRIFT_INLINE gas::Conserved<Real> face_flux(const FlowTile& tile, const Pair<Real>& p, const gas::Face<Real>& f,
                                                const ViscousSetting& s) {
  const std::size_t component = std::size_t(tile.cells.component);
  const std::ptrdiff_t centre_component = tile.geometry->cell_box.component, gradient_component = tile.gradient_box.component;
  const gas::Primitive<Real> l = gas::load_primitive<Real>(p.state - p.step, component),
                             r = gas::load_primitive<Real>(p.state, component);
  const gas::Vector<Real> xl = load3<Real>(p.centres - p.centre_step, centre_component),
                          xr = load3<Real>(p.centres, centre_component);
  gas::Vector<Real> d{xr.x - xl.x, xr.y - xl.y, xr.z - xl.z};
  if constexpr (!std::is_arithmetic_v<Real>) d.x = select(abs(d.x * f.nx + d.y * f.ny + d.z * f.nz) <= Real(0.0), Real(1.0), d.x);
  const gas::FaceLine<Real> line = gas::face_line(d, f);
  const gas::Primitive<Real> q = 0.5 * (l + r);
  Real eddy(0.0), pressure(0.0);
  if (tile.eddies) {
    const double* closure = p.gradients + eddy_component(tile.turbulence) * gradient_component;
    eddy = 0.5 * (gas::load_number<Real>(closure - p.gradient_step) + gas::load_number<Real>(closure));
    closure += gradient_component;
    pressure = 0.5 * (gas::load_number<Real>(closure - p.gradient_step) + gas::load_number<Real>(closure));
  }
  const gas::Transport<Real> t = gas::transport(s.gas, gas::viscosity(s.gas, gas::absolute_temperature(s.gas, q)), eddy);
  const gas::Gradients<Real> g =
      s.thin_layer ? gas::thin_layer_gradients(l, r, line)
                   : gas::face_gradients(load_gradients<Real>(p.gradients - p.gradient_step, gradient_component),
                                         load_gradients<Real>(p.gradients, gradient_component), l, r, line);
  return gas::viscous_flux(t, g, q.u, q.v, q.w, f, pressure);
}

template <class Real>
SPINDRIFT_INLINE Pair<Real> pair_at(const FlowTile& tile, const double* state, int d, int k, int j, int i) {
  const BoxLayout& centres = tile.geometry->cell_box;
  return {state + tile.cells.at(k, j, i),
          tile.gradients.data() + tile.gradient_box.at(k, j, i),
          tile.geometry->centre_data.data() + centres.at(k, j, i),
          tile.cells.stride(d),
          tile.gradient_box.stride(d),
          centres.stride(d)};
}

}  // namespace

void sweep_viscous(FlowTile& tile, const double* state, double* residual, const ViscousSetting& s) {
  const TileGeometry& g = *tile.geometry;
  const linear::CellBox& box = tile.box;
  const BoxLayout& inner = tile.inner;
  alignas(64) double row[mean_unknowns][longest_row + 2 * row_lanes];
  for_rows(box, [&](int k, int j) {
    for (int i = 0; i <= box.ni; i += row_lanes)
      gas::store_conserved(row[0] + i, std::size_t(row[1] - row[0]),
                           face_flux(tile, pair_at<Row>(tile, state, 0, k, j, i), load_face(g, 0, k, j, i), s));
    double* out = residual + inner.at(k, j, 0);
    for (int c = 1; c < mean_unknowns; ++c)
      for (int i = 0; i < box.ni; i += row_lanes) {
        double* to = out + c * inner.component + i;
        (Row::load(to) + (Row::load(row[c] + i + 1) - Row::load(row[c] + i))).store(to);
      }
  });
  for (int d = 1; d < tile.directions; ++d) {
    const int last = d == 1 ? box.nj : box.nk, others = d == 1 ? box.nk : box.nj;
    for (int m = 0; m < others; ++m)
      for (int n = 0; n <= last; ++n) {
        const int k = d == 1 ? m : n, j = d == 1 ? n : m;
        double* out = residual + inner.at(k, j, 0);
        for (int i = 0; i < box.ni; i += row_lanes) {
          const gas::Conserved<Row> flux = face_flux(tile, pair_at<Row>(tile, state, d, k, j, i), load_face(g, d, k, j, i), s);
          const auto add = [&](double* at, double sign) {
            const Row values[4] = {flux.mx, flux.my, flux.mz, flux.E};
            for (int c = 1; c < mean_unknowns; ++c) {
              double* to = at + c * inner.component;
              (Row::load(to) + Row(sign) * values[c - 1]).store(to);
            }
          };
          if (n < last) add(out + i, -1.0);
          if (n > 0) add(out + i - inner.stride(d), 1.0);
        }
      }
  }
}

gas::Conserved<double> wall_friction(const FlowTile& tile, const double* state, const ViscousSetting& s, Side side, int k, int j,
                                     int i) {
  const int d = direction_of(side), end = at_end(side) ? 1 : 0;
  const int fk = k + end * (d == 2), fj = j + end * (d == 1), fi = i + end * (d == 0);
  const gas::Conserved<double> flux =
      face_flux(tile, pair_at<double>(tile, state, d, fk, fj, fi), face_at(*tile.geometry, d, fk, fj, fi), s);
  return end == 1 ? flux : -1.0 * flux;  // out of the flow
}

}  // namespace spindrift::aero
