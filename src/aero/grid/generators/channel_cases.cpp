// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "kernels/grid/spacing.hpp"
#include "kernels/grid/transfinite.hpp"
#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"

namespace spindrift::aero {

double bump_height(double x) {
  if (x <= 0.3 || x >= 1.2) return 0.0;
  const double s = std::sin(std::numbers::pi * (x / 0.9 - 1.0 / 3.0));
  return 0.05 * s * s * s * s;
}

MultiBlockGrid bump_channel(const BumpOptions& o) {
  constexpr int ends = 8, wall = 28, heights = 20;  // cells of n = 1
  constexpr double length = 1.5;
  const double spacing = length / wall;
  const SinhLaw before(spacing * ends / o.upstream), after(spacing * ends / o.downstream);
  const SinhLaw up(o.first_cell * 2.0 * heights / o.height);
  const auto x_of = [&](double u) {
    const double s = u * (2 * ends + wall);
    if (s <= ends) return -o.upstream * before(1.0 - s / ends);
    if (s >= ends + wall) return length + o.downstream * after((s - ends - wall) / ends);
    return length * (s - ends) / wall;
  };
  MultiBlockGrid grid;
  grid.planar = true;
  const int ni = (2 * ends + wall) * o.n, nj = heights * o.n;
  const double left = x_of(0.0), right = x_of(1.0);
  grid.blocks.push_back(mapped_block("channel", ni, nj, 1, [&](double u, double v, double w) {
    // Blended in the law's measure: the first cells are as high over the bump as beside it, less its height's share.
    const double s = up(v);
    const auto side = [&](double x) { return [x, &o](double q) { return Eigen::Vector3d(x, 0.0, q * o.height); }; };
    Eigen::Vector3d p = transfinite(
        (x_of(u) - left) / (right - left), s, side(left), side(right),
        [&](double q) { return Eigen::Vector3d(left + q * (right - left), 0.0, bump_height(left + q * (right - left))); },
        [&](double q) { return Eigen::Vector3d(left + q * (right - left), 0.0, o.height); });
    p.y() = -o.width * w;
    return p;
  }));
  const int start = ends * o.n, stop = (ends + wall) * o.n;
  grid.boundaries = {{{0, Side::i_min, {0, 0}, {nj, 1}}, "inflow"},      {{0, Side::i_max, {0, 0}, {nj, 1}}, "outflow"},
                     {{0, Side::j_min, {0, 0}, {start, 1}}, "symmetry"}, {{0, Side::j_min, {start, 0}, {stop, 1}}, "wall"},
                     {{0, Side::j_min, {stop, 0}, {ni, 1}}, "symmetry"}, {{0, Side::j_max, {0, 0}, {ni, 1}}, "top"}};
  return grid;
}

MultiBlockGrid extruded(const MultiBlockGrid& planar, int nk, double width, bool periodic, const std::string& side_patch) {
  if (!planar.planar) throw std::invalid_argument("extruded: the grid is not planar");
  MultiBlockGrid grid = planar;
  grid.planar = false;
  const auto deepen = [&](Window& w) { w.high[1] = nk; };  // k is the second direction along every side of i and j
  for (Boundary& b : grid.boundaries) deepen(b.where);
  for (Connection& c : grid.connections) deepen(c.from), deepen(c.to);
  for (int number = 0; number < int(grid.blocks.size()); ++number) {
    Block& block = grid.blocks[number];
    const Block section = block;
    block.nk = nk;
    block.nodes.resize(std::size_t(block.ni + 1) * (block.nj + 1) * (nk + 1));
    for (int k = 0; k <= nk; ++k)
      for (int j = 0; j <= block.nj; ++j)
        for (int i = 0; i <= block.ni; ++i) {
          Eigen::Vector3d x = section.nodes[section.node(0, j, i)];
          x.y() -= width * k / nk;
          block.nodes[block.node(k, j, i)] = x;
        }
    const Window low{number, Side::k_min, {0, 0}, {block.ni, block.nj}}, high{number, Side::k_max, {0, 0}, {block.ni, block.nj}};
    if (periodic) {
      RigidMap shift;
      shift.translation = Eigen::Vector3d(0.0, width, 0.0);
      grid.connections.push_back({high, low, {1, 2, 3}, shift});
    } else {
      grid.boundaries.push_back({low, side_patch}), grid.boundaries.push_back({high, side_patch});
    }
  }
  return grid;
}

}  // namespace spindrift::aero
