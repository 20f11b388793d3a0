// Grid lines that leave a wall: smoothed normals of a closed polygon, and cubic Bezier curves walked by length.
// Used by src/aero/rotor_grid/plane.cpp and wing.cpp; tested in tests/kernels/grid/ray_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "kernels/base/constants.hpp"

namespace spindrift {

/// Outward normals of a counter-clockwise closed polygon at its nodes, as angles [rad], smoothed over `sweeps` passes of
/// (1/4, 1/2, 1/4), which reaches about sqrt(sweeps / 2) nodes. `work` has the size of `angle`.
inline void smoothed_normals(std::span<const Eigen::Vector2d> nodes, int sweeps, std::span<double> angle,
                             std::span<double> work) {
  const std::size_t n = nodes.size();
  for (std::size_t i = 0; i < n; ++i) {
    // Mean of the adjoining edges' directions: a node between a long and a short edge must not follow the long one alone.
    const Eigen::Vector2d before = (nodes[i] - nodes[(i + n - 1) % n]).normalized(),
                          after = (nodes[(i + 1) % n] - nodes[i]).normalized();
    const Eigen::Vector2d t = before + after;
    angle[i] = std::atan2(-t.x(), t.y());
  }
  const auto difference = [](double a, double b) { return std::remainder(a - b, 2.0 * pi); };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < n; ++i)
      work[i] = angle[i] + 0.25 * (difference(angle[(i + 1) % n], angle[i]) + difference(angle[(i + n - 1) % n], angle[i]));
    std::copy(work.begin(), work.end(), angle.begin());
  }
}

/// A cubic Bezier curve with a table of its length.
class Ray {
 public:
  explicit Ray(const std::array<Eigen::Vector2d, 4>& points) : p_(points) {
    Eigen::Vector2d last = p_[0];
    for (int m = 1; m <= pieces; ++m) {
      const Eigen::Vector2d next = at(double(m) / pieces);
      length_[std::size_t(m)] = length_[std::size_t(m) - 1] + (next - last).norm();
      last = next;
    }
  }
  double length() const { return length_.back(); }
  /// At the curve's own parameter in [0, 1].
  Eigen::Vector2d at(double t) const {
    const double u = 1.0 - t;
    return u * u * u * p_[0] + 3.0 * u * u * t * p_[1] + 3.0 * u * t * t * p_[2] + t * t * t * p_[3];
  }
  /// The parameter between the table's entries by the cubic with the right speeds at both: a first cell far thinner than a piece
  /// keeps its height where the curve speeds up.
  Eigen::Vector2d at_length(double s) const {
    const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, s);
    const std::size_t m = std::size_t(above - length_.begin()) - 1;
    const double h = length_[m + 1] - length_[m], v = (s - length_[m]) / h, w = 1.0 - v, step = 1.0 / pieces;
    const double rate0 = h / speed(double(m) / pieces), rate1 = h / speed(double(m + 1) / pieces);
    return at(double(m) / pieces + v * v * (3.0 - 2.0 * v) * step + v * w * (w * rate0 - v * rate1));
  }

 private:
  double speed(double t) const {
    const double u = 1.0 - t;
    return 3.0 * (u * u * (p_[1] - p_[0]) + 2.0 * u * t * (p_[2] - p_[1]) + t * t * (p_[3] - p_[2])).norm();
  }
  static constexpr int pieces = 96;
  std::array<Eigen::Vector2d, 4> p_;
  std::array<double, pieces + 1> length_{};
};

}  // namespace spindrift
