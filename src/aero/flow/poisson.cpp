// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/poisson.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>

#include "runtime/executor/executor.hpp"
#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/halo.hpp"
#include "src/aero/flow/numbering.hpp"
#include "src/aero/hypre/multigrid.hpp"

namespace spindrift::aero {

namespace poisson_parts {

Eigen::Vector3d at_place(const double* data, std::ptrdiff_t place, std::ptrdiff_t component) {
  return {data[place], data[place + component], data[place + 2 * component]};
}

/// One tile: phi and its gradient with ghosts, what drives it, values on its boundaries.
struct PoissonTile {
  const Tile* from = nullptr;
  TileGeometry* geometry = nullptr;
  int index = 0;
  BoxLayout box;
  AlignedArray<double> phi, gradient, source;
  std::array<AlignedArray<double>, 6>
      given;  ///< by side, in the order of the window's cells: twice the value on the face; NaN where none
  int across(Side side, int u) const { return u * extent(along(side)[0]); }
  int extent(int d) const { return d == 0 ? box.ni : d == 1 ? box.nj : box.nk; }
  Eigen::Vector3d centre(std::ptrdiff_t place) const {
    return at_place(geometry->centre_data.data(), place, geometry->cell_box.component);
  }
};

/// A face between the cells `low` and `high` of one direction: area vector, two-point coefficient, what leans.
struct FaceTerms {
  double coefficient;
  Eigen::Vector3d leaning;
};
FaceTerms face_terms(const PoissonTile& t, int d, int k, int j, int i) {
  const TileGeometry& g = *t.geometry;
  const BoxLayout& box = g.face_box[std::size_t(d)];
  const Eigen::Vector3d area = at_place(g.face_data[std::size_t(d)].data(), box.at(k, j, i), box.component);
  const std::ptrdiff_t high = g.cell_box.at(k, j, i);
  const Eigen::Vector3d step = t.centre(high) - t.centre(high - g.cell_box.stride(d));
  const double along = area.dot(step);
  if (!(along > 0.0)) {
    if (area.isZero()) return {0.0, Eigen::Vector3d::Zero()};  // a face closed to a line
    throw std::runtime_error("poisson: block " + std::to_string(t.from->block) + ", tile cell (" + std::to_string(i) + ", " +
                             std::to_string(j) + ", " + std::to_string(k) +
                             "): the centres on both sides of a face do not lie across it");
  }
  const double coefficient = area.squaredNorm() / along;
  return {coefficient, area - coefficient * step};
}

template <class Body>
void for_cells_of(const PoissonTile& t, Body&& body) {
  for (int k = 0; k < t.box.nk; ++k)
    for (int j = 0; j < t.box.nj; ++j)
      for (int i = 0; i < t.box.ni; ++i) body(k, j, i);
}

}  // namespace poisson_parts
using namespace poisson_parts;

struct Poisson::Work {
  GridStore& grid;
  std::vector<bool> given;
  std::vector<PoissonTile> tiles;
  std::vector<int> local;
  int directions;
  Numbering numbering;
  std::optional<Multigrid> multigrid;
  std::vector<double> right, left, partials, sums{0.0};
  std::deque<std::vector<double>> buffers;
  double first = 0.0, reached = 1.0;
  int corrections = 0;
  bool done = false, failed = false;

  Work(GridStore& g, std::vector<bool> by_patch) : grid(g), given(std::move(by_patch)), directions(g.tiling().planar ? 2 : 3) {
    const Tiling& tiling = grid.tiling();
    if (std::ranges::none_of(tiling.boundaries, [&](const TileBoundary& b) { return given.at(std::size_t(b.patch)); }))
      throw std::invalid_argument("poisson: no boundary has a given value");
    numbering = number_points(grid, [](const Tile& t) { return int(t.count()); });
    local.assign(std::size_t(tiling.size()), -1);
    for (const int index : grid.owned()) {
      local[std::size_t(index)] = int(tiles.size());
      PoissonTile& t = tiles.emplace_back();
      t.from = &tiling.tiles[std::size_t(index)];
      t.geometry = &grid[index];
      t.index = index;
      t.box = cell_layout(*t.from, cell_ghosts, tiling.planar);  // as that of centres
      t.phi = AlignedArray<double>(t.box.size(1)), t.gradient = AlignedArray<double>(t.box.size(3)),
      t.source = AlignedArray<double>(t.box.size(1));
      for (const TileBoundary& b : tiling.boundary(index)) {
        if (!given[std::size_t(b.patch)]) continue;
        auto& side = t.given[std::size_t(b.side)];
        const auto [u, v] = along(b.side);
        if (side.size() == 0) {
          side = AlignedArray<double>(std::size_t(t.extent(u) * t.extent(v)));
          std::ranges::fill(side.span(), std::numeric_limits<double>::quiet_NaN());
        }
        for_boundary(t, b, [&](const Index&, const Index&, double& value) { value = 0.0; });
      }
    }
    right.resize(std::size_t(numbering.end - numbering.begin)), left.resize(right.size());
    partials.resize(tiles.size());
  }

  /// body(inside, ghost, twice the value) over a window with given values.
  template <class Body>
  static void for_boundary(PoissonTile& t, const TileBoundary& b, Body&& body) {
    const int d = direction_of(b.side);
    const auto [first, second] = along(b.side);
    auto& side = t.given[std::size_t(b.side)];
    double none = 0.0;
    for (int v = b.low[1]; v < b.high[1]; ++v)
      for (int u = b.low[0]; u < b.high[0]; ++u) {
        Index inside{};
        inside[std::size_t(first)] = u, inside[std::size_t(second)] = v,
        inside[std::size_t(d)] = at_end(b.side) ? t.extent(d) - 1 : 0;
        Index ghost = inside;
        ghost[std::size_t(d)] += at_end(b.side) ? 1 : -1;
        body(inside, ghost, side.size() > 0 ? side.data()[v * t.extent(first) + u] : none);
      }
  }
  template <class Body>
  void for_boundaries(PoissonTile& t, Body&& body) {
    for (const TileBoundary& b : grid.tiling().boundary(t.index))
      for_boundary(t, b, [&](const Index& inside, const Index& ghost, double& value) {
        body(given[std::size_t(b.patch)], t.box.at(inside[2], inside[1], inside[0]), t.box.at(ghost[2], ghost[1], ghost[0]),
             value, b.side, inside);
      });
  }

  /// The ghost's centre is the inner one mirrored in the face's plane: the value there is linear through the foot between both.
  void fill_values(PoissonTile& t) {
    double* phi = t.phi.data();
    for_boundaries(t, [&](bool fixed, std::ptrdiff_t inside, std::ptrdiff_t ghost, double twice, Side, const Index&) {
      phi[ghost] = fixed ? twice - phi[inside] : phi[inside];
    });
  }
  void fill_gradients(PoissonTile& t) {
    for_boundaries(t, [&](bool, std::ptrdiff_t inside, std::ptrdiff_t ghost, double, Side, const Index&) {
      for (int c = 0; c < 3; ++c)
        t.gradient.data()[ghost + c * t.box.component] = t.gradient.data()[inside + c * t.box.component];
    });
  }
  /// Green and Gauss, values on faces linear between the centres: near walls cells grow from one to the next.
  void slopes(PoissonTile& t) {
    const TileGeometry& g = *t.geometry;
    for_cells_of(t, [&](int k, int j, int i) {
      const std::ptrdiff_t here = t.box.at(k, j, i);
      const Eigen::Vector3d centre = t.centre(g.cell_box.at(k, j, i));
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int d = 0; d < directions; ++d)
        for (const int end : {0, 1}) {
          const int kf = k + end * (d == 2), jf = j + end * (d == 1), fi = i + end * (d == 0);
          const BoxLayout& box = g.face_box[std::size_t(d)];
          const Eigen::Vector3d area = at_place(g.face_data[std::size_t(d)].data(), box.at(kf, jf, fi), box.component);
          const std::ptrdiff_t step = (end ? 1 : -1) * t.box.stride(d);
          const double across = area.dot(t.centre(g.cell_box.at(k, j, i) + (end ? 1 : -1) * g.cell_box.stride(d)) - centre);
          const double share = across == 0.0 ? 0.5 : area.dot(face_centre(g, Side(2 * d + end), k, j, i) - centre) / across;
          sum += (end ? 1.0 : -1.0) * share * (t.phi.data()[here + step] - t.phi.data()[here]) * area;
        }
      sum /= g.volume_data.data()[g.cell_box.at(k, j, i)];
      for (int c = 0; c < 3; ++c) t.gradient.data()[here + c * t.box.component] = sum[c];
    });
  }
  /// source V + what flows in, for the rows of this tile; returns the sum of squares per volume.
  double residual(PoissonTile& t) {
    double* r = right.data() + (numbering.first[std::size_t(t.index)] - numbering.begin);
    const TileGeometry& g = *t.geometry;
    double squares = 0.0;
    for_cells_of(t, [&](int k, int j, int i) {
      const std::ptrdiff_t here = t.box.at(k, j, i);
      const auto flux = [&](int d, int kf, int jf, int if_) {
        const FaceTerms f = face_terms(t, d, kf, jf, if_);
        const std::ptrdiff_t high = t.box.at(kf, jf, if_), low = high - t.box.stride(d);
        const Eigen::Vector3d slope =
            0.5 * (at_place(t.gradient.data(), low, t.box.component) + at_place(t.gradient.data(), high, t.box.component));
        return f.coefficient * (t.phi.data()[high] - t.phi.data()[low]) + f.leaning.dot(slope);
      };
      const double volume = g.volume_data.data()[g.cell_box.at(k, j, i)];
      double sum = volume * t.source.data()[here];
      for (int d = 0; d < directions; ++d) sum += flux(d, k + (d == 2), j + (d == 1), i + (d == 0)) - flux(d, k, j, i);
      *r++ = sum;
      squares += sum * sum / volume;
    });
    return squares;
  }

  SparseRows matrix() {
    SparseRows rows;
    rows.first = numbering.begin;
    for (PoissonTile& t : tiles) {
      const Index cells = t.from->cells();
      const auto number = [&](int tile, const Index& n, const Index& at) {
        return numbering.first[std::size_t(tile)] + (at[2] * n[1] + at[1]) * n[0] + at[0];
      };
      // Beyond the tile's sides: another tile's cell, or a value given (-2) or no flux (-1).
      std::array<std::vector<int>, 6> beyond;
      for (int s = 0; s < 6; ++s) {
        const auto [a, b] = along(Side(s));
        beyond[std::size_t(s)].assign(std::size_t(t.extent(a) * t.extent(b)), -1);
      }
      const auto slot = [&](Side side, const Index& at) -> int& {
        const auto [a, b] = along(side);
        return beyond[std::size_t(side)][std::size_t(at[std::size_t(b)] * t.extent(a) + at[std::size_t(a)])];
      };
      for_neighbours(grid.tiling(), t.index, [&](const GhostLink& link, const Index& inside, const Index& donor) {
        slot(link.side, inside) = number(link.from, grid.tiling().tiles[std::size_t(link.from)].cells(), donor);
      });
      for_boundaries(t, [&](bool fixed, std::ptrdiff_t, std::ptrdiff_t, double, Side side, const Index& inside) {
        if (fixed) slot(side, inside) = -2;
      });
      for_cells_of(t, [&](int k, int j, int i) {
        const Index at{i, j, k};
        const std::size_t diagonal = rows.columns.size();
        rows.columns.push_back(number(t.index, cells, at)), rows.values.push_back(0.0);
        for (int s = 0; s < 2 * directions; ++s) {
          const int d = s / 2, end = s % 2;
          const double c = face_terms(t, d, k + end * (d == 2), j + end * (d == 1), i + end * (d == 0)).coefficient;
          Index other = at;
          other[std::size_t(d)] += end ? 1 : -1;
          int column;
          if (other[std::size_t(d)] >= 0 && other[std::size_t(d)] < cells[std::size_t(d)])
            column = number(t.index, cells, other);
          else
            column = slot(Side(s), at);
          if (column == -1 || c == 0.0) continue;
          rows.values[diagonal] += column == -2 ? 2.0 * c : c;
          if (column < 0) continue;
          // Two faces to the same cell (a period of one or two cells) are one entry.
          const auto first = rows.columns.begin() + std::ptrdiff_t(diagonal),
                     found = std::find(first, rows.columns.end(), column);
          if (found != rows.columns.end())
            rows.values[std::size_t(found - rows.columns.begin())] -= c;
          else
            rows.columns.push_back(column), rows.values.push_back(-c);
        }
        rows.begin.push_back(int(rows.columns.size()));
      });
    }
    return rows;
  }

  void record(runtime::Graph& graph, const PoissonOptions& o) {
    using namespace runtime;
    const auto phi = graph.data(tiles.size()), ghosts = graph.data(tiles.size()), gradients = graph.data(tiles.size()),
               gradient_ghosts_of = graph.data(tiles.size()), residuals = graph.data(tiles.size());
    const Datum sum = graph.datum(), decision = graph.datum(), change = graph.datum();
    const auto of = [&](const char* path, std::size_t n) { return std::string(path) + "/" + std::to_string(tiles[n].index); };
    const auto layout = [this](const Tile& t) { return cell_layout(t, cell_ghosts, grid.tiling().planar); };
    const auto tile_at = [this](int t) -> PoissonTile& { return tiles[std::size_t(local[std::size_t(t)])]; };
    const auto always = [] { return true; };
    const HaloField<double> centres{"aero/poisson/centres",
                                    [this](int t) { return grid[t].centre(); },
                                    layout,
                                    {Quantity::point},
                                    cell_ghosts,
                                    &phi,
                                    &ghosts,
                                    31,
                                    &grid.tiling().periodic};
    record_halo<double>(graph, grid, local, centres, buffers, always, [](int) {}, {});
    graph.collective(
        "aero/poisson/multigrid",
        [&] {
          Uses uses{writes(change)};
          uses.push_back(reads(ghosts));
          return uses;
        }(),
        [this](MPI_Comm comm) { multigrid.emplace(matrix(), MultigridOptions{}, comm); });
    graph.loop("aero/poisson/corrections", {.min = 1, .max = std::uint32_t(o.most) + 1}, [&] {
      const HaloField<double> values{"aero/poisson/ghosts",
                                     [tile_at](int t) {
                                       return BoxView<double>{tile_at(t).phi.data(), tile_at(t).box};
                                     },
                                     layout,
                                     {Quantity::scalar},
                                     1,
                                     &phi,
                                     &ghosts,
                                     32,
                                     &grid.tiling().periodic};
      record_halo<double>(graph, grid, local, values, buffers, always, [this](int n) { fill_values(tiles[std::size_t(n)]); }, {});
      for (std::size_t n = 0; n < tiles.size(); ++n)
        graph.task(of("aero/poisson/gradient", n), {reads(phi[n]), reads(ghosts[n]), writes(gradients[n])},
                   [this, n] { slopes(tiles[n]); });
      const HaloField<double> slope{"aero/poisson/gradient_ghosts",
                                    [tile_at](int t) {
                                      return BoxView<double>{tile_at(t).gradient.data(), tile_at(t).box};
                                    },
                                    layout,
                                    {Quantity::vector},
                                    1,
                                    &gradients,
                                    &gradient_ghosts_of,
                                    33,
                                    &grid.tiling().periodic};
      record_halo<double>(graph, grid, local, slope, buffers, always, [this](int n) { fill_gradients(tiles[std::size_t(n)]); },
                          {});
      for (std::size_t n = 0; n < tiles.size(); ++n)
        graph.task(of("aero/poisson/residual", n),
                   {reads(phi[n]), reads(ghosts[n]), reads(gradients[n]), reads(gradient_ghosts_of[n]), writes(residuals[n])},
                   [this, n] { partials[n] = residual(tiles[n]); });
      Uses partial{writes(sum)};
      partial.push_back(reads(residuals));
      graph.reduce("aero/poisson/norm", partial, {.partials = partials, .result = sums});
      graph.task("aero/poisson/judge", {reads(sum), updates(decision)}, [this, o] {
        const double norm = std::sqrt(sums[0]);
        if (corrections == 0) first = norm;
        reached = first > 0.0 ? norm / first : 0.0;
        failed = !std::isfinite(norm) || (reached > o.drop && corrections >= o.most);
        done = failed || reached <= o.drop;
      });
      Uses all{reads(decision), updates(change)};
      all.push_back(reads(residuals));
      for (const Datum d : phi) all.push_back(updates(d));
      graph.collective("aero/poisson/correct", all, [this](MPI_Comm) { correct(); });
      graph.until("aero/poisson/enough", {reads(decision)}, [this] { return done; });
    });
  }
  void correct() {
    if (done) return;
    ++corrections;
    std::ranges::fill(left, 0.0);
    multigrid->solve(right, left, 0.02, 20);  // what it leaves, the next correction sees
    for (PoissonTile& t : tiles) {
      const double* change = left.data() + (numbering.first[std::size_t(t.index)] - numbering.begin);
      for_cells_of(t, [&](int k, int j, int i) { t.phi.data()[t.box.at(k, j, i)] += *change++; });
    }
  }
};

Poisson::Poisson(GridStore& grid, std::vector<bool> given) : work_(std::make_unique<Work>(grid, std::move(given))) {}
Poisson::~Poisson() = default;

void Poisson::set_source(const Field& source) {
  for (PoissonTile& t : work_->tiles)
    for_cells_of(
        t, [&](int k, int j, int i) { t.source.data()[t.box.at(k, j, i)] = source(t.centre(t.geometry->cell_box.at(k, j, i))); });
}
void Poisson::set_boundary(const Field& phi) {
  for (PoissonTile& t : work_->tiles)
    work_->for_boundaries(t, [&](bool fixed, std::ptrdiff_t inside, std::ptrdiff_t ghost, double& twice, Side, const Index&) {
      if (fixed) twice = 2.0 * phi(0.5 * (t.centre(inside) + t.centre(ghost)));
    });
}
void Poisson::solve(const PoissonOptions& options, MPI_Comm comm, int threads) {
  Work& w = *work_;
  w.corrections = 0, w.done = w.failed = false;
  runtime::Graph graph(comm);
  w.record(graph, options);
  runtime::Executor(std::move(graph), {.threads = threads}).run();
  w.multigrid.reset();
  w.buffers.clear();
  if (w.failed)
    throw std::runtime_error("poisson: the residual fell by " + std::to_string(w.reached) + " only (asked for " +
                             std::to_string(options.drop) + ") in " + std::to_string(w.corrections) +
                             " corrections; cells may lean too much");
}
int Poisson::corrections() const { return work_->corrections; }
double Poisson::residual_drop() const { return work_->reached; }
double Poisson::phi(int tile, int k, int j, int i) const {
  const PoissonTile& t = work_->tiles[std::size_t(work_->local[std::size_t(tile)])];
  return t.phi.data()[t.box.at(k, j, i)];
}
Eigen::Vector3d Poisson::gradient(int tile, int k, int j, int i) const {
  const PoissonTile& t = work_->tiles[std::size_t(work_->local[std::size_t(tile)])];
  return at_place(t.gradient.data(), t.box.at(k, j, i), t.box.component);
}

void fill_wall_distance_by_poisson(GridStore& grid, std::span<const std::string> walls, MPI_Comm comm) {
  const Tiling& tiling = grid.tiling();
  std::vector<bool> given(tiling.patches.size(), false);
  bool any = false;
  for (const std::string& wall : walls)
    if (const int p = tiling.patch(wall); p >= 0) given[std::size_t(p)] = any = true;
  if (!any) return;
  Poisson problem(grid, given);
  problem.set_source([](const Eigen::Vector3d&) { return 1.0; });
  problem.solve({.drop = 1e-6}, comm);
  for (const int tile : grid.owned()) {
    BoxView<double> distance = grid[tile].wall_distance();
    for (int k = 0; k < distance.layout.nk; ++k)
      for (int j = 0; j < distance.layout.nj; ++j)
        for (int i = 0; i < distance.layout.ni; ++i) {
          const double phi = problem.phi(tile, k, j, i), slope = problem.gradient(tile, k, j, i).norm();
          if (!(phi > 0.0))
            throw std::runtime_error("poisson: no distance from walls in tile " + std::to_string(tile) + ", cell (" +
                                     std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k) +
                                     "); the exact one has no such limit");
          distance(0, k, j, i) = 2.0 * phi / (std::sqrt(slope * slope + 2.0 * phi) + slope);  // no difference of near numbers
        }
  }
}

}  // namespace spindrift::aero
