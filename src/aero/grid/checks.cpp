// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/grid/metrics.hpp"
#include "src/aero/grid/index_map.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

constexpr const char* side_names[] = {"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"};

std::string block_name(const MultiBlockGrid& grid, int b) { return fmt::format("block {} \"{}\"", b + 1, grid.blocks[b].name); }
std::string window_name(const MultiBlockGrid& grid, const Window& w) {
  return fmt::format("{} side {} cells [{}, {}) x [{}, {})", block_name(grid, w.block), side_names[int(w.side)], w.low[0],
                     w.high[0], w.low[1], w.high[1]);
}

class Checker {
 public:
  Checker(const MultiBlockGrid& grid, const CheckOptions& options) : grid_(grid), options_(options) {}

  std::vector<std::string> run() {
    if (grid_.blocks.empty()) fault("the grid has no blocks");
    for (int b = 0; b < int(grid_.blocks.size()); ++b) sizes(b);
    if (!faults_.empty()) return faults_;  // nothing below can be asked safely
    for (const Boundary& b : grid_.boundaries) window(b.where, fmt::format("boundary \"{}\"", b.patch));
    for (const Connection& c : grid_.connections) window(c.from, "a connection"), window(c.to, "a connection");
    if (!faults_.empty()) return faults_;
    for (const Connection& c : grid_.connections) connection(c);
    coverage();
    for (int b = 0; b < int(grid_.blocks.size()) && options_.nodes; ++b) volumes(b);
    return faults_;
  }

 private:
  template <class... T>
  void fault(fmt::format_string<T...> text, T&&... values) {
    faults_.push_back(fmt::format(text, std::forward<T>(values)...));
  }

  void sizes(int b) {
    const Block& block = grid_.blocks[b];
    const Index n = block.cells();
    for (int d = 0; d < 3; ++d) {
      const int least = d == 2 && grid_.planar ? 1 : 2;
      if (n[d] < least)
        fault("{} has {} cells in {}: at least {} are needed{}", block_name(grid_, b), n[d], "ijk"[d], least,
              grid_.planar ? "" : "; give a section as a two-dimensional grid");
      if (d == 2 && grid_.planar && n[d] != 1) fault("{} has {} cells in k: a planar grid has 1", block_name(grid_, b), n[d]);
    }
    if (*std::min_element(n.begin(), n.end()) < 1 || !options_.nodes) return;
    const std::size_t nodes = std::size_t(n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    if (block.nodes.size() != nodes) {
      fault("{} of {} x {} x {} cells has {} nodes instead of {}", block_name(grid_, b), n[0], n[1], n[2], block.nodes.size(),
            nodes);
      return;
    }
    const auto bad = std::find_if(block.nodes.begin(), block.nodes.end(), [](const auto& x) { return !x.allFinite(); });
    if (bad != block.nodes.end()) {
      const long at = bad - block.nodes.begin();
      fault("{} node ({}, {}, {}) (i, j, k) is not finite", block_name(grid_, b), at % (n[0] + 1), at / (n[0] + 1) % (n[1] + 1),
            at / (n[0] + 1) / (n[1] + 1));
    }
  }

  void window(const Window& w, const std::string& what) {
    if (w.block < 0 || w.block >= int(grid_.blocks.size())) {
      fault("{} names block {} of {}", what, w.block + 1, grid_.blocks.size());
      return;
    }
    const Index n = grid_.blocks[w.block].cells();
    const auto directions = along(w.side);
    for (int s = 0; s < 2; ++s) {
      const int d = directions[s];
      if (w.low[s] < 0 || w.high[s] > n[d] || w.low[s] >= w.high[s])
        fault("{} of {}: {} runs from 0 to {}", what, window_name(grid_, w), "ijk"[d], n[d]);
    }
    if (grid_.planar && direction_of(w.side) == 2)
      fault("{} of {}: the sides of k bound nothing in a planar grid", what, window_name(grid_, w));
  }

  void connection(const Connection& c) {
    const std::string name = fmt::format("the connection of {} to {}", window_name(grid_, c.from), window_name(grid_, c.to));
    IndexMap map{c.orientation, {}};
    std::array<bool, 3> seen{};
    for (int d = 0; d < 3; ++d) {
      if (c.orientation[d] == 0 || std::abs(c.orientation[d]) > 3)
        return fault("{}: orientation {} is not +-1, 2, 3", name, c.orientation[d]);
      seen[map.target(d)] = true;
    }
    if (!seen[0] || !seen[1] || !seen[2])
      return fault("{}: orientation ({}, {}, {}) names a direction twice", name, c.orientation[0], c.orientation[1],
                   c.orientation[2]);
    const int across = direction_of(c.from.side);
    if (map.target(across) != direction_of(c.to.side) || (map.sign(across) > 0) != (at_end(c.from.side) != at_end(c.to.side)))
      return fault("{}: orientation ({}, {}, {}) does not lead out of the one into the other", name, c.orientation[0],
                   c.orientation[1], c.orientation[2]);
    if (map.handedness() != 1) return fault("{}: one block's indices are left-handed as seen from the other", name);
    const auto from = along(c.from.side), to = along(c.to.side);
    for (int s = 0; s < 2; ++s) {
      const int t = map.target(from[s]) == to[0] ? 0 : 1;
      if (c.from.high[s] - c.from.low[s] != c.to.high[t] - c.to.low[t])
        return fault("{}: {} cells in {} of the first meet {} of the second", name, c.from.high[s] - c.from.low[s],
                     "ijk"[from[s]], c.to.high[t] - c.to.low[t]);
    }
    if (grid_.planar && std::abs(c.orientation[2]) != 3) return fault("{}: k must stay k in a planar grid", name);
    if (options_.nodes) coordinates(c, name);
  }

  /// Nodes of both windows against each other; the shortest edge at a node is the measure.
  void coordinates(const Connection& c, const std::string& name) {
    const Block &a = grid_.blocks[c.from.block], &b = grid_.blocks[c.to.block];
    IndexMap nodes = cell_map(c, grid_);  // of cells; nodes where a direction runs backwards are one further
    const int across = direction_of(c.from.side);
    for (int d = 0; d < 3; ++d)
      if (nodes.sign(d) < 0) nodes.offset[nodes.target(d)] += 1;
    const auto [u, v] = along(c.from.side);
    Index n{};
    n[across] = at_end(c.from.side) ? a.cells()[across] : 0;
    double worst = 0.0, worst_gap = 0.0, worst_edge = 0.0;
    Index worst_at{};
    for (n[v] = c.from.low[1]; n[v] <= c.from.high[1]; ++n[v])
      for (n[u] = c.from.low[0]; n[u] <= c.from.high[0]; ++n[u]) {
        const Index m = nodes(n);
        const Eigen::Vector3d& x = a.nodes[a.node(n[2], n[1], n[0])];
        const Eigen::Vector3d& y = b.nodes[b.node(m[2], m[1], m[0])];
        const double gap = c.periodic ? (c.periodic->rotation * x + c.periodic->translation - y).norm() : (x - y).norm();
        const double edge = shortest_edge(a, n);
        const double allowed = std::max(options_.match_tolerance * edge, 1e-13 * (x.norm() + y.norm()));
        if (gap / allowed > worst) worst = gap / allowed, worst_gap = gap, worst_edge = edge, worst_at = n;
      }
    if (worst > 1.0)
      fault("{}: node ({}, {}, {}) (i, j, k) of the first is {:.3g} m from its partner, shortest edge there {:.3g} m{}", name,
            worst_at[0], worst_at[1], worst_at[2], worst_gap, worst_edge, c.periodic ? " (after the periodic map)" : "");
  }

  double shortest_edge(const Block& block, const Index& n) const {
    double least = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d& x = block.nodes[block.node(n[2], n[1], n[0])];
    for (int d = 0; d < (grid_.planar ? 2 : 3); ++d)
      for (const int step : {-1, 1}) {
        Index m = n;
        m[d] += step;
        if (m[d] < 0 || m[d] > block.cells()[d]) continue;
        const double length = (block.nodes[block.node(m[2], m[1], m[0])] - x).norm();
        if (length > 0) least = std::min(least, length);
      }
    return least;
  }

  void coverage() {
    std::vector<std::array<std::vector<std::uint8_t>, 6>> covered(grid_.blocks.size());
    for (int b = 0; b < int(grid_.blocks.size()); ++b)
      for (int s = 0; s < 6; ++s) {
        const auto [u, v] = along(Side(s));
        covered[b][s].resize(std::size_t(grid_.blocks[b].cells()[u]) * grid_.blocks[b].cells()[v]);
      }
    const auto cover = [&](const Window& w) {
      const int n = grid_.blocks[w.block].cells()[along(w.side)[0]];
      for (int v = w.low[1]; v < w.high[1]; ++v)
        for (int u = w.low[0]; u < w.high[0]; ++u) {
          auto& count = covered[w.block][int(w.side)][std::size_t(v) * n + u];
          count = std::uint8_t(std::min(int(count) + 1, 255));
        }
    };
    for (const Boundary& b : grid_.boundaries) cover(b.where);
    for (const Connection& c : grid_.connections) cover(c.from), cover(c.to);
    for (int b = 0; b < int(grid_.blocks.size()); ++b)
      for (int s = 0; s < (grid_.planar ? 4 : 6); ++s) {
        const auto& count = covered[b][s];
        const int n = grid_.blocks[b].cells()[along(Side(s))[0]];
        for (const bool twice : {false, true}) {
          const auto wrong = [&](int c) { return twice ? c > 1 : c == 0; };
          const long many = std::count_if(count.begin(), count.end(), wrong);
          if (many == 0) continue;
          const long at = std::find_if(count.begin(), count.end(), wrong) - count.begin();
          fault("{} side {}: {} of {} faces are in {}, the first at cell ({}, {}) of {} and {}", block_name(grid_, b),
                side_names[s], many, count.size(), twice ? "more than one connection or boundary" : "no connection or boundary",
                at % n, at / n, "ijk"[along(Side(s))[0]], "ijk"[along(Side(s))[1]]);
        }
      }
  }

  void volumes(int b) {
    const Block& block = grid_.blocks[b];
    long bad = 0, cells = 0;
    std::string where;
    for (int k = 0; k < block.nk; ++k)
      for (int j = 0; j < block.nj; ++j)
        for (int i = 0; i < block.ni; ++i, ++cells) {
          Hexahedron h;
          for (int n = 0; n < 8; ++n) h.x[n] = block.nodes[block.node(k + n / 4, j + n / 2 % 2, i + n % 2)];
          const double volume = hexahedron_volume(h);
          if (volume > 0.0) continue;
          if (bad++ < options_.examples) {
            const Eigen::Vector3d x = cell_centre(h);
            where += fmt::format("{}({}, {}, {}) {:.3g} m3 at ({:.6g}, {:.6g}, {:.6g}) m", where.empty() ? "" : ", ", i, j, k,
                                 volume, x.x(), x.y(), x.z());
          }
        }
    if (bad > 0)
      fault("{}: {} of {} cells have no positive volume{}: cells (i, j, k) {}", block_name(grid_, b), bad, cells,
            bad == cells ? " (left-handed indices? exchange two directions)" : "", where);
  }

  const MultiBlockGrid& grid_;
  const CheckOptions& options_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> grid_faults(const MultiBlockGrid& grid, const CheckOptions& options) {
  return Checker(grid, options).run();
}

void require_ranks(std::size_t tiles, int ranks) {
  if (std::size_t(ranks) <= tiles) return;
  throw scene::SceneError(
      {{"command line", 0, "ranks of the air", fmt::format("{}", ranks),
        fmt::format("the grid has {} tile{}, and each rank needs one: at most {} ranks, or smaller tiles (aero.flow.tile_cells)",
                    tiles, tiles == 1 ? "" : "s", tiles)}});
}

void require_sound(const MultiBlockGrid& grid, const std::string& source, const CheckOptions& options) {
  const auto faults = grid_faults(grid, options);
  if (faults.empty()) return;
  std::vector<scene::Problem> problems;
  for (const std::string& f : faults) problems.push_back({source, 0, "", "", f});
  throw scene::SceneError(std::move(problems));
}

}  // namespace spindrift::aero
