// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/join.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "src/aero/grid/split.hpp"

namespace spindrift::aero {

namespace {

bool is_cut(const Connection& c) { return !c.periodic && c.from.block == c.to.block && c.from.side == c.to.side; }

/// A connection of two whole sides: both blocks become one, numbered as the lower of them along the direction across.
void join(MultiBlockGrid& grid, std::size_t number) {
  reorient(grid, grid.connections[number].to.block, grid.connections[number].orientation);
  const Connection c = grid.connections[number];
  grid.connections.erase(grid.connections.begin() + std::ptrdiff_t(number));
  const bool onwards = at_end(c.from.side);
  const int low = onwards ? c.from.block : c.to.block, high = onwards ? c.to.block : c.from.block, d = direction_of(c.from.side);
  const Block first = std::move(grid.blocks[std::size_t(low)]), second = std::move(grid.blocks[std::size_t(high)]);
  const int shift = first.cells()[std::size_t(d)];
  Index cells = first.cells();
  cells[std::size_t(d)] += second.cells()[std::size_t(d)];
  Block both{first.name, cells[0], cells[1], cells[2], {}};
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        Index at{i, j, k};
        const bool beyond = at[std::size_t(d)] > shift;
        if (beyond) at[std::size_t(d)] -= shift;
        const Block& of = beyond ? second : first;
        both.nodes.push_back(of.nodes[of.node(at[2], at[1], at[0])]);
      }
  grid.blocks[std::size_t(low)] = std::move(both);
  grid.blocks.erase(grid.blocks.begin() + high);
  const auto moved = [&](Window& w) {
    const auto [a, b] = along(w.side);
    if (w.block == high)
      for (std::size_t n = 0; n < 2; ++n)
        if ((n == 0 ? a : b) == d) w.low[n] += shift, w.high[n] += shift;
    if (w.block == high) w.block = low;
    if (w.block > high) --w.block;
  };
  for (Connection& other : grid.connections) moved(other.from), moved(other.to);
  for (Boundary& boundary : grid.boundaries) moved(boundary.where);
}

}  // namespace

MultiBlockGrid join_cuts(MultiBlockGrid grid, int longest) {
  // Split at the ends of all cuts first; then each joins two whole sides.
  const auto fits = [&](const Connection& c) {
    return 2 * grid.blocks[std::size_t(c.from.block)].cells()[std::size_t(direction_of(c.from.side))] <= longest;
  };
  std::vector<std::array<std::set<int>, 3>> ends(grid.blocks.size());
  bool any = false;
  for (const Connection& c : grid.connections) {
    if (!is_cut(c) || !fits(c)) continue;
    any = true;
    for (const Window& w : {c.from, c.to})
      for (std::size_t n = 0; n < 2; ++n) {
        const auto d = std::size_t(along(w.side)[n]);
        for (const int end : {w.low[n], w.high[n]})
          if (end > 0 && end < grid.blocks[std::size_t(w.block)].cells()[d]) ends[std::size_t(w.block)][d].insert(end);
      }
  }
  if (!any) return grid;
  std::vector<std::array<std::vector<int>, 3>> cuts(ends.size());
  for (std::size_t b = 0; b < ends.size(); ++b)
    for (std::size_t d = 0; d < 3; ++d) cuts[b][d].assign(ends[b][d].begin(), ends[b][d].end());
  std::vector<int> origin;  // by block of the split grid
  for (std::size_t b = 0; b < cuts.size(); ++b)
    origin.insert(origin.end(), (cuts[b][0].size() + 1) * (cuts[b][1].size() + 1) * (cuts[b][2].size() + 1), int(b));
  grid = split_at(grid, cuts);
  const auto whole = [&](const Window& w) {
    const auto [a, b] = along(w.side);
    const Index cells = grid.blocks[std::size_t(w.block)].cells();
    return w.low == std::array{0, 0} && w.high == std::array{cells[std::size_t(a)], cells[std::size_t(b)]};
  };
  for (std::size_t n = 0; n < grid.connections.size();) {
    const Connection& c = grid.connections[n];
    const auto from = std::size_t(c.from.block), to = std::size_t(c.to.block);
    if (!c.periodic && from != to && origin[from] == origin[to] && c.from.side == c.to.side && whole(c.from) && whole(c.to) &&
        fits(c)) {
      origin.erase(origin.begin() + std::ptrdiff_t(at_end(c.from.side) ? to : from));
      join(grid, n);
    } else {
      ++n;
    }
  }
  return grid;
}

}  // namespace spindrift::aero
