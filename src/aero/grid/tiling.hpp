// Cuts the blocks of a grid into tiles: the pieces that are tasks, live on one rank each and own their storage.
// A tile's i is the direction across the walls (lines of strongest coupling), never cut in a boundary layer. The tiling follows
// from the grid and the options alone, never from ranks or threads, and so does the number of each tile. Called where a solver is
// set up; tested in tests/src/aero/grid/tiling_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "runtime/partition/block_graph.hpp"
#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

inline constexpr int state_ghosts = 2;     ///< layers of ghost cells of a flow state; none in k of planar grids
inline constexpr int gradient_ghosts = 1;  ///< of cell gradients
inline constexpr int cell_ghosts = 2;      ///< of centres and volumes

struct TilingOptions {
  int across_j = 16, across_k = 8;       ///< largest tile [cells] in the two directions along a wall
  int planar_across = 32;                ///< the same in a planar grid
  int normal = 64;                       ///< largest tile in i where no wall's lines pass (3-D)
  int planar_normal = 128;               ///< the same in a planar grid
  int max_cells = 8192;                  ///< tiles with long lines get fewer of them
  std::vector<std::string> sticky = {};  ///< patches that the gas sticks to: Tile::along_wall
};

/// The largest tile in its own directions, of a block with so many cells along i: lines of a wall stay whole.
Index tile_target(int line_cells, bool of_wall, bool planar, const TilingOptions& options);

/// A box of cells of one block, seen in directions of its own: from tile to block indices by `to_block`.
struct Tile {
  int block = 0;
  IndexMap to_block;
  int ni = 0, nj = 0, nk = 0;
  double cost = 0.0;                      ///< for sharing out among ranks, in cells
  std::array<bool, 3> along_wall{};       ///< by direction: of a section: rows that lie along sticky walls
  std::array<bool, 6> ends_along_wall{};  ///< by side: so do those that go on beyond it
  Index cells() const { return {ni, nj, nk}; }
  Box box() const { return {{0, 0, 0}, {ni, nj, nk}}; }
  long count() const { return long(ni) * nj * nk; }
};

/// A rectangle of a tile's faces where a boundary condition acts: cells [low, high) in the two directions along the side.
struct TileBoundary {
  int tile = 0;
  Side side = Side::i_min;
  std::array<int, 2> low{}, high{};
  int patch = 0;   ///< index in Tiling::patches
  int window = 0;  ///< index in Tiling::windows: the one that this is a part of
};

/// Ghost cells of `to` beyond a window of one of its sides, and the cells of `from` that fill them: ghost cell (i, j, k) of `to`,
/// with an index below zero or beyond the last one, is cell donor(i, j, k) of `from`, for as many layers as `from` is deep.
struct GhostLink {
  int from = 0, to = 0;
  Side side = Side::i_min;  ///< of `to`
  std::array<int, 2> low{}, high{};
  IndexMap donor;
  int periodic = -1;  ///< index in Tiling::periodic of the map that carries points of `from` to `to`; -1 where they are one place
  int faces() const { return (high[0] - low[0]) * (high[1] - low[1]); }
};

/// A contiguous range of Tiling's lists.
struct Range {
  int first = 0, last = 0;
};

struct Tiling {
  std::vector<Tile> tiles;        ///< block by block; within a block k, then j, then i of the tile's directions slowest first
  std::vector<GhostLink> links;   ///< by `to`, then side
  std::vector<Range> links_into;  ///< per tile: of `links`
  std::vector<TileBoundary> boundaries;  ///< by tile, then side
  std::vector<Range> boundaries_of;      ///< per tile: of `boundaries`
  std::vector<std::string> patches;      ///< names, in order of first use in the grid
  std::vector<Boundary> windows;         ///< the grid's
  std::vector<RigidMap> periodic;
  std::vector<std::string> block_names;
  std::vector<Index> block_cells;
  bool planar = false;

  int size() const { return int(tiles.size()); }
  std::span<const GhostLink> into(int tile) const {
    return std::span(links).subspan(links_into[tile].first, links_into[tile].last - links_into[tile].first);
  }
  std::span<const TileBoundary> boundary(int tile) const {
    return std::span(boundaries).subspan(boundaries_of[tile].first, boundaries_of[tile].last - boundaries_of[tile].first);
  }
  /// Index of a patch by name; -1 where the grid has none.
  int patch(std::string_view name) const;
};

/// Mean logarithms of the edge lengths of each block's cells, from samples: all that a tiling takes of the nodes. Summed by
/// layers of cells, so that it does not matter how a grid comes in parts.
class EdgeLengths {
 public:
  struct Layer {
    int block = 0;
    long count = 0;
    std::array<double, 3> sum{};
  };
  EdgeLengths() = default;
  explicit EdgeLengths(const MultiBlockGrid& whole);  ///< of its blocks, whose nodes are still to come
  static EdgeLengths of_whole(const MultiBlockGrid& grid);
  void add(const GridLayers& part);  ///< each layer once
  std::span<const Layer> layers() const { return layers_; }
  void append(std::span<const Layer> more) { layers_.insert(layers_.end(), more.begin(), more.end()); }
  std::array<double, 3> of(int block) const;  ///< by direction; of a block whose layers are all added

 private:
  void add(int number, const Block& block, int first, int count);

  std::vector<Index> cells_;  ///< of the blocks
  std::vector<Layer> layers_;
};

/// `walls` names the patches whose normal direction becomes i. The grid must have passed check() (checks.hpp).
Tiling make_tiling(const MultiBlockGrid& grid, std::span<const std::string> walls, const TilingOptions& options = {});
/// The same of a grid without nodes.
Tiling make_tiling(const MultiBlockGrid& grid, std::span<const std::string> walls, const TilingOptions& options,
                   const EdgeLengths& edges);

/// Tiles and what passes between them, for runtime/partition: cost in cells, edges in ghost cells.
runtime::BlockGraph tile_graph(const Tiling& tiling);

/// What one rank copies, sends and receives, from the rank of every tile. Each list of links is in the order of Tiling::links, on
/// the sender as on the receiver.
struct LinkPlan {
  struct Message {
    int rank = 0;
    std::vector<int> links;
  };
  std::vector<int> local;                ///< links whose both ends are on this rank
  std::vector<Message> sends, receives;  ///< by rank
};
LinkPlan link_plan(const Tiling& tiling, std::span<const int> rank_of_tile, int rank);

}  // namespace spindrift::aero
