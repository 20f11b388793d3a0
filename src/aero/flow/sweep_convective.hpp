// The convective part of a tile's residual: MUSCL states, the flux scheme, and what the turbulence model's unknowns are carried by the
// mass flux; rows of eight cells. Faces of walls are left out (FlowTile::open): boundary.cpp adds their pressure.
// Each scheme and limiter is a function of its own (convective_*.cpp), chosen once per task. docs/theory/air.md, "Convection".
// Tested in tests/src/aero/flow/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

struct ConvectiveSetting {
  gas::IdealGas gas;
  gas::Primitive<double> smooth{};  ///< differences that no limiter touches
};

using ConvectiveSweep = void (*)(FlowTile& tile, const double* state, double* residual, const ConvectiveSetting& setting);

/// The sweep of a flux and a limiter by their names; the names must be among those of the options.
ConvectiveSweep convective_sweep(std::string_view flux, std::string_view limiter);

namespace detail {

/// Flux of the mean flow and, in `carried`, of the turbulence unknowns through the eight faces below the cells at `at`.
template <class Flux, class Limiter>
SPINDRIFT_INLINE gas::Conserved<Row> face_flux(const FlowTile& tile, const double* at, std::ptrdiff_t step, const gas::Face<Row>& f,
                                               const ConvectiveSetting& s, Row carried[2]) {
  const std::size_t component = std::size_t(tile.cells.component);
  const auto before = gas::load_primitive<Row>(at - 2 * step, component), left = gas::load_primitive<Row>(at - step, component),
             right = gas::load_primitive<Row>(at, component), after = gas::load_primitive<Row>(at + step, component);
  const auto states = gas::muscl(s.gas, Limiter{}, before, left, right, after, s.smooth);
  const gas::Conserved<Row> flux = Flux{}(s.gas, states.l, states.r, f);
  const auto forward = flux.rho > Row(0.0);
  for (int t = 0; t < tile.turbulence; ++t) {
    const double* from = at + std::ptrdiff_t(component) * (mean_unknowns + t);
    const Row b = Row::load(from - 2 * step), l = Row::load(from - step), r = Row::load(from), a = Row::load(from + step);
    const gas::VanAlbada limiter;
    carried[t] = flux.rho * select(forward, gas::reconstruct(limiter, b, l, r, 0.0), gas::reconstruct(limiter, a, r, l, 0.0));
  }
  return flux;
}

SPINDRIFT_INLINE void scaled(gas::Conserved<Row>& flux, Row carried[2], const Row& by) {
  flux = {flux.rho * by, flux.mx * by, flux.my * by, flux.mz * by, flux.E * by};
  carried[0] *= by, carried[1] *= by;
}

/// residual[at] += sign flux for all unknowns.
SPINDRIFT_INLINE void add_flux(double* at, std::ptrdiff_t component, const gas::Conserved<Row>& flux, const Row carried[2],
                               int turbulence, double sign) {
  const auto add = [&](int c, const Row& value) {
    double* to = at + c * component;
    (Row::load(to) + Row(sign) * value).store(to);
  };
  add(0, flux.rho), add(1, flux.mx), add(2, flux.my), add(3, flux.mz), add(4, flux.E);
  for (int t = 0; t < turbulence; ++t) add(mean_unknowns + t, carried[t]);
}

}  // namespace detail

/// residual = sum of fluxes out of each cell [in the units of conserved amounts per second].
template <class Flux, class Limiter>
void sweep_convective(FlowTile& tile, const double* state, double* residual, const ConvectiveSetting& s) {
  const TileGeometry& g = *tile.geometry;
  const linear::CellBox& box = tile.box;
  const BoxLayout& inner = tile.inner;
  const int unknowns = tile.unknowns();
  alignas(64) double row[mean_unknowns + 2][longest_row + 2 * row_lanes];
  for_rows(box, [&](int k, int j) {  // faces across i: the flux of a row, then its differences
    const double* at = state + tile.cells.at(k, j, 0);
    for (int i = 0; i <= box.ni; i += row_lanes) {
      Row carried[2] = {0.0, 0.0};
      const gas::Face<Row> f = load_face(g, 0, k, j, i);
      const gas::Conserved<Row> flux = detail::face_flux<Flux, Limiter>(tile, at + i, 1, f, s, carried);
      gas::store_conserved(row[0] + i, std::size_t(row[1] - row[0]), flux);
      for (int t = 0; t < tile.turbulence; ++t) carried[t].store(row[mean_unknowns + t] + i);
    }
    const std::ptrdiff_t place = k * open_row(box, 0) + j;
    for (const int end : {0, 1})
      if (const auto& open = tile.open[std::size_t(end)]; open.size() > 0)
        for (int c = 0; c < unknowns; ++c) row[c][end * box.ni] *= open.data()[place];
    double* out = residual + inner.at(k, j, 0);
    for (int c = 0; c < unknowns; ++c)
      for (int i = 0; i < box.ni; i += row_lanes)
        (Row::load(row[c] + i + 1) - Row::load(row[c] + i)).store(out + c * inner.component + i);
  });
  for (int d = 1; d < tile.directions; ++d) {
    const int last = d == 1 ? box.nj : box.nk, others = d == 1 ? box.nk : box.nj;
    const std::ptrdiff_t step = tile.cells.stride(d), inner_step = inner.stride(d);
    for (int m = 0; m < others; ++m)
      for (int n = 0; n <= last; ++n) {
        const int k = d == 1 ? m : n, j = d == 1 ? n : m;
        const double* at = state + tile.cells.at(k, j, 0);
        double* out = residual + inner.at(k, j, 0);
        const auto& open = tile.open[std::size_t(2 * d + (n == last ? 1 : 0))];
        const bool masked = (n == 0 || n == last) && open.size() > 0;
        for (int i = 0; i < box.ni; i += row_lanes) {
          Row carried[2] = {0.0, 0.0};
          const gas::Face<Row> f = load_face(g, d, k, j, i);
          gas::Conserved<Row> flux = detail::face_flux<Flux, Limiter>(tile, at + i, step, f, s, carried);
          if (masked) detail::scaled(flux, carried, Row::load(open.data() + m * open_row(box, d) + i));
          if (n < last) detail::add_flux(out + i, inner.component, flux, carried, tile.turbulence, -1.0);
          if (n > 0) detail::add_flux(out + i - inner_step, inner.component, flux, carried, tile.turbulence, 1.0);
        }
      }
  }
}

/// The sweep of one flux with the limiter of that name; one per scheme, each in a file of its own, to share out their compilation.
template <class Flux>
ConvectiveSweep sweep_of_limiter(std::string_view limiter) {
  if (limiter == gas::VanAlbada::name) return sweep_convective<Flux, gas::VanAlbada>;
  if (limiter == gas::VanLeer::name) return sweep_convective<Flux, gas::VanLeer>;
  if (limiter == gas::Minmod::name) return sweep_convective<Flux, gas::Minmod>;
  return sweep_convective<Flux, gas::Unlimited>;
}
ConvectiveSweep convective_roe_low_mach(std::string_view limiter);
ConvectiveSweep convective_roe(std::string_view limiter);
ConvectiveSweep convective_osher(std::string_view limiter);
ConvectiveSweep convective_osher_reversed(std::string_view limiter);
ConvectiveSweep convective_rusanov(std::string_view limiter);

}  // namespace spindrift::aero
