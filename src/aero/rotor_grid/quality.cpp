// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/quality.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "src/aero/grid/index_map.hpp"

namespace spindrift::aero {

namespace {

using Eigen::Vector3d;

constexpr double skewed_below = 0.4;

void higher(Extreme& worst, double value, int block, int k, int j, int i) {
  if (value > worst.value || worst.block < 0) worst = {value, block, k, j, i, {}};
}
void merge_high(Extreme& a, const Extreme& b) {
  if (b.block >= 0) higher(a, b.value, b.block, b.k, b.j, b.i);
}

/// Angle [deg] off a direction, without loss of digits near zero.
double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) / radians_per_degree;
}

/// One block, one cell at a time.
class BlockMeter {
 public:
  BlockMeter(const Block& block, int number) : b_(block), number_(number) {}

  void slab(int k, RotorGridQuality& q) const {
    for (int j = 0; j < b_.nj; ++j)
      for (int i = 0; i < b_.ni; ++i) cell(k, j, i, q);
  }
  /// Of the face of a wall: `side` is the block's side.
  void wall(Side side, int k, int j, int i, RotorGridQuality& q, std::vector<double>& angles) const {
    const int d = direction_of(side);
    const bool end = at_end(side);
    const auto [face, normal] = quad(d, k, j, i, end);
    const auto [opposite, unused] = quad(d, k, j, i, !end);
    (void)unused;
    const double off = angle(normal, opposite - face), height = std::abs(normal.normalized().dot(opposite - face));
    angles.push_back(off);
    higher(q.wall_orthogonality, off, number_, k, j, i);
    q.first_cell_low = q.first_cell_low == 0.0 ? height : std::min(q.first_cell_low, height);
    q.first_cell_high = std::max(q.first_cell_high, height);
  }
  /// Along the line of cells that begins at a wall's face.
  void line(Side side, int k, int j, int i, RotorGridQuality& q) const {
    const int d = direction_of(side), n = b_.cells()[std::size_t(d)];
    Index at{i, j, k};
    double last = 0.0;
    for (int m = 0; m < n; ++m) {
      at[std::size_t(d)] = at_end(side) ? n - 1 - m : m;
      const double size = edge(d, at[2], at[1], at[0]).norm();
      if (m > 0) higher(q.wall_growth, std::max(size / last, last / size), number_, at[2], at[1], at[0]);
      last = size;
    }
  }

 private:
  const Vector3d& node(int k, int j, int i) const { return b_.nodes[b_.node(k, j, i)]; }
  Vector3d edge(int d, int k, int j, int i) const { return node(k + (d == 2), j + (d == 1), i + (d == 0)) - node(k, j, i); }
  /// Middle and area vector of the face of cell (k, j, i) across d, at its end or its beginning.
  std::pair<Vector3d, Vector3d> quad(int d, int k, int j, int i, bool end) const {
    const int dk = d == 2 && end, dj = d == 1 && end, di = d == 0 && end;
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    const auto at = [&](int u, int v) -> const Vector3d& {
      Index s{i + di, j + dj, k + dk};
      s[std::size_t(a)] += u, s[std::size_t(b)] += v;
      return node(s[2], s[1], s[0]);
    };
    return {0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)), 0.5 * (at(1, 1) - at(0, 0)).cross(at(0, 1) - at(1, 0))};
  }

  void cell(int k, int j, int i, RotorGridQuality& q) const {
    std::array<std::array<Vector3d, 4>, 3> e;  // edges by direction
    std::array<std::array<double, 4>, 3> length{};
    for (int d = 0; d < 3; ++d)
      for (int c = 0; c < 4; ++c) {
        const int u = c & 1, v = c >> 1;
        Vector3d& x = e[std::size_t(d)][std::size_t(c)];
        x = d == 0 ? edge(0, k + v, j + u, i) : d == 1 ? edge(1, k + v, j, i + u) : edge(2, k, j + v, i + u);
        length[std::size_t(d)][std::size_t(c)] = x.norm();
      }
    double worst = 2.0;
    for (int c = 0; c < 8; ++c) {
      const int di = c & 1, dj = c >> 1 & 1, dk = c >> 2;
      const std::size_t a = std::size_t(dj + 2 * dk), b = std::size_t(di + 2 * dk), g = std::size_t(di + 2 * dj);
      worst = std::min(worst, e[0][a].dot(e[1][b].cross(e[2][g])) / (length[0][a] * length[1][b] * length[2][g]));
    }
    if (!(worst > 0.0)) ++q.folded;
    if (worst < skewed_below) ++q.skewed;
    neighbours(k, j, i, q);
  }

  void neighbours(int k, int j, int i, RotorGridQuality& q) const {
    for (int d = 0; d < 3; ++d) {
      const int K = k + (d == 2), J = j + (d == 1), I = i + (d == 0);
      if (K >= b_.nk || J >= b_.nj || I >= b_.ni) continue;
      const double a = edge(d, k, j, i).norm(), b = edge(d, K, J, I).norm();
      higher(q.stretch[std::size_t(d)], std::max(a / b, b / a), number_, k, j, i);
    }
  }

  const Block& b_;
  int number_;
};

/// Node of `to` that the node `at` of `from` is.
Index met(const Connection& c, const Block& to, const Index& at) {
  Index node{};
  const int across = direction_of(c.from.side);
  int t = 0;
  for (int d = 0; d < 3; ++d) {
    const int axis = std::abs(c.orientation[std::size_t(d)]) - 1;
    const Index n = to.cells();
    if (d == across) {
      node[std::size_t(axis)] = at_end(c.to.side) ? n[std::size_t(axis)] : 0;
      continue;
    }
    const int s = direction_of(c.to.side), along_low = s == 0 ? 1 : 0;
    const std::size_t which = axis == along_low ? 0 : 1;
    const int offset = at[std::size_t(d)] - c.from.low[std::size_t(t++)];
    node[std::size_t(axis)] = c.orientation[std::size_t(d)] > 0 ? c.to.low[which] + offset : c.to.high[which] - offset;
  }
  return node;
}

double gap(const MultiBlockGrid& grid, const Connection& c) {
  const Block &from = grid.blocks[std::size_t(c.from.block)], &to = grid.blocks[std::size_t(c.to.block)];
  const int across = direction_of(c.from.side), a = across == 0 ? 1 : 0, b = across == 2 ? 1 : 2;
  double worst = 0.0;
  for (int v = c.from.low[1]; v <= c.from.high[1]; ++v)
    for (int u = c.from.low[0]; u <= c.from.high[0]; ++u) {
      Index at{};
      at[std::size_t(across)] = at_end(c.from.side) ? from.cells()[std::size_t(across)] : 0;
      at[std::size_t(a)] = u, at[std::size_t(b)] = v;
      const Index there = met(c, to, at);
      Vector3d p = from.nodes[from.node(at[2], at[1], at[0])];
      if (c.periodic) p = c.periodic->rotation * p + c.periodic->translation;
      worst = std::max(worst, (to.nodes[to.node(there[2], there[1], there[0])] - p).norm());
    }
  return worst;
}

std::string place(const MultiBlockGrid& grid, const Extreme& e) {
  if (e.block < 0) return "";
  return fmt::format("{} ({}, {}, {})", grid.blocks[std::size_t(e.block)].name, e.i, e.j, e.k);
}

/// Of walls: angles between their normals and the lines that leave them go to `angles`.
void at_wall(const Block& block, const Window& w, RotorGridQuality& q, std::vector<double>& angles) {
  const BlockMeter meter(block, w.block);
  const int d = direction_of(w.side), a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
  for (int v = w.low[1]; v < w.high[1]; ++v)
    for (int u = w.low[0]; u < w.high[0]; ++u) {
      Index at{};
      at[std::size_t(d)] = at_end(w.side) ? block.cells()[std::size_t(d)] - 1 : 0;
      at[std::size_t(a)] = u, at[std::size_t(b)] = v;
      meter.wall(w.side, at[2], at[1], at[0], q, angles);
      meter.line(w.side, at[2], at[1], at[0], q);
    }
}

/// But for the general report. `windows`: where walls are.
RotorGridQuality quality_of(const MultiBlockGrid& grid, const std::vector<int>& first, const std::vector<int>& count,
                            const std::vector<Window>& windows) {
  std::vector<std::pair<int, int>> slabs;
  for (int b = 0; b < int(grid.blocks.size()); ++b)
    for (int k = 0; k < count[std::size_t(b)]; ++k) slabs.emplace_back(b, k);
  std::vector<RotorGridQuality> parts(slabs.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t s = 0; s < slabs.size(); ++s)
    BlockMeter(grid.blocks[std::size_t(slabs[s].first)], slabs[s].first).slab(slabs[s].second, parts[s]);
  RotorGridQuality q;
  for (const RotorGridQuality& part : parts) merge(q, part);
  std::vector<double> angles;
  for (const Window& w : windows) at_wall(grid.blocks[std::size_t(w.block)], w, q, angles);
  if (!angles.empty()) {
    const auto middle = angles.begin() + std::ptrdiff_t(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    q.wall_orthogonality_median = *middle;
  }
  for (const Connection& c : grid.connections) q.interface_gap = std::max(q.interface_gap, gap(grid, c));
  for (const Block& b : grid.blocks)
    for (const Vector3d& p : b.nodes) q.reach = std::max(q.reach, p.lpNorm<Eigen::Infinity>());
  for (Extreme* e : {&q.stretch[0], &q.stretch[1], &q.stretch[2], &q.wall_growth, &q.wall_orthogonality})
    if (e->block >= 0) e->k += first[std::size_t(e->block)];
  return q;
}

bool is_wall(const Boundary& boundary, const std::vector<std::string>& walls) {
  return std::any_of(walls.begin(), walls.end(), [&](const std::string& w) { return boundary.patch.starts_with(w); });
}

}  // namespace

void merge(RotorGridQuality& all, const RotorGridQuality& part) {
  merge(all.general, part.general);
  all.folded += part.folded, all.skewed += part.skewed;
  for (std::size_t d = 0; d < 3; ++d) merge_high(all.stretch[d], part.stretch[d]);
  merge_high(all.wall_growth, part.wall_growth), merge_high(all.wall_orthogonality, part.wall_orthogonality);
  if (part.first_cell_low > 0.0)
    all.first_cell_low = all.first_cell_low == 0.0 ? part.first_cell_low : std::min(all.first_cell_low, part.first_cell_low);
  all.first_cell_high = std::max(all.first_cell_high, part.first_cell_high);
  all.interface_gap = std::max(all.interface_gap, part.interface_gap), all.reach = std::max(all.reach, part.reach);
}

RotorGridQuality rotor_grid_quality(const MultiBlockGrid& grid, const std::vector<std::string>& walls) {
  std::vector<int> all;
  for (const Block& b : grid.blocks) all.push_back(b.nk);
  std::vector<Window> windows;
  for (const Boundary& boundary : grid.boundaries)
    if (is_wall(boundary, walls)) windows.push_back(boundary.where);
  RotorGridQuality q = quality_of(grid, std::vector<int>(all.size(), 0), all, windows);
  q.general = grid_quality(grid);
  return q;
}

RotorGridQuality rotor_grid_quality(const GridLayers& part, const std::vector<std::string>& walls) {
  std::vector<Window> windows;
  for (const Boundary& boundary : part.grid.boundaries)
    if (is_wall(boundary, walls)) windows.push_back(counted(part, boundary.where));
  RotorGridQuality q = quality_of(part.grid, part.first, part.count, windows);
  q.wall_orthogonality_median = 0.0;
  q.general = grid_quality(part);
  return q;
}

void require_quality(const MultiBlockGrid& grid, const RotorGridQuality& q, const QualityLimits& limits) {
  const auto stop = [&](const std::string& what, const Extreme& e, double limit) {
    const std::string cell = place(grid, e);
    throw NumericalFailure(fmt::format("grid refused: {} in block {}", what, cell), cell, 0, 0.0, limit);
  };
  const GridQuality& g = q.general;
  if (q.folded > 0)
    stop(fmt::format("{} of {} cells fold (a corner Jacobian is not positive); the worst, with scaled Jacobian {:.3g}, is",
                     q.folded, g.cells, g.scaled_jacobian.value),
         g.scaled_jacobian, 0.0);
  if (!(g.min_volume.value > 0.0)) stop(fmt::format("volume {:.3g} m3", g.min_volume.value), g.min_volume, 0.0);
  if (g.scaled_jacobian.value < limits.scaled_jacobian)
    stop(fmt::format("scaled Jacobian {:.3g} below {:.3g}", g.scaled_jacobian.value, limits.scaled_jacobian), g.scaled_jacobian,
         limits.scaled_jacobian);
  if (g.non_orthogonality.value > limits.non_orthogonality)
    stop(fmt::format("{:.1f} deg off orthogonal, above {:.1f}", g.non_orthogonality.value, limits.non_orthogonality),
         g.non_orthogonality, limits.non_orthogonality);
  if (g.stretch.value > limits.stretch)
    stop(fmt::format("neighbours' sizes in the ratio {:.1f}, above {:.1f}{}", g.stretch.value, limits.stretch,
                     grid.blocks[std::size_t(g.stretch.block)].name.starts_with("ring")
                         ? " (take more aero.grid.cells_round or fewer aero.grid.cells_trailing_edge)"
                         : ""),
         g.stretch, limits.stretch);
  if (q.interface_gap > limits.interface_gap * q.reach)
    throw NumericalFailure(fmt::format("grid refused: nodes that should be one are {:.2g} m apart", q.interface_gap),
                           "interfaces", 0, 0.0, limits.interface_gap * q.reach);
}

std::string describe_quality(const MultiBlockGrid& grid, const RotorGridQuality& q) {
  std::string text = describe(q.general, grid);
  const auto line = [&](const std::string& what, const std::string& value, const std::string& where) {
    text += fmt::format("  {:<34} {:>12}   {}\n", what, value, where);
  };
  line("cells that fold", fmt::format("{}", q.folded), "");
  line("scaled Jacobian below 0.4 [%]", fmt::format("{:.3f}", 100.0 * double(q.skewed) / double(std::max(1L, q.general.cells))),
       "");
  const std::array<const char*, 3> direction{"i", "j", "k"};
  for (std::size_t d = 0; d < 3; ++d)
    line(fmt::format("largest stretch along {}", direction[d]), fmt::format("{:.3f}", q.stretch[d].value),
         place(grid, q.stretch[d]));
  if (q.wall_orthogonality.block >= 0) {
    line("largest growth from the wall", fmt::format("{:.3f}", q.wall_growth.value), place(grid, q.wall_growth));
    line("median off the wall's normal [deg]", fmt::format("{:.1f}", q.wall_orthogonality_median), "");
    line("largest off the wall's normal [deg]", fmt::format("{:.1f}", q.wall_orthogonality.value),
         place(grid, q.wall_orthogonality));
    line("first cells [m]", fmt::format("{:.3g}", q.first_cell_low), fmt::format("to {:.3g}", q.first_cell_high));
  }
  line("largest gap at interfaces [m]", fmt::format("{:.2g}", q.interface_gap), "");
  return text;
}

}  // namespace spindrift::aero
