// MUSCL over a piece of a row, one function per limiter; without one it knows the sizes of cells. SPDX-License-Identifier:
// Apache-2.0
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {

namespace {

template <class Limiter, bool even_velocity = false>
void reconstruct_row(const gas::IdealGas& gas, const double* at, std::ptrdiff_t step, std::ptrdiff_t component,
                     const double* volume, std::ptrdiff_t volume_step, int turbulence, int count, FacePiece& states) {
  for (int n = 0; n < count; n += row_lanes, at += row_lanes) {
    const auto load = [&](std::ptrdiff_t offset) { return gas::load_primitive<Row>(at + offset, std::size_t(component)); };
    const auto s = [&] {
      if constexpr (std::same_as<Limiter, gas::Unlimited>) {
        // Neighbours share a face, so their volumes are to each other as their sizes across it.
        const auto size = [&](int cell) { return max(Row::load(volume + n + cell * volume_step), Row(1e-280)); };
        return gas::muscl_by_size<even_velocity>(gas, std::array<Row, 4>{size(-2), size(-1), size(0), size(1)}, load(-2 * step),
                                                 load(-step), load(0), load(step));
      } else {
        return gas::muscl(gas, Limiter{}, load(-2 * step), load(-step), load(0), load(step));
      }
    }();
    gas::store_primitive(states.left[0] + n, piece, s.l);
    gas::store_primitive(states.right[0] + n, piece, s.r);
    // Always limited: what turbulence carries must not overshoot below zero at the edge of a layer.
    for (int t = mean_unknowns; t < mean_unknowns + turbulence; ++t) {
      const double* from = at + t * component;
      const Row b = Row::load(from - 2 * step), l = Row::load(from - step), r = Row::load(from), a = Row::load(from + step);
      gas::reconstruct(gas::Minmod{}, b, l, r).store(states.left[t] + n);
      gas::reconstruct(gas::Minmod{}, a, r, l).store(states.right[t] + n);
    }
  }
}

/// No reconstruction: first order.
struct FirstOrder {
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real&, const Real&) const {
    return Real(0.0);
  }
};

}  // namespace

Reconstructions reconstructions(std::string_view limiter) {
  constexpr auto both = [](Reconstruction function) { return Reconstructions{function, function}; };
  static constexpr std::pair<std::string_view, Reconstructions> list[] = {
      {gas::VanAlbada::name, both(reconstruct_row<gas::VanAlbada>)},
      {gas::VanLeer::name, both(reconstruct_row<gas::VanLeer>)},
      {gas::Minmod::name, both(reconstruct_row<gas::Minmod>)},
      {gas::Unlimited::name, {reconstruct_row<gas::Unlimited>, reconstruct_row<gas::Unlimited, true>}},
      {"first_order", both(reconstruct_row<FirstOrder>)},
  };
  for (const auto& [name, functions] : list)
    if (name == limiter) return functions;
  throw std::invalid_argument("no limiter is named \"" + std::string(limiter) + "\"");
}

}  // namespace spindrift::aero
