// Fills a surface or a volume between given edges or faces (Gordon & Hall 1973): sums of linear blends less what they count
// twice. Called by src/aero/grid/generators; tested in tests/kernels/grid/spacing_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace spindrift {

/// Coons patch: edges at u = 0, 1 run along v, edges at v = 0, 1 along u; they share their corners.
template <class EdgeU0, class EdgeU1, class EdgeV0, class EdgeV1>
Eigen::Vector3d transfinite(double u, double v, const EdgeU0& u0, const EdgeU1& u1, const EdgeV0& v0, const EdgeV1& v1) {
  const Eigen::Vector3d along_u = (1 - u) * u0(v) + u * u1(v), along_v = (1 - v) * v0(u) + v * v1(u);
  const Eigen::Vector3d corners = (1 - v) * ((1 - u) * u0(0.0) + u * u1(0.0)) + v * ((1 - u) * u0(1.0) + u * u1(1.0));
  return along_u + along_v - corners;
}

}  // namespace spindrift
