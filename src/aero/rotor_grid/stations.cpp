// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/stations.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace spindrift::aero {

namespace {

BladeStation station(const Block& b, int block, int k) {
  const auto node = [&](int kk, int j) -> const Eigen::Vector3d& { return b.nodes[b.node(kk, j, 0)]; };
  const auto radius = [](const Eigen::Vector3d& p) { return std::hypot(p.y(), p.z()); };
  const Eigen::Vector3d tail = 0.5 * (node(k, 0) + node(k + 1, 0)), nose = 0.5 * (node(k, b.nj / 2) + node(k + 1, b.nj / 2));
  BladeStation s{.block = block, .k = k};
  const double low = radius(node(k, 0)), high = radius(node(k + 1, 0));
  s.radius = 0.5 * (low + high), s.length = high - low;
  s.chord = (nose - tail).norm(), s.chordwise = (nose - tail) / s.chord;
  s.quarter = nose + 0.25 * (tail - nose);
  s.normal = Eigen::Vector3d::UnitX();
  s.tangential = s.normal.cross(Eigen::Vector3d(0.0, s.quarter.y(), s.quarter.z()).normalized());
  for (int j = 0; j < b.nj; ++j)
    s.wetted_area += 0.5 * (node(k + 1, j + 1) - node(k, j)).cross(node(k + 1, j) - node(k, j + 1)).norm();
  return s;
}

}  // namespace

void add_stations(const GridLayers& part, std::vector<std::vector<BladeStation>>& blades) {
  std::size_t blade = 0;
  for (const Boundary& boundary : part.grid.boundaries) {
    if (!boundary.patch.starts_with("blade_") || boundary.where.side != Side::i_min) continue;
    if (blade == blades.size()) blades.emplace_back();
    const Window w = counted(part, boundary.where);
    for (int k = w.low[1]; k < w.high[1]; ++k) {
      blades[blade].push_back(station(part.grid.blocks[std::size_t(w.block)], w.block, k));
      blades[blade].back().k += part.first[std::size_t(w.block)];
    }
    ++blade;
  }
}

}  // namespace spindrift::aero
