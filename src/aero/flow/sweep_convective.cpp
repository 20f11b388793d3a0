// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_convective.hpp"

#include "kernels/turbulence/model.hpp"

namespace spindrift::aero {

namespace {

/// Both states of the mean flow move towards their mean.
void draw_together(double share, int count, FacePiece& states) {
  const Row near = 0.5 * (1.0 + share), far = 0.5 * (1.0 - share);
  for (int c = 0; c < mean_unknowns; ++c)
    for (int n = 0; n < count; n += row_lanes) {
      const Row l = Row::load(states.left[c] + n), r = Row::load(states.right[c] + n);
      (near * l + far * r).store(states.left[c] + n);
      (near * r + far * l).store(states.right[c] + n);
    }
}

/// Behind a wall with a wall function the ghost turns the velocity about, for the wall stands still: a kink that is there on a
/// resolved sublayer only. A first cell in the logarithmic layer has the slope of the cells beyond it. Of one face: the state of
/// the cell between the wall and the face, where `mask` is 1.
void straighten(double* state_of_face, const double* cell, std::ptrdiff_t inward, double half, double mask) {
  if (mask > 0.0) *state_of_face = *cell + half * (cell[inward] - *cell);
}

/// The same for the faces of a piece that lie one cell off a wall with a wall function.
void straighten_at_walls(const FlowTile& tile, const double* state, int d, int k, int j, int i, int count, double half,
                         FacePiece& states) {
  const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk}, at[3] = {i, j, k};
  const std::ptrdiff_t step = tile.cells.stride(d);
  for (const int end : {0, 1}) {
    const auto& law = tile.sides[std::size_t(2 * d + end)].law;
    const int face = end == 0 ? 1 : extent[d] - 1;
    if (law.size() == 0 || extent[d] < 2) continue;
    double(&side)[mean_unknowns + 2][piece] = end == 0 ? states.left : states.right;
    const std::ptrdiff_t row = open_row(tile.box, d), to_cell = end == 0 ? -step : 0, inward = end == 0 ? step : -step;
    for (int c = 1; c <= 3; ++c) {
      const double* cell = state + c * tile.cells.component + tile.cells.at(k, j, i) + to_cell;
      if (d == 0) {
        if (face >= i && face < i + count)
          straighten(&side[c][face - i], cell + (face - i), inward, half, law.data()[k * row + j]);
      } else if (at[d] == face) {
        const double* mask = law.data() + (d == 1 ? k : j) * row + i;
        for (int n = 0; n < count; ++n) straighten(&side[c][n], cell + n, inward, half, mask[n]);
      }
    }
  }
}

/// Whether faces from (k, j, i) on are of rows along a wall.
bool along_wall(const FlowTile& tile, int d, int k, int j) {
  if (d == 0) return tile.along_wall[0];
  const int face = d == 1 ? j : k, last = d == 1 ? tile.box.nj : tile.box.nk;
  return face == 0      ? tile.ends_along_wall[std::size_t(2 * d)]
         : face == last ? tile.ends_along_wall[std::size_t(2 * d + 1)]
                        : tile.along_wall[std::size_t(d)];
}

/// Fluxes of all unknowns through `count` faces from (k, j, i) on, into out[c stride + n].
void fluxes(const FlowTile& tile, const double* state, int d, int k, int j, int i, int count, const ConvectiveSetting& s,
            double* out, std::ptrdiff_t stride) {
  FacePiece states;
  const Reconstruction reconstruct = along_wall(tile, d, k, j) ? s.reconstruct.along_wall : s.reconstruct.plain;
  reconstruct(s.gas, state + tile.cells.at(k, j, i), tile.cells.stride(d), tile.cells.component,
              tile.geometry->volume_data.data() + tile.geometry->cell_box.at(k, j, i), tile.geometry->cell_box.stride(d),
              tile.turbulence, count, states);
  straighten_at_walls(tile, state, d, k, j, i, count, s.law_slope, states);
  if (s.upwinding < 1.0) draw_together(s.upwinding, count, states);
  s.flux(s.gas, *tile.geometry, d, k, j, i, count, states, out, stride);
  if (s.first_order_model) {
    const std::ptrdiff_t step = tile.cells.stride(d);
    const double* at = state + tile.cells.at(k, j, i);
    for (int t = mean_unknowns; t < mean_unknowns + tile.turbulence; ++t)
      for (int n = 0; n < count; n += row_lanes) {
        const double* cell = at + t * tile.cells.component + n;
        turbulence::convected(Row::load(out + n), Row::load(cell - step), Row::load(cell)).store(out + t * stride + n);
      }
    return;
  }
  for (int t = mean_unknowns; t < mean_unknowns + tile.turbulence; ++t)
    for (int n = 0; n < count; n += row_lanes)
      turbulence::convected(Row::load(out + n), Row::load(states.left[t] + n), Row::load(states.right[t] + n))
          .store(out + t * stride + n);
}

}  // namespace

void sweep_convective(FlowTile& tile, const double* state, double* residual, const ConvectiveSetting& s) {
  const linear::CellBox& box = tile.box;
  const BoxLayout& inner = tile.inner;
  const int unknowns = tile.unknowns();
  constexpr std::ptrdiff_t stride = longest_row + 2 * row_lanes;
  alignas(64) double row[mean_unknowns + 2][stride];
  for_rows(box, [&](int k, int j) {  // faces across i: the flux of a row, then its differences
    for (int i = 0; i <= box.ni; i += piece)
      fluxes(tile, state, 0, k, j, i, std::min(piece, box.ni + 1 - i), s, row[0] + i, stride);
    const std::ptrdiff_t place = k * open_row(box, 0) + j;
    for (const int end : {0, 1})
      if (const auto& open = tile.sides[std::size_t(end)].open; open.size() > 0)
        for (int c = 0; c < unknowns; ++c) row[c][end * box.ni] *= open.data()[place];
    for (const int end : {0, 1})
      if (auto& through = tile.sides[std::size_t(end)].through; through.size() > 0) through.data()[place] = row[0][end * box.ni];
    double* out = residual + inner.at(k, j, 0);
    for (int c = 0; c < unknowns; ++c)
      for (int i = 0; i < box.ni; i += row_lanes)
        (Row::load(row[c] + i + 1) - Row::load(row[c] + i)).store(out + c * inner.component + i);
  });
  alignas(64) double flux[mean_unknowns + 2][piece];
  for (int d = 1; d < tile.directions; ++d) {
    const int last = d == 1 ? box.nj : box.nk, others = d == 1 ? box.nk : box.nj;
    for (int m = 0; m < others; ++m)
      for (int n = 0; n <= last; ++n) {
        const int k = d == 1 ? m : n, j = d == 1 ? n : m;
        const auto& open = tile.sides[std::size_t(2 * d + (n == last ? 1 : 0))].open;
        auto& through = tile.sides[std::size_t(2 * d + (n == last ? 1 : 0))].through;
        const bool kept = (n == 0 || n == last) && through.size() > 0;
        const bool masked = (n == 0 || n == last) && open.size() > 0;
        for (int first = 0; first < box.ni; first += piece) {
          const int count = std::min(piece, box.ni - first);
          fluxes(tile, state, d, k, j, first, count, s, flux[0], piece);
          double* out = residual + inner.at(k, j, first);
          for (int c = 0; c < unknowns; ++c, out += inner.component)
            for (int i = 0; i < count; i += row_lanes) {
              Row f = Row::load(flux[c] + i);
              if (masked) f *= Row::load(open.data() + m * open_row(box, d) + first + i);
              if (kept && c == 0) f.store(through.data() + m * open_row(box, d) + first + i);
              if (n < last) (Row::load(out + i) - f).store(out + i);
              if (n > 0) (Row::load(out + i - inner.stride(d)) + f).store(out + i - inner.stride(d));
            }
        }
      }
  }
}

}  // namespace spindrift::aero
