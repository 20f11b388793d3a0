// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "kernels/grid/metrics.hpp"
#include "src/aero/grid/index_map.hpp"

namespace spindrift::aero {

namespace {

struct Place {
  int block, k, j, i;
  const Eigen::Vector3d& at;
};

void most(Extreme& e, double value, const Place& p) {
  if (e.block < 0 || value > e.value) e = {value, p.block, p.k, p.j, p.i, p.at};
}
void least(Extreme& e, double value, const Place& p) {
  if (e.block < 0 || value < e.value) e = {value, p.block, p.k, p.j, p.i, p.at};
}
double ratio(double a, double b) { return std::max(a, b) / std::min(a, b); }

Hexahedron cell(const Block& b, int k, int j, int i) {
  Hexahedron h;
  for (int n = 0; n < 8; ++n) h.x[n] = b.nodes[b.node(k + n / 4, j + n / 2 % 2, i + n % 2)];
  return h;
}

/// Angles of a quadrilateral's corners against 90 degrees, the largest departure over 90.
double face_skewness(const Eigen::Vector3d (&x)[4]) {
  double worst = 0.0;
  for (int n = 0; n < 4; ++n) {
    const Eigen::Vector3d a = x[(n + 1) % 4] - x[n], b = x[(n + 3) % 4] - x[n];
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    worst = std::max(worst, std::abs(angle * 2.0 / std::numbers::pi - 1.0));
  }
  return worst;
}

void of_cell(GridQuality& q, const Hexahedron& h, bool planar, const Place& p) {
  const double volume = hexahedron_volume(h);
  q.volume += volume;
  least(q.min_volume, volume, p), most(q.max_volume, volume, p);
  double edge[3] = {};
  for (int n = 0; n < 8; ++n)
    for (int d = 0; d < 3; ++d)
      if (!(n >> d & 1)) edge[d] += 0.25 * (h.x[n | 1 << d] - h.x[n]).norm();
  const auto last = edge + (planar ? 2 : 3);
  most(q.aspect_ratio, *std::max_element(edge, last) / *std::min_element(edge, last), p);
  static constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 2, 6, 4},
                                      {1, 3, 7, 5}, {0, 4, 5, 1}, {2, 6, 7, 3}};  // across k, i, j
  for (int f = 0; f < (planar ? 2 : 6); ++f)
    most(q.skewness, face_skewness({h.x[faces[f][0]], h.x[faces[f][1]], h.x[faces[f][2]], h.x[faces[f][3]]}), p);
  for (int n = 0; n < 8; ++n) {
    Eigen::Vector3d e[3];
    for (int d = 0; d < 3; ++d) e[d] = (h.x[n | 1 << d] - h.x[n & ~(1 << d)]);
    least(q.scaled_jacobian, e[0].cross(e[1]).dot(e[2]) / (e[0].norm() * e[1].norm() * e[2].norm()), p);
  }
}

/// Of the cells of one k of a block.
void of_slab(GridQuality& q, const MultiBlockGrid& grid, int b, int k) {
  const int directions = grid.planar ? 2 : 3;
  const Block& block = grid.blocks[b];
  const Index n = block.cells();
  q.cells += long(n[0]) * n[1];
  for (int j = 0; j < block.nj; ++j)
    for (int i = 0; i < block.ni; ++i) {
      const Hexahedron h = cell(block, k, j, i);
      const Eigen::Vector3d centre = cell_centre(h);
      const Place p{b, k, j, i, centre};
      of_cell(q, h, grid.planar, p);
      for (int d = 0; d < directions; ++d) {
        Index next{i, j, k};
        if (++next[d] == n[d]) continue;
        const Hexahedron beyond = cell(block, next[2], next[1], next[0]);
        const int face[3][4] = {{1, 3, 7, 5}, {2, 6, 7, 3}, {4, 5, 7, 6}};
        const Eigen::Vector3d s = face_vector({h.x[face[d][0]], h.x[face[d][1]], h.x[face[d][2]], h.x[face[d][3]]});
        const Eigen::Vector3d line = cell_centre(beyond) - centre;
        most(q.non_orthogonality, std::atan2(s.cross(line).norm(), s.dot(line)) * 180.0 / std::numbers::pi, p);
        most(q.volume_ratio, ratio(hexahedron_volume(h), hexahedron_volume(beyond)), p);
        most(q.stretch, ratio((h.x[1 << d] - h.x[0]).norm(), (beyond.x[1 << d] - beyond.x[0]).norm()), p);
      }
    }
}

/// Of the first `count` layers of each block, which begins at layer `first` of the whole.
GridQuality quality_of(const MultiBlockGrid& grid, const std::vector<int>& first, const std::vector<int>& count) {
  std::vector<std::pair<int, int>> slabs;
  for (int b = 0; b < int(grid.blocks.size()); ++b)
    for (int k = 0; k < count[b]; ++k) slabs.emplace_back(b, k);
  std::vector<GridQuality> parts(slabs.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t s = 0; s < slabs.size(); ++s) of_slab(parts[s], grid, slabs[s].first, slabs[s].second);
  GridQuality q;
  for (const GridQuality& part : parts) merge(q, part);
  for (const auto e :
       {&GridQuality::min_volume, &GridQuality::scaled_jacobian, &GridQuality::max_volume, &GridQuality::aspect_ratio,
        &GridQuality::skewness, &GridQuality::non_orthogonality, &GridQuality::stretch, &GridQuality::volume_ratio})
    if ((q.*e).block >= 0) (q.*e).k += first[(q.*e).block];
  return q;
}

}  // namespace

void merge(GridQuality& all, const GridQuality& part) {
  const auto place = [](const Extreme& e) { return Place{e.block, e.k, e.j, e.i, e.at}; };
  all.cells += part.cells, all.volume += part.volume;
  for (const auto e : {&GridQuality::min_volume, &GridQuality::scaled_jacobian})
    if ((part.*e).block >= 0) least(all.*e, (part.*e).value, place(part.*e));
  for (const auto e : {&GridQuality::max_volume, &GridQuality::aspect_ratio, &GridQuality::skewness,
                       &GridQuality::non_orthogonality, &GridQuality::stretch, &GridQuality::volume_ratio})
    if ((part.*e).block >= 0) most(all.*e, (part.*e).value, place(part.*e));
}

GridQuality grid_quality(const MultiBlockGrid& grid) {
  std::vector<int> all;
  for (const Block& b : grid.blocks) all.push_back(b.nk);
  return quality_of(grid, std::vector<int>(all.size(), 0), all);
}

GridQuality grid_quality(const GridLayers& part) { return quality_of(part.grid, part.first, part.count); }

std::string describe(const GridQuality& q, const MultiBlockGrid& grid) {
  std::string text = fmt::format("{} cells in {} blocks, {:.6g} m3\n", q.cells, grid.blocks.size(), q.volume);
  const auto line = [&](const char* what, const Extreme& e) {
    if (e.block < 0) return;
    text += fmt::format("  {:<34} {:>12.5g}   block {} \"{}\" cell ({}, {}, {}) at ({:.5g}, {:.5g}, {:.5g}) m\n", what, e.value,
                        e.block + 1, grid.blocks[e.block].name, e.i, e.j, e.k, e.at.x(), e.at.y(), e.at.z());
  };
  line("smallest volume [m3]", q.min_volume);
  line("largest volume [m3]", q.max_volume);
  line("largest aspect ratio", q.aspect_ratio);
  line("largest skewness [0 ... 1]", q.skewness);
  line("smallest scaled Jacobian [1 ... -1]", q.scaled_jacobian);
  line("largest non-orthogonality [deg]", q.non_orthogonality);
  line("largest stretch", q.stretch);
  line("largest volume ratio", q.volume_ratio);
  return text;
}

}  // namespace spindrift::aero
