// Flux schemes over a piece of a row, one function per scheme. SPDX-License-Identifier: Apache-2.0
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "kernels/gas/flux_osher.hpp"
#include "kernels/gas/flux_roe.hpp"
#include "kernels/gas/flux_roe_low_mach.hpp"
#include "kernels/gas/flux_rusanov.hpp"
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {

namespace {

template <class Flux>
void flux_row(const gas::IdealGas& gas, const TileGeometry& geometry, int d, int k, int j, int i, int count,
              const FacePiece& states, double* out, std::ptrdiff_t stride) {
  constexpr bool tangential = requires { Flux::sees_tangential_speed; };
  const bool moving = tangential && geometry.moving();
  for (int n = 0; n < count; n += row_lanes) {
    gas::Face<Row> face = load_face(geometry, d, k, j, i + n);
    if (moving) add_grid_velocity(geometry, d, k, j, i + n, face);
    const auto l = gas::load_primitive<Row>(states.left[0] + n, piece), r = gas::load_primitive<Row>(states.right[0] + n, piece);
    gas::store_conserved(out + n, std::size_t(stride), Flux{}(gas, l, r, face));
  }
}

}  // namespace

RowFlux row_flux(std::string_view flux) {
  static constexpr std::pair<std::string_view, RowFlux> list[] = {
      {"osher", flux_row<gas::Osher<gas::OsherOrder::physical>>},
      {"osher_inverse", flux_row<gas::Osher<gas::OsherOrder::inverse>>},
      {gas::Roe::name, flux_row<gas::Roe>},
      {gas::RoeLowMach::name, flux_row<gas::RoeLowMach>},
      {gas::Rusanov::name, flux_row<gas::Rusanov>},
  };
  for (const auto& [name, function] : list)
    if (name == flux) return function;
  throw std::invalid_argument("no flux is named \"" + std::string(flux) + "\"");
}

}  // namespace spindrift::aero
