// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/wing.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/grid/ray.hpp"
#include "kernels/grid/stretching.hpp"

namespace spindrift::aero {

namespace {

using Eigen::Vector2d;

/// Nodes of the plane at j + round i, counter-clockwise in (s, x) = (-chordwise, towards the suction side) as on a blade.
std::vector<Vector2d> plane_nodes(const std::vector<Vector2d>& section, const WingSpec& spec) {
  const int round = spec.spacing.round;
  std::vector<Vector2d> nodes;
  for (const Vector2d& p : section) nodes.emplace_back(-p.x(), p.y());
  const std::vector<Vector2d> wall(nodes);
  std::vector<double> angle(wall.size()), work(wall.size()), size(std::size_t(spec.layers));
  smoothed_normals(wall, std::max(2, int(std::lround(2.0 * std::pow(round / 60.0, 2)))), angle, work);
  nodes.resize(wall.size() * std::size_t(spec.layers + 1));
  for (int j = 0; j < round; ++j) {
    const Vector2d& from = wall[std::size_t(j)];
    const double turn = pi + 2.0 * pi * j / round;  // from behind the trailing edge, under the section
    const Vector2d out(std::cos(turn), std::sin(turn)), leave(std::cos(angle[std::size_t(j)]), std::sin(angle[std::size_t(j)]));
    const Vector2d to = Vector2d(-0.5, 0.0) + spec.extent_chords * out;
    constexpr double near = 0.25, far = 0.3;  // handles: in chords at the wall, of the radius at the outer side
    const Ray ray({from, from + near * leave, to - far * spec.extent_chords * out, to});
    geometric_sizes(spec.first_cell_chords, ray.length(), size);
    double s = 0.0;
    for (int i = 1; i < spec.layers; ++i)
      nodes[std::size_t(i) * wall.size() + std::size_t(j)] = ray.at_length(s += size[std::size_t(i) - 1]);
    nodes[std::size_t(spec.layers) * wall.size() + std::size_t(j)] = to;
  }
  return nodes;
}

}  // namespace

MultiBlockGrid make_wing_grid(const Aerofoil& aerofoil, const WingSpec& spec) {
  const int round = spec.spacing.round, nk = spec.planar ? 1 : spec.span_cells;
  const std::vector<Vector2d> plane = plane_nodes(resample_outline(aerofoil, spec.spacing), spec);
  const double width = spec.span_chords * spec.chord_m;
  Block b{.name = "wing", .ni = spec.layers, .nj = round, .nk = nk};
  for (int k = 0; k <= nk; ++k)
    for (int j = 0; j <= round; ++j)
      for (int i = 0; i <= spec.layers; ++i) {
        const Vector2d& p = plane[std::size_t(i) * std::size_t(round) + std::size_t(j % round)];
        b.nodes.emplace_back(-p.x() * spec.chord_m, width * k / nk, p.y() * spec.chord_m);
      }
  MultiBlockGrid grid;
  grid.planar = spec.planar;
  grid.blocks.push_back(std::move(b));
  const auto side = [&](Side where, int n0, int n1) { return Window{0, where, {0, 0}, {n0, n1}}; };
  grid.connections.push_back({side(Side::j_max, spec.layers, nk), side(Side::j_min, spec.layers, nk), {1, 2, 3}, {}});
  if (!spec.planar)
    grid.connections.push_back({side(Side::k_max, spec.layers, round),
                                side(Side::k_min, spec.layers, round),
                                {1, 2, 3},
                                RigidMap{Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, -width, 0.0)}});
  grid.boundaries.push_back({side(Side::i_min, round, nk), "wing"});
  grid.boundaries.push_back({side(Side::i_max, round, nk), "far"});
  return grid;
}

Aerofoil naca_symmetric(double thickness, int n) {
  Aerofoil a{thickness, {}};
  const auto half = [&](double x) {
    return 5.0 * thickness * (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1015 * x * x * x * x);
  };
  for (int m = -n; m <= n; ++m) {
    const double x = 0.5 * (1.0 - std::cos(pi * std::abs(m) / n));
    a.outline.emplace_back(x, m < 0 ? half(x) : -half(x));
  }
  return a;
}

}  // namespace spindrift::aero
