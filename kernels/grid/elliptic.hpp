// Elliptic smoothing of a plane O-grid: Winslow (1966) with the control functions of Thomas & Middlecoff (1980), AIAA J. 18, 652,
// so that the spacing given at the wall survives. Used by src/aero/rotor_grid/plane.cpp; tested in
// tests/kernels/grid/elliptic_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace spindrift {

/// Nodes (i, j) of an O-grid at i + j round: i = 0 ... round - 1 periodic, j = 0 (wall) ... layers.
struct RingShape {
  int round, layers;
  std::size_t at(int i, int j) const { return std::size_t(j) * std::size_t(round) + std::size_t((i + round) % round); }
  std::size_t size() const { return std::size_t(layers + 1) * std::size_t(round); }
};

/// Control functions of the grid as it is: phi (round the section) from wall and outer side, linear between them; psi (outward)
/// along every ray. Both are of the size of the grid.
inline void middlecoff_controls(RingShape ring, std::span<const Eigen::Vector2d> p, std::span<double> phi,
                                std::span<double> psi) {
  const auto along = [&](int i, int j) {
    const Eigen::Vector2d& here = p[ring.at(i, j)];
    const Eigen::Vector2d first = 0.5 * (p[ring.at(i + 1, j)] - p[ring.at(i - 1, j)]);
    const Eigen::Vector2d second = p[ring.at(i + 1, j)] - 2.0 * here + p[ring.at(i - 1, j)];
    return -first.dot(second) / first.squaredNorm();
  };
  for (int i = 0; i < ring.round; ++i) {
    const double wall = along(i, 0), outer = along(i, ring.layers);
    for (int j = 0; j <= ring.layers; ++j) {
      const double u = double(j) / ring.layers;
      phi[ring.at(i, j)] = (1.0 - u) * wall + u * outer;
      psi[ring.at(i, j)] = 0.0;
    }
    for (int j = 1; j < ring.layers; ++j) {
      const Eigen::Vector2d &below = p[ring.at(i, j - 1)], &above = p[ring.at(i, j + 1)];
      const Eigen::Vector2d first = 0.5 * (above - below), second = above - 2.0 * p[ring.at(i, j)] + below;
      psi[ring.at(i, j)] = -first.dot(second) / first.squaredNorm();
    }
  }
}

/// One damped Jacobi sweep into `next`, each node moved by `share` in [0, 1] of the way; wall and outer side stay.
inline void winslow_sweep(RingShape ring, std::span<const Eigen::Vector2d> p, std::span<const double> phi,
                          std::span<const double> psi, std::span<const double> share, std::span<Eigen::Vector2d> next) {
  for (int i = 0; i < ring.round; ++i)
    next[ring.at(i, 0)] = p[ring.at(i, 0)], next[ring.at(i, ring.layers)] = p[ring.at(i, ring.layers)];
  for (int j = 1; j < ring.layers; ++j)
    for (int i = 0; i < ring.round; ++i) {
      const std::size_t c = ring.at(i, j);
      const Eigen::Vector2d &east = p[ring.at(i + 1, j)], &west = p[ring.at(i - 1, j)], &north = p[ring.at(i, j + 1)],
                            &south = p[ring.at(i, j - 1)];
      const Eigen::Vector2d along = 0.5 * (east - west), out = 0.5 * (north - south);
      const Eigen::Vector2d mixed =
          0.25 * (p[ring.at(i + 1, j + 1)] - p[ring.at(i - 1, j + 1)] - p[ring.at(i + 1, j - 1)] + p[ring.at(i - 1, j - 1)]);
      const double a = out.squaredNorm(), b = along.dot(out), g = along.squaredNorm();
      const Eigen::Vector2d sum = a * (east + west + phi[c] * along) + g * (north + south + psi[c] * out) - 2.0 * b * mixed;
      next[c] = p[c] + share[c] * (sum / (2.0 * (a + g)) - p[c]);
    }
}

}  // namespace spindrift
