// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/connect.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <vector>

#include "src/aero/grid/index_map.hpp"

namespace spindrift::aero {

namespace {

struct Face {
  int block;
  Side side;
  int u, v;
  Eigen::Vector3d corner[4];  // at (u, v), (u+1, v), (u, v+1), (u+1, v+1)
  Eigen::Vector3d centre;
  double shortest;
  int partner = -1;           // index of the face that coincides
  int first = 0, second = 0;  // signed direction (1 or 2 of the partner's two) that u and v run along
  bool taken = false;
};

/// Which signed directions of `b` the directions of `a` run along; false where the corners do not coincide.
bool coincide(const Face& a, const Face& b, double tolerance, int& first, int& second) {
  const double allowed = tolerance * std::min(a.shortest, b.shortest);
  int at[4];
  for (int n = 0; n < 4; ++n) {
    at[n] = -1;
    for (int m = 0; m < 4; ++m)
      if ((a.corner[n] - b.corner[m]).norm() <= allowed) at[n] = m;
    if (at[n] < 0) return false;
  }
  const auto direction = [](int from, int to) {
    return (to - from) == 1 ? 1 : (to - from) == -1 ? -1 : (to - from) == 2 ? 2 : (to - from) == -2 ? -2 : 0;
  };
  first = direction(at[0], at[1]), second = direction(at[0], at[2]);
  return first != 0 && second != 0 && std::abs(first) != std::abs(second);
}

std::vector<Face> side_faces(const MultiBlockGrid& grid) {
  std::vector<Face> faces;
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const Block& block = grid.blocks[b];
    for (int s = 0; s < (grid.planar ? 4 : 6); ++s) {
      const auto [du, dv] = along(Side(s));
      const int d = direction_of(Side(s));
      for (int v = 0; v < block.cells()[dv]; ++v)
        for (int u = 0; u < block.cells()[du]; ++u) {
          Face f{b, Side(s), u, v, {}, Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
          for (int n = 0; n < 4; ++n) {
            Index at{};
            at[d] = at_end(Side(s)) ? block.cells()[d] : 0;
            at[du] = u + n % 2, at[dv] = v + n / 2;
            f.corner[n] = block.nodes[block.node(at[2], at[1], at[0])];
            f.centre += 0.25 * f.corner[n];
          }
          for (const auto& [n, m] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}})
            if (const double length = (f.corner[n] - f.corner[m]).norm(); length > 0) f.shortest = std::min(f.shortest, length);
          faces.push_back(f);
        }
    }
  }
  return faces;
}

}  // namespace

void connect_by_coordinates(MultiBlockGrid& grid, double tolerance) {
  grid.connections.clear(), grid.boundaries.clear();
  std::vector<Face> faces = side_faces(grid);
  std::vector<int> by_x(faces.size());
  for (std::size_t n = 0; n < faces.size(); ++n) by_x[n] = int(n);
  // Sorted along a skew line: grids are full of faces that share an x, a y or a z.
  const Eigen::Vector3d skew(0.5773, 0.6187, 0.5328);
  const auto place = [&](int n) { return skew.dot(faces[n].centre); };
  std::ranges::sort(by_x, [&](int a, int b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  for (std::size_t p = 0; p < by_x.size(); ++p) {
    Face& a = faces[by_x[p]];
    for (std::size_t q = p + 1; q < by_x.size() && place(by_x[q]) - place(by_x[p]) <= tolerance * a.shortest; ++q) {
      Face& b = faces[by_x[q]];
      if (a.partner >= 0 || b.partner >= 0) continue;
      if (!coincide(a, b, tolerance, a.first, a.second)) continue;
      coincide(b, a, tolerance, b.first, b.second);
      a.partner = by_x[q], b.partner = by_x[p];
    }
  }
  // Windows: from each face not taken, as far along u as the pairing goes on unchanged, then rows of v.
  std::size_t start = 0;
  for (int b = 0; b < int(grid.blocks.size()); ++b)
    for (int s = 0; s < (grid.planar ? 4 : 6); ++s) {
      const auto [du, dv] = along(Side(s));
      const int nu = grid.blocks[b].cells()[du], nv = grid.blocks[b].cells()[dv];
      const auto face = [&](int v, int u) -> Face& { return faces[start + std::size_t(v) * nu + u]; };
      for (int v = 0; v < nv; ++v)
        for (int u = 0; u < nu; ++u) {
          const Face& f = face(v, u);
          if (f.taken) continue;
          const auto continues = [&](int vv, int uu) {
            const Face& g = face(vv, uu);
            if (g.taken || (g.partner >= 0) != (f.partner >= 0)) return false;
            if (f.partner < 0) return true;
            const Face &fp = faces[f.partner], &gp = faces[g.partner];
            int expected[2] = {fp.u, fp.v};
            expected[std::abs(f.first) - 1] += (f.first > 0 ? 1 : -1) * (uu - u);
            expected[std::abs(f.second) - 1] += (f.second > 0 ? 1 : -1) * (vv - v);
            return gp.block == fp.block && gp.side == fp.side && g.first == f.first && g.second == f.second &&
                   gp.u == expected[0] && gp.v == expected[1];
          };
          // A window that folds onto itself is taken one half at a time: the other half is the partner's, taken with it.
          const auto take = [&](int vv, int uu) {
            Face& g = face(vv, uu);
            g.taken = true;
            if (g.partner >= 0) faces[g.partner].taken = true;
          };
          take(v, u);
          int u_end = u + 1, v_end = v + 1;
          while (u_end < nu && continues(v, u_end)) take(v, u_end++);
          for (bool whole = true; v_end < nv; ++v_end) {
            for (int n = u; n < u_end; ++n) whole = whole && continues(v_end, n);
            if (!whole) break;
            for (int n = u; n < u_end; ++n) take(v_end, n);
          }
          const Window from{b, Side(s), {u, v}, {u_end, v_end}};
          if (f.partner < 0) {
            static constexpr const char* names[] = {"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"};
            grid.boundaries.push_back({from, fmt::format("{}:{}", b + 1, names[s])});
            continue;
          }
          const Face &p = faces[f.partner], &last = faces[face(v_end - 1, u_end - 1).partner];
          const Window to{p.block,
                          p.side,
                          {std::min(p.u, last.u), std::min(p.v, last.v)},
                          {std::max(p.u, last.u) + 1, std::max(p.v, last.v) + 1}};
          Connection c{from, to, {}, {}};
          const auto there = along(p.side);
          const auto signed_direction = [&](int d) { return (d > 0 ? 1 : -1) * (there[std::abs(d) - 1] + 1); };
          c.orientation[du] = signed_direction(f.first), c.orientation[dv] = signed_direction(f.second);
          c.orientation[direction_of(Side(s))] = (at_end(Side(s)) != at_end(p.side) ? 1 : -1) * (direction_of(p.side) + 1);
          grid.connections.push_back(c);
        }
      start += std::size_t(nu) * nv;
    }
}

double find_periodic_map(const MultiBlockGrid& grid, Connection& c) {
  IndexMap nodes = cell_map(c, grid);
  for (int d = 0; d < 3; ++d)
    if (nodes.sign(d) < 0) nodes.offset[nodes.target(d)] += 1;
  const Block &a = grid.blocks[c.from.block], &b = grid.blocks[c.to.block];
  const int across = direction_of(c.from.side);
  const auto [u, v] = along(c.from.side);
  std::vector<Eigen::Vector3d> x, y;
  Index n{};
  n[across] = at_end(c.from.side) ? a.cells()[across] : 0;
  for (n[v] = c.from.low[1]; n[v] <= c.from.high[1]; ++n[v])
    for (n[u] = c.from.low[0]; n[u] <= c.from.high[0]; ++n[u]) {
      const Index m = nodes(n);
      x.push_back(a.nodes[a.node(n[2], n[1], n[0])]), y.push_back(b.nodes[b.node(m[2], m[1], m[0])]);
    }
  Eigen::Vector3d mx = Eigen::Vector3d::Zero(), my = mx;
  for (std::size_t p = 0; p < x.size(); ++p) mx += x[p] / double(x.size()), my += y[p] / double(x.size());
  double size = 0;
  for (const auto& p : x) size = std::max(size, (p - mx).norm());
  const auto misfit = [&](const RigidMap& map) {
    double worst = 0;
    for (std::size_t p = 0; p < x.size(); ++p) worst = std::max(worst, (map.rotation * x[p] + map.translation - y[p]).norm());
    return worst;
  };
  const double tolerance = 1e-6 * size;  // tells which kind of map it is; checks compare node by node with the cells' own edges
  RigidMap map;
  c.periodic.reset();
  if (misfit(map) <= tolerance) return 0.0;
  map.translation = my - mx;
  if (misfit(map) > tolerance) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    for (std::size_t p = 0; p < x.size(); ++p) h += (x[p] - mx) * (y[p] - my).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
    sign(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
    map.rotation = svd.matrixV() * sign * svd.matrixU().transpose();
    map.translation = my - map.rotation * mx;
    if (misfit(map) > tolerance) return misfit(map);
  }
  c.periodic = map;
  return 0.0;
}

}  // namespace spindrift::aero
