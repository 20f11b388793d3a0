// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "kernels/base/failure.hpp"
#include "kernels/base/release.hpp"
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

Box round_both(const Box& a, const Box& b) {
  Box w;
  for (std::size_t d = 0; d < 3; ++d) w.low[d] = std::min(a.low[d], b.low[d]), w.high[d] = std::max(a.high[d], b.high[d]);
  return w;
}

/// body(cell)
template <class Body>
void for_cells(const Box& w, Body&& body) {
  for (int k = w.low[2]; k < w.high[2]; ++k)
    for (int j = w.low[1]; j < w.high[1]; ++j)
      for (int i = w.low[0]; i < w.high[0]; ++i) body(Index{i, j, k});
}

/// The cells of a fine tile, what each lies between along the indices of its block, and all coarse cells of these.
struct Stencil {
  Box cells, below;
  std::array<std::vector<Between>, 3> between;
};

Stencil stencil_of(const Tiling& coarse, const Tiling& fine, const Tile& tile, const CellPlace& place) {
  Stencil s{.cells = image(tile.to_block, tile.box()), .below = {}, .between = {}};
  const Index &few = coarse.block_cells[std::size_t(tile.block)], &many = fine.block_cells[std::size_t(tile.block)];
  for (std::size_t d = 0; d < 3; ++d) {
    s.below.low[d] = few[d];
    for (int i = s.cells.low[d]; i < s.cells.high[d]; ++i) {
      const Between b = between(place ? place(tile.block, int(d), i) : (i + 0.5) * few[d] / many[d], few[d]);
      s.below.low[d] = std::min(s.below.low[d], b.low), s.below.high[d] = std::max(s.below.high[d], b.high + 1);
      s.between[d].push_back(b);
    }
  }
  return s;
}

/// body(number of the tile, those of these cells of a block that it has)
template <class Body>
void for_tiles_of(const Tiling& tiling, int block, const Box& cells, Body&& body) {
  for (const Tile& tile : std::ranges::equal_range(tiling.tiles, block, {}, &Tile::block))
    if (const Box here = intersection(cells, image(tile.to_block, tile.box())); !here.empty())
      body(int(&tile - tiling.tiles.data()), here);
}

/// Cell values in a window of a block, component by component.
struct Values {
  Box window;
  std::vector<double> data;
  Values(const Box& w, int components) : window(w), data(std::size_t(components) * std::size_t(w.cells())) {}
  std::size_t at(int c, const Index& n) const {
    const auto from_low = [&](std::size_t d) { return std::size_t(n[d] - window.low[d]); };
    const auto size = [&](std::size_t d) { return std::size_t(window.high[d] - window.low[d]); };
    return ((std::size_t(c) * size(2) + from_low(2)) * size(1) + from_low(1)) * size(0) + from_low(0);
  }
};

/// Place in a tile's state of a cell of its block.
std::ptrdiff_t place_of(const FlowTile& flow, const Tile& tile, const Index& cell) {
  const Index at = tile.to_block.inverse()(cell);
  return flow.cells.at(at[2], at[1], at[0]);
}

/// The states of these cells, from the ranks that have them. Collective.
std::map<int, Values> fetch(const FlowSolver& from, const std::vector<WindowOfTile>& windows, MPI_Comm comm) {
  const Tiling& tiling = from.grid().tiling();
  std::vector<std::vector<WindowOfTile>> asked(std::size_t(runtime::ranks_in(comm)));
  for (const WindowOfTile& w : windows) asked[std::size_t(from.grid().rank_of_tile()[std::size_t(w.tile)])].push_back(w);
  std::vector<runtime::Bytes> requests(asked.size()), answers(asked.size());
  for (std::size_t r = 0; r < asked.size(); ++r) {
    runtime::Packer request;
    if (!asked[r].empty()) request.put(std::span<const WindowOfTile>(asked[r]));
    requests[r] = request.take();
  }
  std::map<int, const FlowTile*> own;
  for (const FlowTile& tile : from.tiles()) own[tile.index] = &tile;
  requests = runtime::exchange(comm, requests);
  for (std::size_t r = 0; r < asked.size(); ++r) {
    runtime::Packer answer;
    for (runtime::Unpacker request(requests[r]); !request.done();)
      for (const WindowOfTile& w : request.many<WindowOfTile>()) {
        const FlowTile& tile = *own.at(w.tile);
        Values values(w.cells, from.unknowns());
        for_cells(w.cells, [&](const Index& cell) {
          const std::ptrdiff_t at = place_of(tile, tiling.tiles[std::size_t(w.tile)], cell);
          for (int c = 0; c < from.unknowns(); ++c)
            values.data[values.at(c, cell)] = tile.state.data()[c * tile.cells.component + at];
        });
        answer.put_one(w);
        answer.put(std::span<const double>(values.data));
      }
    answers[r] = answer.take();
  }
  answers = runtime::exchange(comm, answers);
  std::map<int, Values> states;
  for (runtime::Bytes& answer : answers) {
    for (runtime::Unpacker left(answer); !left.done();) {
      const auto w = left.one<WindowOfTile>();
      states.emplace(w.tile, Values(w.cells, 0)).first->second.data = left.many<double>();
    }
    release(answer);
  }
  return states;
}

}  // namespace

std::vector<WindowOfTile> cells_under(const Tiling& coarse, const Tiling& fine, std::span<const int> fine_tiles,
                                      const CellPlace& place) {
  std::map<int, Box> needed;
  for (const int t : fine_tiles) {
    const Tile& tile = fine.tiles[std::size_t(t)];
    for_tiles_of(coarse, tile.block, stencil_of(coarse, fine, tile, place).below, [&](int under, const Box& cells) {
      const auto [at, is_new] = needed.emplace(under, cells);
      if (!is_new) at->second = round_both(at->second, cells);
    });
  }
  std::vector<WindowOfTile> windows;
  for (const auto& [tile, cells] : needed) windows.push_back({tile, cells});
  return windows;
}

std::size_t transfer(const FlowSolver& from, FlowSolver& to, const CellPlace& place, MPI_Comm comm) {
  const Tiling &coarse = from.grid().tiling(), &fine = to.grid().tiling();
  const int unknowns = from.unknowns();
  std::vector<int> own;
  for (const FlowTile& tile : to.tiles()) own.push_back(tile.index);
  const std::map<int, Values> states = fetch(from, cells_under(coarse, fine, own, place), comm);
  for (FlowTile& tile : to.tiles()) {
    const Tile& t = fine.tiles[std::size_t(tile.index)];
    const Stencil stencil = stencil_of(coarse, fine, t, place);
    Values v(stencil.below, unknowns);
    for_tiles_of(coarse, t.block, stencil.below, [&](int under, const Box& cells) {
      const Values& given = states.at(under);
      for_cells(cells, [&](const Index& cell) {
        for (int c = 0; c < unknowns; ++c) v.data[v.at(c, cell)] = given.data[given.at(c, cell)];
      });
    });
    for_cells(stencil.cells, [&](const Index& cell) {
      const std::ptrdiff_t at = place_of(tile, t, cell);
      std::array<Between, 3> b;
      for (std::size_t d = 0; d < 3; ++d) b[d] = stencil.between[d][std::size_t(cell[d] - stencil.cells.low[d])];
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
  }
  to.forget();
  std::size_t held = 0;
  for (const auto& [t, values] : states) held += values.data.size() * sizeof(double);
  return held;
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
