// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/tiling.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace spindrift::aero {

IndexMap cell_map(const Connection& connection, const MultiBlockGrid& grid) {
  const Index from_cells = grid.blocks[connection.from.block].cells(), to_cells = grid.blocks[connection.to.block].cells();
  IndexMap map{connection.orientation, {}};
  const auto window_low = [](const Window& w, int d) { return d == along(w.side)[0] ? w.low[0] : w.low[1]; };
  const auto window_high = [](const Window& w, int d) { return d == along(w.side)[0] ? w.high[0] : w.high[1]; };
  for (int d = 0; d < 3; ++d) {
    const int t = map.target(d);
    if (d == direction_of(connection.from.side)) {
      const int outside = at_end(connection.from.side) ? from_cells[d] : -1;  // this layer is the first one inside `to`
      const int inside = at_end(connection.to.side) ? to_cells[t] - 1 : 0;
      map.offset[t] = inside - map.sign(d) * outside;
    } else if (map.sign(d) > 0) {
      map.offset[t] = window_low(connection.to, t) - window_low(connection.from, d);
    } else {
      map.offset[t] = window_high(connection.to, t) - 1 + window_low(connection.from, d);
    }
  }
  return map;
}

namespace {

/// A side of a block seen from the block: through this window lies another block.
struct Passage {
  Window window;
  int beyond;    ///< block
  IndexMap map;  ///< cells of this block, continued, to cells beyond
  int periodic;  ///< map of points beyond to points here
};

std::vector<std::vector<Passage>> passages(const MultiBlockGrid& grid, std::vector<RigidMap>& maps) {
  std::vector<std::vector<Passage>> found(grid.blocks.size());
  for (const Connection& c : grid.connections) {
    const IndexMap map = cell_map(c, grid);
    int there = -1, back = -1;
    if (c.periodic) {
      back = int(maps.size());
      maps.push_back({c.periodic->rotation.transpose(), -(c.periodic->rotation.transpose() * c.periodic->translation)});
      there = int(maps.size());
      maps.push_back(*c.periodic);
    }
    found[c.from.block].push_back({c.from, c.to.block, map, back});
    found[c.to.block].push_back({c.to, c.from.block, map.inverse(), there});
  }
  return found;
}

/// The direction of each block's lines, and whether they are the lines of a wall (then they stay whole).
struct Lines {
  int direction = 0;
  bool of_wall = false;
};

std::vector<Lines> choose_lines(const MultiBlockGrid& grid, std::span<const std::string> walls,
                                const std::vector<std::vector<Passage>>& passages, const EdgeLengths& lengths) {
  std::vector<Lines> lines(grid.blocks.size());
  std::vector<std::array<long, 3>> wall_faces(grid.blocks.size());
  for (const Boundary& b : grid.boundaries)
    if (std::find(walls.begin(), walls.end(), b.patch) != walls.end())
      wall_faces[b.where.block][direction_of(b.where.side)] +=
          long(b.where.high[0] - b.where.low[0]) * (b.where.high[1] - b.where.low[1]);
  std::vector<int> front;
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const auto most = std::max_element(wall_faces[b].begin(), wall_faces[b].end());
    if (*most > 0) lines[b] = {int(most - wall_faces[b].begin()), true}, front.push_back(b);
  }
  // Boundary layers go on through blocks side by side: where a wall's lines run along a passage, the block beyond continues them.
  while (!front.empty()) {
    std::vector<int> next;
    for (const int b : front)
      for (const Passage& p : passages[b]) {
        if (direction_of(p.window.side) == lines[b].direction || lines[p.beyond].of_wall) continue;
        lines[p.beyond] = {p.map.target(lines[b].direction), true};
        next.push_back(p.beyond);
      }
    front = std::move(next);
  }
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    if (lines[b].of_wall) continue;
    const auto edges = lengths.of(b);  // neighbours couple strongest along the shortest
    const int directions = grid.planar ? 2 : 3;
    for (int d = 1; d < directions; ++d)
      if (edges[d] < edges[lines[b].direction] - 0.1) lines[b].direction = d;  // a tenth: isotropic blocks keep their own i
  }
  return lines;
}

/// By block and direction: whether rows lie along sticky walls, those of the block or those whose lines go on into it, however
/// the grid is cut into blocks. Of sections: what helps them makes rotors of coarse cells settle late and lose thrust above rated
/// wind (docs/developer/notes/air.md, "A coarse grid's stall").
std::vector<std::array<bool, 3>> choose_along(const MultiBlockGrid& grid, std::span<const std::string> sticky,
                                              const std::vector<std::vector<Passage>>& passages) {
  std::vector<std::array<bool, 3>> ends_at_wall(grid.blocks.size()), along(grid.blocks.size());
  if (!grid.planar) return along;
  for (const Boundary& b : grid.boundaries)
    if (std::find(sticky.begin(), sticky.end(), b.patch) != sticky.end())
      ends_at_wall[b.where.block][direction_of(b.where.side)] = true;
  constexpr int unknown = -1, none = -2;  // several walls, one in each direction
  std::vector<int> across(grid.blocks.size(), unknown), front;
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const auto& ends = ends_at_wall[b];
    if (ends[0] || ends[1]) across[b] = ends[0] && ends[1] ? none : ends[1], front.push_back(b);
  }
  while (!front.empty()) {
    std::vector<int> next;
    for (const int b : front)
      for (const Passage& p : passages[b]) {
        if (across[b] == none || across[p.beyond] != unknown) continue;
        across[p.beyond] = p.map.target(across[b]);
        next.push_back(p.beyond);
      }
    front = std::move(next);
  }
  for (std::size_t b = 0; b < along.size(); ++b)
    if (across[b] >= 0) along[b][1 - across[b]] = true;
  return along;
}

/// A face between tiles has one flux: their ends are along a wall for both or for neither. Rows in a tile's i are swept with both
/// their ends at once and go together.
void agree_on_ends(Tiling& tiling) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const GhostLink& link : tiling.links) {
      const int from_side = int(link.donor(link.side)) ^ 1;  // where one tile ends the other begins
      bool &here = tiling.tiles[link.to].ends_along_wall[std::size_t(link.side)],
           &there = tiling.tiles[link.from].ends_along_wall[std::size_t(from_side)];
      if (here != there) here = there = false, changed = true;
    }
    for (Tile& tile : tiling.tiles)
      if (tile.along_wall[0] && !(tile.ends_along_wall[0] && tile.ends_along_wall[1]))
        tile.along_wall[0] = tile.ends_along_wall[0] = tile.ends_along_wall[1] = false, changed = true;
  }
}

/// Right-handed directions of a tile whose i is this direction of its block; k stays k in planar grids.
Index tile_axes(int direction, bool planar) {
  if (direction == 0) return {1, 2, 3};
  if (direction == 2) return {3, 1, 2};
  return planar ? Index{2, -1, 3} : Index{2, 3, 1};
}

}  // namespace

Index tile_target(int line_cells, bool of_wall, bool planar, const TilingOptions& o) {
  int i = of_wall ? line_cells : std::min(line_cells, planar ? o.planar_normal : o.normal);
  int j = planar ? o.planar_across : o.across_j, k = planar ? 1 : o.across_k;
  const auto too_large = [&] { return long(i) * j * k > o.max_cells; };
  const int least = planar ? 8 : 4;
  while (too_large() && (j > least || k > least)) (j >= k ? j : k) /= 2;
  while (too_large() && !of_wall && i > 2 * least) i /= 2;
  return {i, j, k};
}

namespace {

/// At least state_ghosts cells each: a neighbour's ghost layers come from one tile.
int pieces(int n, int largest) { return std::max(1, std::min((n + largest - 1) / largest, n / state_ghosts)); }

/// The tiles of a block stand in rows: part p of `parts` of n cells begins at cell n p / parts.
struct Rows {
  int first = 0;      ///< number of the block's first tile
  IndexMap to_block;  ///< from cells counted along the tiles' directions
  Index cells{}, parts{};

  static int begin(int n, int part, int parts) { return int(long(n) * part / parts); }
  /// The part that a cell is in.
  int part(int d, int cell) const {
    int p = int(long(cell) * parts[d] / cells[d]);
    while (begin(cells[d], p + 1, parts[d]) <= cell) ++p;
    return p;
  }
};

Rows cut(const Block& block, int number, const Lines& lines, bool planar, const TilingOptions& options,
         std::vector<Tile>& tiles) {
  const int first = int(tiles.size());
  const IndexMap directions{tile_axes(lines.direction, planar), {}};
  const Index cells = block.cells();
  const Index target = tile_target(cells[lines.direction], lines.of_wall, planar, options);
  Index n, parts;
  for (int d = 0; d < 3; ++d) n[d] = cells[directions.target(d)], parts[d] = pieces(n[d], target[d]);
  for (int k = 0; k < parts[2]; ++k)
    for (int j = 0; j < parts[1]; ++j)
      for (int i = 0; i < parts[0]; ++i) {
        const Index part{i, j, k};
        Index low, high;
        for (int d = 0; d < 3; ++d)
          low[d] = Rows::begin(n[d], part[d], parts[d]), high[d] = Rows::begin(n[d], part[d] + 1, parts[d]);
        Tile tile{number, directions, high[0] - low[0], high[1] - low[1], high[2] - low[2]};
        for (int d = 0; d < 3; ++d) {
          const int t = directions.target(d);
          tile.to_block.offset[t] = directions.sign(d) > 0 ? low[d] : cells[t] - 1 - low[d];
        }
        tile.cost = double(tile.count());
        tiles.push_back(tile);
      }
  return {first, tiles[first].to_block, n, parts};
}

/// The window of a tile's side that a box of its own cells (one layer, in or outside) covers.
std::pair<std::array<int, 2>, std::array<int, 2>> window_of(Side side, const Box& box) {
  const auto [a, b] = along(side);
  return {{box.low[a], box.low[b]}, {box.high[a], box.high[b]}};
}

class Builder {
 public:
  Builder(const MultiBlockGrid& grid, Tiling& tiling, const std::vector<std::vector<Passage>>& passages,
          const std::vector<Rows>& rows)
      : grid_(grid), tiling_(tiling), passages_(passages), rows_(rows) {
    for (int n = 0; n < int(grid.boundaries.size()); ++n) boundaries_[grid.boundaries[n].where.block].push_back(n);
  }

  void neighbours(int number) {
    const Tile& tile = tiling_.tiles[number];
    const Index block_cells = grid_.blocks[tile.block].cells();
    for (int s = 0; s < (tiling_.planar ? 4 : 6); ++s) {
      const Side side = Side(s);
      const Window whole{0, side, {0, 0}, {tile.cells()[along(side)[0]], tile.cells()[along(side)[1]]}};
      const Box beyond = image(tile.to_block, cells_at(whole, tile.cells(), true));
      const int d = tile.to_block.target(direction_of(side));
      if (beyond.low[d] >= 0 && beyond.high[d] <= block_cells[d]) {
        link(number, side, beyond, tile.block, IndexMap{}, -1);
        continue;
      }
      const Side block_side = tile.to_block(side);
      for (const Passage& p : passages_[tile.block]) {
        if (p.window.side != block_side) continue;
        const Box shared = intersection(beyond, cells_at(p.window, block_cells, true));
        if (!shared.empty()) link(number, side, shared, p.beyond, p.map, p.periodic);
      }
      for (const int n : boundaries_[tile.block]) {
        const Boundary& b = grid_.boundaries[n];
        if (b.where.side != block_side) continue;
        const Box shared = intersection(beyond, cells_at(b.where, block_cells, true));
        if (shared.empty()) continue;
        const auto [low, high] = window_of(side, image(tile.to_block.inverse(), shared));
        tiling_.boundaries.push_back({number, side, low, high, tiling_.patch(b.patch), n});
      }
    }
  }

 private:
  /// Ghost cells of tile `to`, given as a box of (continued) cells of its block, come from tiles of the block beyond.
  void link(int to, Side side, const Box& ghosts, int beyond, const IndexMap& map, int periodic) {
    const Rows& rows = rows_[beyond];
    const Box inside = image(rows.to_block, Box{{0, 0, 0}, rows.cells});
    const Box donors = intersection(image(map, ghosts), inside);
    if (donors.empty()) return;
    const Box along_rows = image(rows.to_block.inverse(), donors);
    Index first, last;
    for (int d = 0; d < 3; ++d) first[d] = rows.part(d, along_rows.low[d]), last[d] = rows.part(d, along_rows.high[d] - 1);
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i)
          link_to(to, side, donors, rows.first + (k * rows.parts[1] + j) * rows.parts[0] + i, map, periodic);
  }

  void link_to(int to, Side side, const Box& donors, int from, const IndexMap& map, int periodic) {
    const Tile& donor = tiling_.tiles[from];
    const Box shared = intersection(donors, image(donor.to_block, donor.box()));
    const IndexMap& receiver = tiling_.tiles[to].to_block;
    const Box window = image(receiver.inverse(), image(map.inverse(), shared));
    const auto [low, high] = window_of(side, window);
    tiling_.links.push_back({from, to, side, low, high, donor.to_block.inverse().after(map.after(receiver)), periodic});
  }

  const MultiBlockGrid& grid_;
  Tiling& tiling_;
  const std::vector<std::vector<Passage>>& passages_;
  const std::vector<Rows>& rows_;
  std::map<int, std::vector<int>> boundaries_;  ///< of the grid, by block
};

}  // namespace

int Tiling::patch(std::string_view name) const {
  const auto found = std::find(patches.begin(), patches.end(), name);
  return found == patches.end() ? -1 : int(found - patches.begin());
}

EdgeLengths::EdgeLengths(const MultiBlockGrid& whole) {
  for (const Block& b : whole.blocks) cells_.push_back(b.cells());
}

EdgeLengths EdgeLengths::of_whole(const MultiBlockGrid& grid) {
  EdgeLengths edges(grid);
  for (std::size_t n = 0; n < grid.blocks.size(); ++n) edges.add(int(n), grid.blocks[n], 0, grid.blocks[n].nk);
  return edges;
}

void EdgeLengths::add(const GridLayers& part) {
  for (std::size_t n = 0; n < cells_.size(); ++n) add(int(n), part.grid.blocks[n], part.first[n], part.count[n]);
}

void EdgeLengths::add(int number, const Block& b, int first, int count) {
  const Index& cells = cells_[number];
  const int step_i = std::max(1, cells[0] / 16), step_j = std::max(1, cells[1] / 16), step_k = std::max(1, cells[2] / 16);
  for (int k = 0; k < count; ++k) {
    if ((first + k) % step_k != 0) continue;
    Layer& layer = layers_.emplace_back(Layer{.block = number});
    for (int j = 0; j < b.nj; j += step_j)
      for (int i = 0; i < b.ni; i += step_i, ++layer.count) {
        const Eigen::Vector3d& x = b.nodes[b.node(k, j, i)];
        const Eigen::Vector3d* next[] = {&b.nodes[b.node(k, j, i + 1)], &b.nodes[b.node(k, j + 1, i)],
                                         &b.nodes[b.node(k + 1, j, i)]};
        for (int d = 0; d < 3; ++d) layer.sum[d] += std::log(std::max((*next[d] - x).norm(), 1e-300));
      }
  }
}

std::array<double, 3> EdgeLengths::of(int block) const {
  Layer all;
  for (const Layer& layer : layers_) {
    if (layer.block != block) continue;
    all.count += layer.count;
    for (int d = 0; d < 3; ++d) all.sum[d] += layer.sum[d];
  }
  for (double& sum : all.sum) sum /= double(all.count);
  return all.sum;
}

Tiling make_tiling(const MultiBlockGrid& grid, std::span<const std::string> walls, const TilingOptions& options) {
  return make_tiling(grid, walls, options, EdgeLengths::of_whole(grid));
}

Tiling make_tiling(const MultiBlockGrid& grid, std::span<const std::string> walls, const TilingOptions& options,
                   const EdgeLengths& edges) {
  Tiling tiling;
  tiling.planar = grid.planar;
  tiling.windows = grid.boundaries;
  const auto open = passages(grid, tiling.periodic);
  const auto lines = choose_lines(grid, walls, open, edges);
  const auto along = choose_along(grid, options.sticky, open);
  std::vector<Rows> rows;
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    tiling.block_names.push_back(grid.blocks[b].name);
    tiling.block_cells.push_back(grid.blocks[b].cells());
    const std::size_t first = tiling.tiles.size();
    rows.push_back(cut(grid.blocks[b], b, lines[b], grid.planar, options, tiling.tiles));
    for (Tile& tile : std::span(tiling.tiles).subspan(first))
      for (int d = 0; d < 3; ++d)
        tile.along_wall[d] = tile.ends_along_wall[2 * d] = tile.ends_along_wall[2 * d + 1] = along[b][tile.to_block.target(d)];
  }
  for (const Boundary& b : grid.boundaries)
    if (tiling.patch(b.patch) < 0) tiling.patches.push_back(b.patch);
  Builder builder(grid, tiling, open, rows);
  for (int t = 0; t < tiling.size(); ++t) {
    const int first_link = int(tiling.links.size()), first_boundary = int(tiling.boundaries.size());
    builder.neighbours(t);
    tiling.links_into.push_back({first_link, int(tiling.links.size())});
    tiling.boundaries_of.push_back({first_boundary, int(tiling.boundaries.size())});
  }
  agree_on_ends(tiling);
  return tiling;
}

runtime::BlockGraph tile_graph(const Tiling& tiling) {
  runtime::BlockGraph graph;
  for (const Tile& t : tiling.tiles) graph.cost.push_back(t.cost);
  for (const GhostLink& l : tiling.links)
    if (l.from != l.to) graph.edges.push_back({l.from, l.to, double(l.faces()) * state_ghosts});
  return graph;
}

LinkPlan link_plan(const Tiling& tiling, std::span<const int> rank_of_tile, int rank) {
  LinkPlan plan;
  std::map<int, std::vector<int>> sends, receives;
  for (int l = 0; l < int(tiling.links.size()); ++l) {
    const int from = rank_of_tile[tiling.links[l].from], to = rank_of_tile[tiling.links[l].to];
    if (from == rank && to == rank) plan.local.push_back(l);
    if (from == rank && to != rank) sends[to].push_back(l);
    if (from != rank && to == rank) receives[from].push_back(l);
  }
  for (auto& [other, links] : sends) plan.sends.push_back({other, std::move(links)});
  for (auto& [other, links] : receives) plan.receives.push_back({other, std::move(links)});
  return plan;
}

}  // namespace spindrift::aero
