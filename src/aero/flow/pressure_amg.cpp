// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/pressure_amg.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/aero/flow/ilu_after_coarse.hpp"
#include "src/aero/flow/numbering.hpp"
#include "src/aero/hypre/multigrid.hpp"

namespace spindrift::aero {

namespace pressure_parts {

struct PressureTile {
  int first = 0;                            ///< offset of the first cell among this process's
  std::array<std::vector<int>, 6> beyond;   ///< by face of a side: global number of the cell there; -1 where a boundary
  std::array<std::vector<int>, 6> outside;  ///< likewise: its position among values of other processes; -1 where here
  std::vector<float> weights;               ///< [cell][5]
  std::vector<float> rows;                  ///< [cell][1 + sides]: the pressure equation
};

struct PressureAmg final : IluAfterCoarse {
  using IluAfterCoarse::IluAfterCoarse;
  Numbering numbering;
  std::vector<int> local;
  std::vector<PressureTile> tiles;
  std::vector<FlowTile*> flow;
  std::vector<double> right, pressure, other;
  OutsideValues exchange;
  std::optional<Multigrid> multigrid;

  PressureTile& of(const FlowTile& tile) { return tiles[std::size_t(local[std::size_t(tile.index)])]; }
  const PressureTile& of(const FlowTile& tile) const { return tiles[std::size_t(local[std::size_t(tile.index)])]; }

  bool knows_ranks() const override { return true; }  // multigrid
  void attach(GridStore& grid, std::span<FlowTile> all) override {
    const Tiling& tiling = grid.tiling();
    numbering = number_points(grid, [](const Tile& t) { return int(t.count()); });
    local.assign(tiling.tiles.size(), -1);
    tiles.resize(all.size());
    right.resize(std::size_t(numbering.end - numbering.begin)), pressure.resize(right.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
      FlowTile& f = all[n];
      PressureTile& t = tiles[n];
      flow.push_back(&f);
      local[std::size_t(f.index)] = int(n);
      t.first = numbering.first[std::size_t(f.index)] - numbering.begin;
      const Index cells = tiling.tiles[std::size_t(f.index)].cells();
      for (int s = 0; s < 6; ++s) {
        const auto [a, b] = along(Side(s));
        const std::size_t faces = std::size_t(cells[std::size_t(a)]) * std::size_t(cells[std::size_t(b)]);
        t.beyond[std::size_t(s)].assign(faces, -1), t.outside[std::size_t(s)].assign(faces, -1);
      }
      for_neighbours(tiling, f.index, [&](const GhostLink& link, const Index& at, const Index& donor) {
        const auto [a, b] = along(link.side);
        const std::size_t face = std::size_t(at[std::size_t(b)] * cells[std::size_t(a)] + at[std::size_t(a)]);
        const Index c = tiling.tiles[std::size_t(link.from)].cells();
        const int number = numbering.first[std::size_t(link.from)] + (donor[2] * c[1] + donor[1]) * c[0] + donor[0];
        t.beyond[std::size_t(link.side)][face] = number;
        if (!numbering.here(number)) t.outside[std::size_t(link.side)][face] = exchange.want(number);
      });
      t.weights.resize(std::size_t(f.box.count()) * mean_unknowns);
      t.rows.resize(std::size_t(f.box.count()) * std::size_t(1 + 2 * f.directions));
    }
  }

  /// Weights w of each cell's rows: the pressure row of its inverted diagonal block, and the pressure equation they make.
  std::ptrdiff_t fill(FlowTile& tile, bool anew) override {
    std::ptrdiff_t singular = -1;
    PressureTile& t = of(tile);
    const linear::StencilMatrix<5> a = tile.mean();
    const int sides = 2 * tile.directions;
    float* row = t.rows.data();
    for (std::ptrdiff_t cell = 0; cell < tile.box.count(); ++cell) {
      float inverse[25 + linear::block_overrun];
      if (!linear::invert<5>(a.block(cell, 0), inverse)) {
        if (singular < 0) singular = cell;
        continue;
      }
      float* w = t.weights.data() + cell * mean_unknowns;
      for (int r = 0; r < mean_unknowns; ++r) w[r] = inverse[r * mean_unknowns];
      if (!anew) continue;
      // Momentum by velocity in this cell.
      Eigen::Matrix3f momentum;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) momentum(r, c) = a.block(cell, 0)[(c + 1) * mean_unknowns + r + 1];
      const Eigen::Matrix3f to_velocity = momentum.inverse();
      float* diagonal = row;
      *row++ = 1.0f;  // w times the diagonal block's first column
      for (int side = 0; side < sides; ++side) {
        const float* block = a.block(cell, linear::StencilMatrix<5>::sides + side);
        const auto combined = [&](int column) {
          float sum = 0.0f;
          for (int r = 0; r < mean_unknowns; ++r) sum += w[r] * block[column * mean_unknowns + r];
          return sum;
        };
        // A pressure there drives a velocity here, and that a mass flux: over two faces a stencil twice as wide, whose
        // checkerboards multigrid would coarsen apart; over one face the same Laplacian is four times the product.
        const Eigen::Vector3f by_velocity(combined(1), combined(2), combined(3)), by_pressure(block[1], block[2], block[3]);
        const float driven = 4.0f * by_velocity.dot(to_velocity * by_pressure);
        *row++ = combined(0) - driven;
        *diagonal += driven;
      }
    }
    return singular;
  }

  template <class Body>
  static void for_sides(const FlowTile& tile, Body&& body) {
    const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
    std::ptrdiff_t cell = 0;
    for (int k = 0; k < extent[2]; ++k)
      for (int j = 0; j < extent[1]; ++j)
        for (int i = 0; i < extent[0]; ++i, ++cell) {
          const int at[3] = {i, j, k};
          for (int side = 0; side < 2 * tile.directions; ++side) {
            const int d = side / 2, next = at[d] + (side % 2 ? 1 : -1);
            const int a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
            const bool out = next < 0 || next >= extent[d];
            body(cell, side, out ? at[b] * extent[a] + at[a] : -1, cell + (side % 2 ? 1 : -1) * tile.box.stride(d));
          }
        }
  }

  std::size_t matrix_size(const FlowTile& tile) const override { return of(tile).rows.size(); }
  void save_matrix(const FlowTile& tile, std::span<double> to) const override { std::ranges::copy(of(tile).rows, to.begin()); }
  void load_matrix(FlowTile& tile, std::span<const double> from) override {
    std::ranges::transform(from, of(tile).rows.begin(), [](double v) { return float(v); });
  }

  void set_up(MPI_Comm comm) override {
    SparseRows rows;
    rows.first = numbering.begin;
    rows.begin.reserve(right.size() + 1), rows.columns.reserve(right.size() * 7), rows.values.reserve(right.size() * 7);
    for (std::size_t n = 0; n < tiles.size(); ++n) {
      const FlowTile& f = *flow[n];
      const PressureTile& t = tiles[n];
      const int stride = 1 + 2 * f.directions, first = numbering.begin + t.first;
      std::ptrdiff_t last = -1;
      std::size_t begin = 0;
      for_sides(f, [&](std::ptrdiff_t cell, int side, int face, std::ptrdiff_t neighbour) {
        const float* row = t.rows.data() + cell * stride;
        if (cell != last) {
          if (last >= 0) rows.begin.push_back(int(rows.columns.size()));
          begin = rows.columns.size();
          rows.columns.push_back(first + int(cell)), rows.values.push_back(double(row[0]));
          last = cell;
        }
        const int column = face < 0 ? first + int(neighbour) : t.beyond[std::size_t(side)][std::size_t(face)];
        if (column < 0) return;
        const auto found = std::find(rows.columns.begin() + std::ptrdiff_t(begin), rows.columns.end(), column);
        if (found != rows.columns.end())
          rows.values[std::size_t(found - rows.columns.begin())] += double(row[1 + side]);
        else
          rows.columns.push_back(column), rows.values.push_back(double(row[1 + side]));
      });
      rows.begin.push_back(int(rows.columns.size()));
    }
    multigrid.emplace(rows, MultigridOptions{}, comm);
  }

  void gather(FlowTile& tile, const float* v) override {
    const PressureTile& t = of(tile);
    const float* w = t.weights.data();
    double* r = right.data() + t.first;
    for (std::ptrdiff_t cell = 0; cell < tile.box.count(); ++cell, w += mean_unknowns, v += mean_unknowns) {
      float sum = 0.0f;
      for (int c = 0; c < mean_unknowns; ++c) sum += w[c] * v[c];
      r[cell] = double(sum);
    }
  }

  void solve_coarse(MPI_Comm comm) override {
    multigrid->cycle(right, pressure);
    exchange.fetch(numbering, pressure, 1, other, comm);
  }

  void apply_coarse(const Piece& piece) override {
    FlowTile& tile = *piece.tile;
    const PressureTile& t = of(tile);
    const linear::StencilMatrix<5> a = tile.mean();
    const double* p = pressure.data() + t.first;
    if (piece.z != piece.v) std::copy_n(piece.v, tile.vector_size(), piece.z);
    const auto subtract = [&](std::ptrdiff_t cell, const float* block, double by) {
      for (int r = 0; r < mean_unknowns; ++r) piece.z[cell * mean_unknowns + r] -= block[r] * float(by);
    };
    std::ptrdiff_t last = -1;
    for_sides(tile, [&](std::ptrdiff_t cell, int side, int face, std::ptrdiff_t neighbour) {
      if (cell != last) subtract(cell, a.block(cell, 0), p[cell]), last = cell;
      double value;
      if (face < 0) {
        value = p[neighbour];
      } else {
        const int number = t.beyond[std::size_t(side)][std::size_t(face)],
                  position = t.outside[std::size_t(side)][std::size_t(face)];
        if (number < 0) return;
        value = position < 0 ? pressure[std::size_t(number - numbering.begin)] : other[std::size_t(position)];
      }
      subtract(cell, a.block(cell, linear::StencilMatrix<5>::sides + side), value);
    });
    ilu_->apply({&tile, piece.z, piece.z});
    for (std::ptrdiff_t cell = 0; cell < tile.box.count(); ++cell) piece.z[cell * mean_unknowns] += float(p[cell]);
  }
};

}  // namespace pressure_parts

std::unique_ptr<Preconditioner> make_pressure_amg(const PreconditionerOptions& options) {
  return std::make_unique<pressure_parts::PressureAmg>(options);
}

}  // namespace spindrift::aero
