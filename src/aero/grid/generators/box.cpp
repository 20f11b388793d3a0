// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/generators/box.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spindrift::aero {

Block mapped_block(std::string name, int ni, int nj, int nk, const Mapping& position) {
  Block block{std::move(name), ni, nj, nk, {}};
  block.nodes.reserve(std::size_t(ni + 1) * (nj + 1) * (nk + 1));
  for (int k = 0; k <= nk; ++k)
    for (int j = 0; j <= nj; ++j)
      for (int i = 0; i <= ni; ++i) block.nodes.push_back(position(double(i) / ni, double(j) / nj, double(k) / nk));
  return block;
}

namespace {

/// Sides of the only block: patches, or a periodic pair by translation along that index's edge.
void close_sides(MultiBlockGrid& grid, const BoxOptions& o) {
  const Block& b = grid.blocks[0];
  const std::array<int, 3> n = b.cells();
  const std::size_t ends[] = {b.node(0, 0, b.ni), b.node(0, b.nj, 0), b.node(b.nk, 0, 0)};
  for (int d = 0; d < (grid.planar ? 2 : 3); ++d) {
    const std::array<int, 2> high{d == 0 ? n[1] : n[0], d == 2 ? n[1] : n[2]};
    const Window low_side{0, Side(2 * d), {0, 0}, high}, high_side{0, Side(2 * d + 1), {0, 0}, high};
    if (o.periodic[d]) {
      RigidMap shift;
      shift.translation = b.nodes[0] - b.nodes[ends[d]];
      grid.connections.push_back({high_side, low_side, {1, 2, 3}, shift});
    } else {
      grid.boundaries.push_back({low_side, o.patches[2 * d]});
      grid.boundaries.push_back({high_side, o.patches[2 * d + 1]});
    }
  }
}

}  // namespace

MultiBlockGrid cartesian_box(const BoxOptions& o) {
  const Eigen::Vector3d size = o.high - o.low;
  MultiBlockGrid grid;
  grid.blocks.push_back(mapped_block("box", o.ni, o.nj, o.nk, [&](double u, double v, double w) {
    return Eigen::Vector3d(o.low + size.cwiseProduct(Eigen::Vector3d(u, v, w)));
  }));
  close_sides(grid, o);
  return grid;
}

namespace {

/// Sum of q + q^2 + ... + q^n.
double growing_cells(double q, int n) {
  double sum = 0.0, size = 1.0;
  for (int k = 0; k < n; ++k) size *= q, sum += size;
  return sum;
}

/// Sizes of n cells outward from a core with cells of size one, which fill `length`: a geometric progression.
std::vector<double> sizes_outward(double length, int n) {
  double low = 0.0, high = 10.0;  // of the ratio
  for (int bisection = 0; bisection < 200; ++bisection) {
    const double middle = 0.5 * (low + high);
    (growing_cells(middle, n) < length ? low : high) = middle;
  }
  std::vector<double> sizes(std::size_t(n), 1.0);
  double size = 1.0, sum = 0.0;
  for (double& s : sizes) s = size *= low, sum += s;
  for (double& s : sizes) s *= length / sum;
  return sizes;
}

int cells_outward(double length, double growth) {
  int n = 0;
  while (length > 0.0 && growing_cells(growth, n) < length * (1.0 - 1e-9)) ++n;
  return n;
}

}  // namespace

std::vector<double> stretched_nodes(double low, double core_low, double core_high, double high, double cell, double growth) {
  constexpr int multiple = 4;
  int core = std::max(1, int(std::lround((core_high - core_low) / cell)));
  const double below = core_low - low, above = high - core_high;
  if (below <= 0.0 && above <= 0.0) core = (core + multiple - 1) / multiple * multiple;
  const double size = (core_high - core_low) / core;
  int under = cells_outward(below / size, growth), over = cells_outward(above / size, growth);
  int& longer = below > above ? under : over;
  while ((core + under + over) % multiple != 0) ++longer;
  std::vector<double> nodes;
  if (under > 0) {
    const std::vector<double> sizes = sizes_outward(below / size, under);
    double x = low;
    for (auto s = sizes.rbegin(); s != sizes.rend(); ++s) nodes.push_back(x), x += size * *s;
  }
  for (int n = 0; n <= core; ++n) nodes.push_back(n == core ? core_high : core_low + n * size);
  if (over > 0) {
    double x = core_high;
    for (const double s : sizes_outward(above / size, over)) nodes.push_back(x += size * s);
    nodes.back() = high;
  }
  return nodes;
}

MultiBlockGrid cartesian_box(const std::array<std::vector<double>, 3>& nodes, BoxOptions o) {
  o.ni = int(nodes[0].size()) - 1, o.nj = int(nodes[1].size()) - 1, o.nk = int(nodes[2].size()) - 1;
  MultiBlockGrid grid;
  grid.blocks.push_back(mapped_block("box", o.ni, o.nj, o.nk, [&](double u, double v, double w) {
    return Eigen::Vector3d(nodes[0][std::size_t(std::lround(u * o.ni))], nodes[1][std::size_t(std::lround(v * o.nj))],
                           nodes[2][std::size_t(std::lround(w * o.nk))]);
  }));
  close_sides(grid, o);
  return grid;
}

MultiBlockGrid planar_box(const BoxOptions& o) {
  const Eigen::Vector3d size = o.high - o.low;
  MultiBlockGrid grid;
  grid.planar = true;
  grid.blocks.push_back(mapped_block("box", o.ni, o.nj, 1, [&](double u, double v, double w) {
    return Eigen::Vector3d(o.low + size.cwiseProduct(Eigen::Vector3d(u, 1.0 - w, v)));
  }));
  close_sides(grid, o);
  return grid;
}

MultiBlockGrid perturbed(MultiBlockGrid box, const BoxOptions& o, double amplitude) {
  using std::numbers::pi;
  const Eigen::Vector3d size = o.high - o.low;
  const bool planar = box.planar;
  const auto one_way = [&](int direction, double u) { return o.periodic[direction] ? 1.0 : std::sin(pi * u); };
  deform(box, [&](const Eigen::Vector3d& x) {
    const Eigen::Vector3d s = (x - o.low).cwiseQuotient(size);
    if (planar) {  // i along x, j along z
      const double still = one_way(0, s.x()) * one_way(1, s.z());
      return Eigen::Vector3d(x.x() + amplitude * size.x() * still * std::sin(2 * pi * s.z()) * std::cos(2 * pi * s.x()), x.y(),
                             x.z() + amplitude * size.z() * still * std::sin(2 * pi * s.x() + 0.7) * std::cos(2 * pi * s.z()));
    }
    const double still = one_way(0, s.x()) * one_way(1, s.y()) * one_way(2, s.z());
    const Eigen::Vector3d wave(std::sin(2 * pi * s.y()) * std::cos(2 * pi * s.z()),
                               std::sin(2 * pi * s.z()) * std::cos(2 * pi * s.x() + 0.7),
                               std::sin(2 * pi * s.x() + 0.3) * std::cos(2 * pi * s.y()));
    return Eigen::Vector3d(x + amplitude * still * size.cwiseProduct(wave));
  });
  return box;
}

MultiBlockGrid thin_sheared_box(int n, double thin, double shear) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  MultiBlockGrid grid = cartesian_box({.ni = n, .nj = n, .nk = n, .high = Eigen::Vector3d(n, n, n * thin)});
  deform(grid, [&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(turn * Eigen::Vector3d(x.x() + shear * x.z(), x.y() + shear * x.z(), x.z()));
  });
  return grid;
}

void deform(MultiBlockGrid& grid, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& position) {
  for (Block& b : grid.blocks)
    for (Eigen::Vector3d& x : b.nodes) x = position(x);
}

}  // namespace spindrift::aero
