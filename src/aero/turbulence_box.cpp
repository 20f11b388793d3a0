// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbulence_box.hpp"

#include <algorithm>
#include <cmath>

namespace spindrift::aero {

namespace {

/// Node at or before x among n, and how far beyond it; the ends hold.
struct Place {
  std::size_t node;
  double share;
};
Place place(double x, int n) {
  if (n < 2 || !(x > 0.0)) return {0, 0.0};
  if (x >= n - 1) return {std::size_t(n - 2), 1.0};
  const double node = std::floor(x);
  return {std::size_t(node), x - node};
}

}  // namespace

Eigen::Vector3d TurbulenceBox::at(double t, double y, double z) const {
  double step = t / step_s;
  std::size_t first, second;
  double later;
  if (periodic) {
    step -= steps * std::floor(step / steps);
    const double whole = std::floor(step);
    first = std::size_t(whole) % std::size_t(steps), second = (first + 1) % std::size_t(steps), later = step - whole;
  } else {
    const Place p = place(step, steps);
    first = p.node, second = std::min(p.node + 1, std::size_t(steps - 1)), later = p.share;
  }
  const Place column = place((y + 0.5 * width()) / across_m, across), row = place((z - bottom) / up_m, up);
  const std::size_t right = std::min(column.node + 1, std::size_t(across - 1)),
                    above = std::min(row.node + 1, std::size_t(up - 1));
  const auto node = [&](std::size_t s, std::size_t r, std::size_t c) {
    const float* v = values.data() + ((s * std::size_t(up) + r) * std::size_t(across) + c) * 3;
    return Eigen::Vector3d(v[0], v[1], v[2]);
  };
  const auto plane = [&](std::size_t s) -> Eigen::Vector3d {
    const Eigen::Vector3d low = (1.0 - column.share) * node(s, row.node, column.node) + column.share * node(s, row.node, right);
    const Eigen::Vector3d high = (1.0 - column.share) * node(s, above, column.node) + column.share * node(s, above, right);
    return (1.0 - row.share) * low + row.share * high;
  };
  return (1.0 - later) * plane(first) + later * plane(second);
}

}  // namespace spindrift::aero
