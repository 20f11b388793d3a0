// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace spindrift::aero {

Window window_on(int block, Side side, const Box& cells) {
  const auto [a, b] = along(side);
  return {block, side, {cells.low[a], cells.low[b]}, {cells.high[a], cells.high[b]}};
}

namespace {

/// A new block: which cells of which old one.
struct Piece {
  int old_block;
  Box box;
};

Box moved(Box box, const Index& by, int sign) {
  for (int d = 0; d < 3; ++d) box.low[d] += sign * by[d], box.high[d] += sign * by[d];
  return box;
}

Block copy_nodes(const Block& old, const Box& box, int number) {
  Block block{
      fmt::format("{}-{}", old.name, number), box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2], {}};
  block.nodes.reserve(std::size_t(block.ni + 1) * (block.nj + 1) * (block.nk + 1));
  for (int k = box.low[2]; k <= box.high[2]; ++k)
    for (int j = box.low[1]; j <= box.high[1]; ++j)
      for (int i = box.low[0]; i <= box.high[0]; ++i) block.nodes.push_back(old.nodes[old.node(k, j, i)]);
  return block;
}

}  // namespace

MultiBlockGrid split_at(const MultiBlockGrid& grid, std::span<const std::array<std::vector<int>, 3>> cuts) {
  MultiBlockGrid result;
  result.planar = grid.planar;
  std::vector<Piece> pieces;
  std::vector<std::vector<int>> pieces_of(grid.blocks.size());
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const Index cells = grid.blocks[b].cells();
    std::array<std::vector<int>, 3> ends;
    for (int d = 0; d < 3; ++d) {
      ends[d].push_back(0);
      for (const int c : cuts[b][d]) {
        if (c <= ends[d].back() || c >= cells[d])
          throw std::invalid_argument(fmt::format("split: cut at {} of {} cells", c, cells[d]));
        ends[d].push_back(c);
      }
      ends[d].push_back(cells[d]);
    }
    for (std::size_t k = 0; k + 1 < ends[2].size(); ++k)
      for (std::size_t j = 0; j + 1 < ends[1].size(); ++j)
        for (std::size_t i = 0; i + 1 < ends[0].size(); ++i) {
          const Box box{{ends[0][i], ends[1][j], ends[2][k]}, {ends[0][i + 1], ends[1][j + 1], ends[2][k + 1]}};
          result.blocks.push_back(copy_nodes(grid.blocks[b], box, int(pieces_of[b].size())));
          pieces_of[b].push_back(int(pieces.size()));
          pieces.push_back({b, box});
        }
  }
  // Calls body(piece, its part of the layer of cells inside a window of the old block).
  const auto for_pieces_at = [&](const Window& w, auto&& body) {
    const Box layer = cells_at(w, grid.blocks[w.block].cells(), false);
    for (const int p : pieces_of[w.block]) {
      const Box part = intersection(layer, pieces[p].box);
      if (!part.empty()) body(p, part);
    }
  };
  for (const Boundary& old : grid.boundaries)
    for_pieces_at(old.where, [&](int p, const Box& part) {
      result.boundaries.push_back({window_on(p, old.where.side, moved(part, pieces[p].box.low, -1)), old.patch});
    });
  for (const Connection& old : grid.connections) {
    const IndexMap map = cell_map(old, grid);
    const int across = direction_of(old.from.side), out = at_end(old.from.side) ? 1 : -1;
    for_pieces_at(old.from, [&](int p, const Box& part) {
      Index step{};
      step[across] = out;
      const Box landing = image(map, moved(part, step, 1));
      for (const int q : pieces_of[old.to.block]) {
        const Box shared = intersection(landing, pieces[q].box);
        if (shared.empty()) continue;
        const Box here = moved(image(map.inverse(), shared), step, -1);
        result.connections.push_back({window_on(p, old.from.side, moved(here, pieces[p].box.low, -1)),
                                      window_on(q, old.to.side, moved(shared, pieces[q].box.low, -1)), old.orientation,
                                      old.periodic});
      }
    });
  }
  for (std::size_t b = 0; b < pieces_of.size(); ++b)
    for (const int p : pieces_of[b])
      for (const int q : pieces_of[b])
        for (int d = 0; d < 3; ++d) {
          const Box &here = pieces[p].box, &there = pieces[q].box;
          if (here.high[d] != there.low[d]) continue;
          Index step{};
          step[d] = 1;
          Box last = here;
          last.low[d] = here.high[d] - 1;
          const Box shared = intersection(moved(last, step, 1), there);
          if (shared.empty()) continue;
          result.connections.push_back({window_on(p, Side(2 * d + 1), moved(shared, here.low, -1)),
                                        window_on(q, Side(2 * d), moved(shared, there.low, -1)),
                                        {1, 2, 3},
                                        {}});
        }
  return result;
}

MultiBlockGrid split(const MultiBlockGrid& grid, int parts, std::span<const std::string> walls, const TilingOptions& options) {
  if (grid.blocks.size() != 1) throw std::invalid_argument("split: the grid has more than one block");
  const Tiling tiling = make_tiling(grid, walls, options);
  std::array<std::vector<int>, 3> ends;  // tile boundaries of the block
  for (int t = 0; t < tiling.size(); ++t) {
    const Box box = image(tiling.tiles[t].to_block, tiling.tiles[t].box());
    for (int d = 0; d < 3; ++d)
      if (box.low[d] > 0) ends[d].push_back(box.low[d]);
  }
  for (auto& e : ends) {
    std::ranges::sort(e);
    e.erase(std::unique(e.begin(), e.end()), e.end());
  }
  Index pieces{1, 1, 1};
  for (;;) {  // double where most tiles are left in a block, while that does not make too many
    int best = -1;
    double most = 1.0;
    for (int d = 0; d < 3; ++d) {
      const int tiles = int(ends[d].size()) + 1;
      const long after = long(pieces[0]) * pieces[1] * pieces[2] * 2;
      if (2 * pieces[d] <= tiles && after <= parts && double(tiles) / pieces[d] > most)
        most = double(tiles) / pieces[d], best = d;
    }
    if (best < 0) break;
    pieces[best] *= 2;
  }
  std::array<std::vector<int>, 3> cuts;
  for (int d = 0; d < 3; ++d)
    for (int p = 1; p < pieces[d]; ++p) cuts[d].push_back(ends[d][(ends[d].size() + 1) * p / pieces[d] - 1]);
  return split_at(grid, std::span(&cuts, 1));
}

void reorient(MultiBlockGrid& grid, int number, const Index& axes) {
  Block& block = grid.blocks[number];
  IndexMap old_of_new{axes, {}};  // cells
  const Index old_cells = block.cells();
  Index cells;
  for (int d = 0; d < 3; ++d) {
    cells[d] = old_cells[old_of_new.target(d)];
    if (old_of_new.sign(d) < 0) old_of_new.offset[old_of_new.target(d)] = cells[d] - 1;
  }
  IndexMap node_map = old_of_new;
  for (int d = 0; d < 3; ++d)
    if (node_map.sign(d) < 0) node_map.offset[node_map.target(d)] += 1;
  const IndexMap new_of_old = old_of_new.inverse();
  // Windows and orientations first: they need the old numbers of cells.
  const auto turned = [&](const Window& w) {
    return w.block != number ? w : window_on(number, new_of_old(w.side), image(new_of_old, cells_at(w, old_cells, false)));
  };
  for (Connection& c : grid.connections) {
    IndexMap map{c.orientation, {}};
    if (c.from.block == number) map = map.after(IndexMap{old_of_new.axes, {}});
    if (c.to.block == number) map = IndexMap{new_of_old.axes, {}}.after(map);
    c.orientation = map.axes;
    c.from = turned(c.from), c.to = turned(c.to);
  }
  for (Boundary& b : grid.boundaries) b.where = turned(b.where);
  Block result{block.name, cells[0], cells[1], cells[2], {}};
  result.nodes.reserve(block.nodes.size());
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        const Index at = node_map({i, j, k});
        result.nodes.push_back(block.nodes[block.node(at[2], at[1], at[0])]);
      }
  block = std::move(result);
}

}  // namespace spindrift::aero
