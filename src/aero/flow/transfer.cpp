// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/exchange.hpp"

namespace spindrift::aero {

namespace {

/// The two cells whose line a value lies on, and the share of the second: outside of 0 to 1 beyond the outermost middles.
struct Between {
  int low = 0, high = 0;
  double share = 0.0;
};

/// `at`: in cells from the first node.
Between between(double at, int cells) {
  at -= 0.5;
  const int low = std::clamp(int(std::floor(at)), 0, std::max(0, cells - 2));
  return {low, std::min(low + 1, cells - 1), cells > 1 ? at - low : 0.0};
}

/// Cell values of a block, component by component.
struct BlockValues {
  Index cells{};
  std::vector<double> data;
  std::size_t at(int c, const Index& n) const {
    return ((std::size_t(c) * std::size_t(cells[2]) + std::size_t(n[2])) * std::size_t(cells[1]) + std::size_t(n[1])) *
               std::size_t(cells[0]) +
           std::size_t(n[0]);
  }
};

/// body(block, cell of the block, place of the cell in the tile's state)
template <class Body>
void for_cells(const Tiling& tiling, const FlowTile& tile, Body&& body) {
  const Tile& t = tiling.tiles[std::size_t(tile.index)];
  for (int k = 0; k < tile.box.nk; ++k)
    for (int j = 0; j < tile.box.nj; ++j)
      for (int i = 0; i < tile.box.ni; ++i) body(t.block, t.to_block({i, j, k}), tile.cells.at(k, j, i));
}

}  // namespace

void transfer(const FlowSolver& from, FlowSolver& to, const CellPlace& place, MPI_Comm comm) {
  const Tiling &coarse = from.grid().tiling(), &fine = to.grid().tiling();
  const int unknowns = from.unknowns();
  std::vector<BlockValues> values(coarse.block_cells.size());
  std::vector<std::array<std::vector<Between>, 3>> neighbours(values.size());
  for (std::size_t b = 0; b < values.size(); ++b) {
    const Index& n = values[b].cells = coarse.block_cells[b];
    values[b].data.resize(std::size_t(unknowns) * std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]));
    for (std::size_t d = 0; d < 3; ++d) {
      const int cells = fine.block_cells[b][d];
      for (int i = 0; i < cells; ++i)
        neighbours[b][d].push_back(between(place ? place(int(b), int(d), i) : (i + 0.5) * n[d] / cells, n[d]));
    }
  }
  // Tiles of all ranks: a coarser grid is an eighth or a quarter of what a rank may hold anyway.
  runtime::Packer mine;
  for (const FlowTile& tile : from.tiles()) {
    std::vector<double> state;
    for_cells(coarse, tile, [&](int, const Index&, std::ptrdiff_t at) {
      for (int c = 0; c < unknowns; ++c) state.push_back(tile.state.data()[c * tile.cells.component + at]);
    });
    mine.put_one(tile.index);
    mine.put(std::span<const double>(state));
  }
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker all(bytes); !all.done();) {
      const Tile& tile = coarse.tiles[std::size_t(all.one<int>())];
      const std::vector<double> state = all.many<double>();
      BlockValues& v = values[std::size_t(tile.block)];
      std::size_t n = 0;
      for (int k = 0; k < tile.nk; ++k)
        for (int j = 0; j < tile.nj; ++j)
          for (int i = 0; i < tile.ni; ++i)
            for (int c = 0; c < unknowns; ++c) v.data[v.at(c, tile.to_block({i, j, k}))] = state[n++];
    }
  for (FlowTile& tile : to.tiles())
    for_cells(fine, tile, [&](int block, const Index& cell, std::ptrdiff_t at) {
      const BlockValues& v = values[std::size_t(block)];
      std::array<Between, 3> b;
      for (std::size_t d = 0; d < 3; ++d) b[d] = neighbours[std::size_t(block)][d][std::size_t(cell[d])];
      const auto nearest = [](const Between& x) { return x.share < 0.5 ? x.low : x.high; };
      for (int c = 0; c < unknowns; ++c) {
        const auto along_i = [&](int k, int j) {
          return (1.0 - b[0].share) * v.data[v.at(c, {b[0].low, j, k})] + b[0].share * v.data[v.at(c, {b[0].high, j, k})];
        };
        const auto along_j = [&](int k) {
          return (1.0 - b[1].share) * along_i(k, b[1].low) + b[1].share * along_i(k, b[1].high);
        };
        double value = (1.0 - b[2].share) * along_j(b[2].low) + b[2].share * along_j(b[2].high);
        if (c >= mean_unknowns) value = std::max(value, 0.25 * v.data[v.at(c, {nearest(b[0]), nearest(b[1]), nearest(b[2])})]);
        tile.state.data()[c * tile.cells.component + at] = value;
      }
    });
  to.forget();
}

void begin_with(const FlowSolver& coarse, FlowSolver& fine, const CellPlace& place, MPI_Comm comm) {
  const MarchState& march = coarse.march();
  if (march.verdict == Verdict::failed)
    throw NumericalFailure(
        fmt::format("aero: on the coarser grid of the start (aero.flow.coarse_steps): {} (pseudo-step {}, CFL {:.3g}){}",
                    march.why, march.steps, march.cfl, coarse.judgement().trouble()),
        "aero", march.steps, 0.0);
  transfer(coarse, fine, place, comm);
}

}  // namespace spindrift::aero
