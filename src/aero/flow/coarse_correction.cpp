// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/coarse_correction.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/flow/block_elimination.hpp"
#include "src/aero/flow/ilu_after_coarse.hpp"
#include "src/aero/flow/numbering.hpp"
#include "src/aero/hypre/multigrid.hpp"

namespace spindrift::aero {

namespace coarse_parts {

constexpr int width = mean_unknowns, block_size = width * width;

/// Where the numbers of a group are: those of a process's own come first, then others by position.
struct GroupPlace {
  int canonical = 0;  ///< in the order of tiles, whatever the ranks
  int own = -1;       ///< offset among this process's groups
  int outside = -1;   ///< position of another process's
};

struct TileGroups {
  Index pieces{1, 1, 1};
  std::array<std::vector<int>, 3> piece_of;  ///< by cell index of a direction, already times the stride of its groups
  int first = 0;                             ///< offset of the first group among this process's
  struct Column {
    GroupPlace place;
    const Eigen::Matrix3d* turn = nullptr;  ///< of velocities met through a rotational period
  };
  std::vector<Column> columns;
  std::vector<std::pair<int, int>> entries;  ///< group of this tile, column
  std::vector<std::array<double, block_size>> values;
  std::vector<std::array<int, 7>> inside;  ///< by group: entry of itself, then of the group across each side, where of this tile
  std::array<std::vector<int>, 6> beyond;  ///< by face of a side of the tile: entry; -1 where a boundary
  std::vector<linear::ShortFloat> sums;    ///< [cell][25]: diagonal and all blocks to cells of the same group
  int group(int k, int j, int i) const {
    return piece_of[0][std::size_t(i)] + piece_of[1][std::size_t(j)] + piece_of[2][std::size_t(k)];
  }
};

Index pieces_of(const Tile& tile, int side) {
  if (side <= 0) return {1, 1, 1};
  Index n{};
  const Index cells = tile.cells();
  for (std::size_t d = 0; d < 3; ++d) n[d] = (cells[d] + side - 1) / side;
  return n;
}
int count_of(const Index& pieces) { return pieces[0] * pieces[1] * pieces[2]; }

struct CoarseCorrection final : IluAfterCoarse {
  using IluAfterCoarse::IluAfterCoarse;
  Numbering numbering;
  std::vector<int> canonical_first;  ///< by tile
  int total = 0;
  std::vector<int> local;
  std::vector<TileGroups> tiles;
  std::vector<int> canonical;  ///< of this process's groups
  std::vector<double> right, left, outside, all;
  OutsideValues exchange;
  BlockElimination elimination;
  std::optional<Multigrid> multigrid;

  bool direct() const { return total <= options_.direct_groups; }
  const double* values_of(const GroupPlace& p) const {
    if (direct()) return all.data() + std::size_t(p.canonical) * width;
    return p.own >= 0 ? left.data() + std::size_t(p.own) * width : outside.data() + std::size_t(p.outside) * width;
  }
  TileGroups& of(const FlowTile& tile) { return tiles[std::size_t(local[std::size_t(tile.index)])]; }
  const TileGroups& of(const FlowTile& tile) const { return tiles[std::size_t(local[std::size_t(tile.index)])]; }

  bool knows_ranks() const override { return !direct(); }  // multigrid
  void attach(GridStore& grid, std::span<FlowTile> flow) override {
    const Tiling& tiling = grid.tiling();
    const auto groups_of = [this](const Tile& t) { return count_of(pieces_of(t, options_.group_cells)); };
    numbering = number_points(grid, groups_of);
    total = 0;
    for (const Tile& t : tiling.tiles) canonical_first.push_back(total), total += groups_of(t);
    local.assign(tiling.tiles.size(), -1);
    tiles.resize(flow.size());
    right.resize(std::size_t(numbering.end - numbering.begin) * width), left.resize(right.size());
    for (std::size_t n = 0; n < flow.size(); ++n) {
      local[std::size_t(flow[n].index)] = int(n);
      add_tile(tiling, flow[n], tiles[n]);
      for (int g = 0; g < count_of(tiles[n].pieces); ++g) canonical.push_back(canonical_first[std::size_t(flow[n].index)] + g);
    }
  }
  void add_tile(const Tiling& tiling, const FlowTile& flow, TileGroups& t) {
    const Tile& tile = tiling.tiles[std::size_t(flow.index)];
    const Index cells = tile.cells();
    t.pieces = pieces_of(tile, options_.group_cells);
    t.first = numbering.first[std::size_t(flow.index)] - numbering.begin;
    std::array<std::vector<int>, 3> piece;
    const std::array<int, 3> stride{1, t.pieces[0], t.pieces[0] * t.pieces[1]};
    for (std::size_t d = 0; d < 3; ++d)
      for (int c = 0; c < cells[d]; ++c) t.piece_of[d].push_back(int(long(c) * t.pieces[d] / cells[d]) * stride[d]);
    const int groups = count_of(t.pieces);
    std::map<std::tuple<int, int, int>, int> found;  // group, number, period -> entry
    const auto entry = [&](int group, int number, int of_tile, int of_group, int period) {
      const auto [at, fresh] = found.try_emplace({group, number, period}, int(t.entries.size()));
      if (fresh) {
        TileGroups::Column c;
        c.place.canonical = canonical_first[std::size_t(of_tile)] + of_group;
        if (numbering.here(number))
          c.place.own = number - numbering.begin;
        else
          c.place.outside = exchange.want(number);
        if (period >= 0 && !tiling.periodic[std::size_t(period)].rotation.isIdentity(1e-14))
          c.turn = &tiling.periodic[std::size_t(period)].rotation;
        t.entries.emplace_back(group, int(t.columns.size()));
        t.columns.push_back(c);
      }
      return at->second;
    };
    const int first = numbering.first[std::size_t(flow.index)];
    for (int g = 0; g < groups; ++g) {
      auto& inside = t.inside.emplace_back();
      inside.fill(-1);
      inside[0] = entry(g, first + g, flow.index, g, -1);
      const Index at{g % t.pieces[0], g / t.pieces[0] % t.pieces[1], g / (t.pieces[0] * t.pieces[1])};
      for (int s = 0; s < 6; ++s) {
        const std::size_t d = std::size_t(s / 2);
        const int other = at[d] + (s % 2 ? 1 : -1);
        if (other >= 0 && other < t.pieces[d]) {
          const int n = g + (s % 2 ? 1 : -1) * stride[d];
          inside[std::size_t(s) + 1] = entry(g, first + n, flow.index, n, -1);
        }
      }
    }
    for (int s = 0; s < 6; ++s) {
      const auto [a, b] = along(Side(s));
      t.beyond[std::size_t(s)].assign(std::size_t(cells[std::size_t(a)]) * std::size_t(cells[std::size_t(b)]), -1);
    }
    for_neighbours(tiling, flow.index, [&](const GhostLink& link, const Index& at, const Index& donor) {
      const Tile& from = tiling.tiles[std::size_t(link.from)];
      const Index pieces = pieces_of(from, options_.group_cells), n = from.cells();
      int of_group = 0;
      for (std::size_t d = 3; d-- > 0;) of_group = of_group * pieces[d] + int(long(donor[d]) * pieces[d] / n[d]);
      const auto [a, b] = along(link.side);
      t.beyond[std::size_t(link.side)][std::size_t(at[std::size_t(b)] * cells[std::size_t(a)] + at[std::size_t(a)])] = entry(
          t.group(at[2], at[1], at[0]), numbering.first[std::size_t(link.from)] + of_group, link.from, of_group, link.periodic);
    });
    t.values.resize(t.entries.size());
    t.sums.resize(std::size_t(flow.box.count()) * block_size + linear::block_overrun);
  }

  /// Calls body(cell, group) and, for each neighbour in another group, across(cell, side, entry).
  template <class Body, class Across>
  static void walk(const FlowTile& tile, const TileGroups& t, Body&& body, Across&& across) {
    const linear::CellBox& box = tile.box;
    const int extent[3] = {box.ni, box.nj, box.nk};
    std::ptrdiff_t cell = 0;
    for (int k = 0; k < box.nk; ++k)
      for (int j = 0; j < box.nj; ++j)
        for (int i = 0; i < box.ni; ++i, ++cell) {
          const int group = t.group(k, j, i), at[3] = {i, j, k};
          std::array<int, 6> entries;  // -2: same group, -1: none
          for (int d = 0; d < tile.directions; ++d)
            for (int end = 0; end < 2; ++end) {
              const int side = 2 * d + end, next = at[d] + (end ? 1 : -1);
              int& e = entries[std::size_t(side)];
              if (next < 0 || next >= extent[d]) {
                const int a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
                e = t.beyond[std::size_t(side)][std::size_t(at[b] * extent[a] + at[a])];
              } else {
                const auto& piece = t.piece_of[std::size_t(d)];
                e = piece[std::size_t(at[d])] == piece[std::size_t(next)] ? -2
                                                                          : t.inside[std::size_t(group)][std::size_t(side) + 1];
              }
            }
          body(cell, group, entries);
          for (int side = 0; side < 2 * tile.directions; ++side)
            if (entries[std::size_t(side)] >= 0) across(cell, side, entries[std::size_t(side)]);
        }
  }

  std::ptrdiff_t fill(FlowTile& tile, bool anew) override {
    TileGroups& t = of(tile);
    const MeanMatrix a = tile.mean();
    if (anew)
      for (auto& v : t.values) v.fill(0.0);
    walk(
        tile, t,
        [&](std::ptrdiff_t cell, int group, const std::array<int, 6>& entries) {
          std::array<float, block_size> sum;
          std::copy_n(a.block(cell, a.diagonal), block_size, sum.data());
          for (int side = 0; side < 2 * tile.directions; ++side) {
            if (entries[std::size_t(side)] != -2) continue;
            const auto* block = a.side(cell, side);
            for (int e = 0; e < block_size; ++e) sum[std::size_t(e)] += float(block[e]);
          }
          std::ranges::transform(sum, t.sums.begin() + cell * block_size,
                                 [](float number) { return linear::ShortFloat(number); });
          if (!anew) return;
          auto& value = t.values[std::size_t(t.inside[std::size_t(group)][0])];
          for (int e = 0; e < block_size; ++e) value[std::size_t(e)] += double(sum[std::size_t(e)]);
        },
        [&](std::ptrdiff_t cell, int side, int entry) {
          if (!anew) return;
          const auto* block = a.side(cell, side);
          auto& value = t.values[std::size_t(entry)];
          for (int e = 0; e < block_size; ++e) value[std::size_t(e)] += double(float(block[e]));
        });
    if (!anew) return -1;
    // Neighbours through a rotational period: their velocities turn before the block acts.
    for (std::size_t n = 0; n < t.entries.size(); ++n) {
      const Eigen::Matrix3d* turn = t.columns[std::size_t(t.entries[n].second)].turn;
      if (turn == nullptr) continue;
      const auto block = t.values[n];
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < width; ++r) {
          double sum = 0.0;
          for (int m = 0; m < 3; ++m) sum += block[std::size_t((m + 1) * width + r)] * (*turn)(m, c);
          t.values[n][std::size_t((c + 1) * width + r)] = sum;
        }
    }
    return -1;
  }

  std::size_t matrix_size(const FlowTile& tile) const override { return of(tile).values.size() * block_size; }
  void save_matrix(const FlowTile& tile, std::span<double> to) const override {
    double* at = to.data();
    for (const auto& block : of(tile).values) at = std::copy(block.begin(), block.end(), at);
  }
  void load_matrix(FlowTile& tile, std::span<const double> from) override {
    const double* at = from.data();
    for (auto& block : of(tile).values) std::copy_n(at, block_size, block.begin()), at += block_size;
  }

  void set_up(MPI_Comm comm) override {
    if (direct()) {
      runtime::Packer mine;
      std::vector<BlockElimination::Entry> entries;
      for (const TileGroups& t : tiles)
        for (std::size_t n = 0; n < t.entries.size(); ++n)
          entries.push_back({canonical[std::size_t(t.first + t.entries[n].first)],
                             t.columns[std::size_t(t.entries[n].second)].place.canonical, t.values[n]});
      if (runtime::ranks_in(comm) > 1) {
        mine.put(std::span<const BlockElimination::Entry>(entries));
        entries.clear();
        for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
          const auto part = runtime::Unpacker(bytes).many<BlockElimination::Entry>();
          entries.insert(entries.end(), part.begin(), part.end());
        }
        // As one process would have them: by row, each row's from one process in its order.
        std::ranges::stable_sort(entries, {}, &BlockElimination::Entry::row);
      }
      elimination.factorise(total, entries);
      all.assign(std::size_t(total) * width, 0.0);
      return;
    }
    SparseRows rows;
    rows.first = numbering.begin * width;
    std::vector<std::vector<std::pair<int, const double*>>> by_group(canonical.size());
    for (const TileGroups& t : tiles)
      for (std::size_t n = 0; n < t.entries.size(); ++n) {
        const GroupPlace& p = t.columns[std::size_t(t.entries[n].second)].place;
        by_group[std::size_t(t.first + t.entries[n].first)].emplace_back(number_of(p), t.values[n].data());
      }
    for (std::size_t g = 0; g < by_group.size(); ++g) {
      std::map<int, std::array<double, block_size>> row;  // a group met through two sides adds up
      for (const auto& [number, block] : by_group[g])
        for (std::size_t e = 0; e < block_size; ++e) row[number][e] += block[e];
      const int own = numbering.begin + int(g);
      for (int r = 0; r < width; ++r) {
        rows.columns.push_back(own * width + r), rows.values.push_back(row[own][std::size_t(r * width + r)]);
        for (const auto& [number, block] : row)
          for (int c = 0; c < width; ++c)
            if (number != own || c != r)
              rows.columns.push_back(number * width + c), rows.values.push_back(block[std::size_t(c * width + r)]);
        rows.begin.push_back(int(rows.columns.size()));
      }
    }
    multigrid.emplace(rows, MultigridOptions{.functions = width, .smoother = MultigridOptions::Smoother::ilu}, comm);
  }
  int number_of(const GroupPlace& p) const {
    // Canonical to global: the tile whose range has it.
    const int tile =
        int(std::upper_bound(canonical_first.begin(), canonical_first.end(), p.canonical) - canonical_first.begin()) - 1;
    return numbering.first[std::size_t(tile)] + p.canonical - canonical_first[std::size_t(tile)];
  }

  void solve_coarse(MPI_Comm comm) override {
    if (!direct()) {
      multigrid->cycle(right, left);
      exchange.fetch(numbering, left, width, outside, comm);
      return;
    }
    for (std::size_t n = 0; n < canonical.size(); ++n)
      std::copy_n(&right[n * width], width, &all[std::size_t(canonical[n]) * width]);
    if (runtime::ranks_in(comm) > 1) {
      runtime::Packer mine;
      mine.put(std::span<const int>(canonical)), mine.put(std::span<const double>(right));
      for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
        runtime::Unpacker from(bytes);
        const auto groups = from.many<int>();
        const auto values = from.many<double>();
        for (std::size_t n = 0; n < groups.size(); ++n)
          std::copy_n(&values[n * width], width, &all[std::size_t(groups[n]) * width]);
      }
    }
    elimination.solve(all, all);
  }

  void gather(FlowTile& tile, const float* v) override {
    const TileGroups& t = of(tile);
    double* sum = right.data() + std::size_t(t.first) * width;
    std::fill_n(sum, count_of(t.pieces) * width, 0.0);
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i, v += width)
          for (int n = 0; n < width; ++n) sum[t.group(k, j, i) * width + n] += double(v[n]);
  }

  void apply_coarse(const Piece& piece) override {
    FlowTile& tile = *piece.tile;
    TileGroups& t = of(tile);
    const MeanMatrix a = tile.mean();
    // Changes of the groups of this tile and of their neighbours, as floats.
    std::vector<std::array<float, 8>> y(t.columns.size());
    for (std::size_t c = 0; c < y.size(); ++c) {
      const double* from = values_of(t.columns[c].place);
      for (std::size_t n = 0; n < width; ++n) y[c][n] = float(from[n]);
      if (const Eigen::Matrix3d* turn = t.columns[c].turn) {
        const Eigen::Vector3d u = *turn * Eigen::Vector3d(from[1], from[2], from[3]);
        for (std::size_t n = 0; n < 3; ++n) y[c][n + 1] = float(u[Eigen::Index(n)]);
      }
    }
    const auto column_of = [&](int entry) { return std::size_t(t.entries[std::size_t(entry)].second); };
    std::ptrdiff_t in_sums = -1;
    linear::TwoSums<5> sums;
    const auto finish = [&] {
      if (in_sums < 0) return;
      float change[8];
      sums.total().store(change);
      for (int n = 0; n < width; ++n) piece.z[in_sums * width + n] = piece.v[in_sums * width + n] - change[n];
    };
    walk(
        tile, t,
        [&](std::ptrdiff_t cell, int group, const std::array<int, 6>&) {
          finish();
          sums = linear::TwoSums<5>{};
          sums.multiply_add(t.sums.data() + cell * block_size, y[column_of(t.inside[std::size_t(group)][0])].data());
          in_sums = cell;
        },
        [&](std::ptrdiff_t cell, int side, int entry) { sums.multiply_add(a.side(cell, side), y[column_of(entry)].data()); });
    finish();
    const std::size_t mean = std::size_t(tile.box.count()) * width;
    if (piece.z != piece.v) std::copy(piece.v + mean, piece.v + tile.vector_size(), piece.z + mean);
    ilu_->apply({&tile, piece.z, piece.z});
    std::ptrdiff_t cell = 0;
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i, ++cell) {
          const auto& change = y[column_of(t.inside[std::size_t(t.group(k, j, i))][0])];
          for (int n = 0; n < width; ++n) piece.z[cell * width + n] += change[std::size_t(n)];
        }
  }
};

}  // namespace coarse_parts

std::unique_ptr<Preconditioner> make_coarse_correction(const PreconditionerOptions& options) {
  return std::make_unique<coarse_parts::CoarseCorrection>(options);
}

int coarse_groups(const Tiling& tiling, int group_cells) {
  int groups = 0;
  for (const Tile& tile : tiling.tiles) groups += coarse_parts::count_of(coarse_parts::pieces_of(tile, group_cells));
  return groups;
}

std::optional<int> side_of_groups(const Tiling& tiling, int group_cells, int most_groups) {
  if (tiling.size() > most_groups) return std::nullopt;
  constexpr int longest = 64;  // of aero.flow.group_cells
  for (int side = group_cells; side > 0 && side <= longest; side *= 2)
    if (coarse_groups(tiling, side) <= most_groups) return side;
  return 0;
}

}  // namespace spindrift::aero
