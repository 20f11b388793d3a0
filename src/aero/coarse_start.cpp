// SPDX-License-Identifier: Apache-2.0
#include "src/aero/coarse_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kernels/base/failure.hpp"

namespace spindrift::aero {

namespace {

int halved(int n, int step, int least) { return std::max(least, (n / 2 + step - 1) / step * step); }

/// Place of the middle of cell `n` of `fine` cells among `coarse` ones, counted from the middle of the first.
double place(int n, int fine, int coarse) { return (n + 0.5) * coarse / fine - 0.5; }

/// The two cells on both sides of a place, and the share of the second.
struct Between {
  int low = 0, high = 0;
  double share = 0.0;
};
Between between(double at, int first, int last) {
  at = std::clamp(at, double(first), double(last));
  const int low = std::min(int(at), std::max(first, last - 1));
  return {low, std::min(low + 1, last), at - low};
}

/// Cell values of the blocks of a rotor, component by component.
struct BlockValues {
  int ni = 0, nj = 0, nk = 0;
  std::vector<double> data;
  std::size_t at(int c, int k, int j, int i) const {
    return ((std::size_t(c) * std::size_t(nk) + std::size_t(k)) * std::size_t(nj) + std::size_t(j)) * std::size_t(ni) +
           std::size_t(i);
  }
};

template <class Body>
void for_cells(const ResolvedRotor& rotor, const FlowTile& tile, Body&& body) {
  const Tile& from = rotor.tiling().tiles[std::size_t(tile.index)];
  for (int k = 0; k < tile.box.nk; ++k)
    for (int j = 0; j < tile.box.nj; ++j)
      for (int i = 0; i < tile.box.ni; ++i) body(from.block, from.to_block({i, j, k}), tile.cells.at(k, j, i));
}

}  // namespace

ResolvedRotorSetup coarser(const ResolvedRotorSetup& setup) {
  ResolvedRotorSetup s = setup;
  RotorGridOptions& g = s.grid;
  g.resolution *= 0.5;
  const auto half = [](std::optional<int>& n, int step, int least) {
    if (n) n = halved(*n, step, least);
  };
  half(g.cells_round, 4, 24), half(g.cells_trailing_edge, 2, 2), half(g.cells_layers, 1, 4), half(g.cells_span, 1, 4);
  half(g.cells_outboard, 1, 3), half(g.cells_beside, 1, 2), half(g.cells_upstream, 1, 2), half(g.cells_downstream, 1, 2);
  for (std::optional<double>* h : {&g.first_cell_chords, &g.first_cell_m, &g.y_plus})
    if (*h) **h *= 2.0;
  return s;
}

void interpolate(const ResolvedRotor& from, ResolvedRotor& to) {
  const std::vector<Block>&coarse = from.grid().blocks, &fine = to.grid().blocks;
  std::vector<BlockValues> values(coarse.size());
  const int unknowns = from.solver().tiles().empty() ? 0 : from.solver().tiles()[0].unknowns();
  for (std::size_t b = 0; b < coarse.size(); ++b) {
    values[b].ni = coarse[b].ni, values[b].nj = coarse[b].nj, values[b].nk = coarse[b].nk;
    values[b].data.resize(std::size_t(unknowns) * std::size_t(coarse[b].ni) * std::size_t(coarse[b].nj) *
                          std::size_t(coarse[b].nk));
  }
  for (const FlowTile& tile : from.solver().tiles())
    for_cells(from, tile, [&](int block, const Index& cell, std::ptrdiff_t at) {
      BlockValues& v = values[std::size_t(block)];
      for (int c = 0; c < unknowns; ++c)
        v.data[v.at(c, cell[2], cell[1], cell[0])] = tile.state.data()[c * tile.cells.component + at];
    });
  for (FlowTile& tile : to.solver().tiles())
    for_cells(to, tile, [&](int block, const Index& cell, std::ptrdiff_t at) {
      const Block& f = fine[std::size_t(block)];
      const BlockValues& v = values[std::size_t(block)];
      const Between i = between(place(cell[0], f.ni, v.ni), 0, v.ni - 1), j = between(place(cell[1], f.nj, v.nj), 0, v.nj - 1);
      // Blocks from the hub on have the tip at the same share of their own cells only; those of the plug begin there.
      const int span = f.nk == to.radial_cells() ? to.span_cells() : 0, coarse_span = span > 0 ? from.span_cells() : 0;
      const Between k =
          cell[2] < span ? between(place(cell[2], span, coarse_span), 0, coarse_span - 1)
                         : between(coarse_span + place(cell[2] - span, f.nk - span, v.nk - coarse_span), coarse_span, v.nk - 1);
      for (int c = 0; c < unknowns; ++c) {
        const auto along_i = [&](int kk, int jj) {
          return (1.0 - i.share) * v.data[v.at(c, kk, jj, i.low)] + i.share * v.data[v.at(c, kk, jj, i.high)];
        };
        const auto along_j = [&](int kk) { return (1.0 - j.share) * along_i(kk, j.low) + j.share * along_i(kk, j.high); };
        tile.state.data()[c * tile.cells.component + at] = (1.0 - k.share) * along_j(k.low) + k.share * along_j(k.high);
      }
    });
  to.solver().forget();
}

RotorLoad start_from_coarser(const ResolvedRotorSetup& setup, int steps, ResolvedRotor& fine) {
  ResolvedRotorSetup first = coarser(setup);
  first.flow.max_pseudo_steps = steps, first.flow.coarse_steps = 0;
  ResolvedRotor coarse(first);
  coarse.solver().start_uniform();
  coarse.prepare(MPI_COMM_SELF);
  coarse.run();
  const March& march = coarse.solver().march();
  if (march.verdict() == Verdict::failed)
    throw NumericalFailure(
        fmt::format("aero: on the coarser grid of the start (aero.flow.coarse_steps): {} (pseudo-step {}, CFL {:.3g}){}",
                    march.why(), march.steps(), march.cfl(), coarse.solver().trouble()),
        "aero/rotor", march.steps(), 0.0);
  interpolate(coarse, fine);
  return coarse.load();
}

}  // namespace spindrift::aero
