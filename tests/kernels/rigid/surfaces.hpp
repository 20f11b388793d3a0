// Closed surfaces for tests: shapes whose every measure is known. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/rigid/closed_surface.hpp"

namespace spindrift::testing {

/// A box round the origin.
inline std::vector<std::array<Eigen::Vector3d, 3>> box_facets(const Eigen::Vector3d& size) {
  std::vector<std::array<Eigen::Vector3d, 3>> facets;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        Eigen::Vector3d x;
        x[axis] = 0.5 * side * size[axis];
        x[(axis + 1) % 3] = 0.5 * u * size[(axis + 1) % 3], x[(axis + 2) % 3] = 0.5 * v * side * size[(axis + 2) % 3];
        return x;
      };
      facets.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      facets.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  return facets;
}

/// A prism of n sides with its corners on a cylinder round the z axis, so wide that its section is that of the circle.
inline std::vector<std::array<Eigen::Vector3d, 3>> cylinder_facets(double radius, double low, double high, int n) {
  std::vector<std::array<Eigen::Vector3d, 3>> facets;
  const double wide = radius * std::sqrt(2.0 * pi / n / std::sin(2.0 * pi / n));
  const auto at = [&](int k, double z) {
    const double angle = 2.0 * pi * (k % n) / n;
    return Eigen::Vector3d(wide * std::cos(angle), wide * std::sin(angle), z);
  };
  for (int k = 0; k < n; ++k) {
    facets.push_back({at(k, low), at(k + 1, low), at(k + 1, high)});
    facets.push_back({at(k, low), at(k + 1, high), at(k, high)});
    facets.push_back({Eigen::Vector3d(0, 0, high), at(k, high), at(k + 1, high)});
    facets.push_back({Eigen::Vector3d(0, 0, low), at(k + 1, low), at(k, low)});
  }
  return facets;
}

/// A sphere of rings and sectors with its corners on it.
inline std::vector<std::array<Eigen::Vector3d, 3>> sphere_facets(double radius, int rings, int sectors) {
  std::vector<std::array<Eigen::Vector3d, 3>> facets;
  const auto at = [&](int i, int k) {
    if (i == 0 || i == rings) return Eigen::Vector3d(0, 0, i == 0 ? -radius : radius);
    const double from = -0.5 * pi + pi * i / rings, angle = 2.0 * pi * (k % sectors) / sectors;
    return Eigen::Vector3d(radius * std::cos(from) * std::cos(angle), radius * std::cos(from) * std::sin(angle),
                           radius * std::sin(from));
  };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      if (i > 0) facets.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      if (i < rings - 1) facets.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  return facets;
}

}  // namespace spindrift::testing
