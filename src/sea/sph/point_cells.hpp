// Points by cells of a box round all of them, to find those near a place: of packing and filling before a run.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spindrift::sph {

template <int dim>
class PointCells {
 public:
  /// Of cells `width` wide [m]. The points are read here only.
  PointCells(std::span<const std::array<double, dim>> points, double width) : width_(width) {
    std::array<double, dim> high;
    low_.fill(1e300), high.fill(-1e300);
    for (const auto& x : points)
      for (int k = 0; k < dim; ++k) low_[k] = std::min(low_[k], x[k]), high[k] = std::max(high[k], x[k]);
    std::size_t cells = 1;
    for (int k = 0; k < dim; ++k) count_[k] = int((high[k] - low_[k]) / width_) + 1, cells *= std::size_t(count_[k]);
    begin_.assign(cells + 1, 0), of_.resize(points.size());
    for (const auto& x : points) ++begin_[cell(index(x)) + 1];
    for (std::size_t c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t n = 0; n < points.size(); ++n) of_[next[cell(index(points[n]))]++] = std::uint32_t(n);
  }
  /// Points of the cells round a place, all that are nearer than a width.
  template <class Visit>
  void for_near(const std::array<double, dim>& x, Visit&& visit) const {
    const auto at = index(x);
    std::array<int, dim> from, to, i;
    for (int k = 0; k < dim; ++k) from[k] = std::max(at[k] - 1, 0), to[k] = std::min(at[k] + 1, count_[k] - 1), i[k] = from[k];
    for (int axis = dim - 1; axis >= 0;) {
      const std::size_t c = cell(i);
      for (std::uint32_t n = begin_[c]; n < begin_[c + 1]; ++n) visit(of_[n]);
      for (axis = dim - 1; axis >= 0 && ++i[std::size_t(axis)] > to[std::size_t(axis)]; --axis)
        i[std::size_t(axis)] = from[std::size_t(axis)];
    }
  }

 private:
  std::array<int, dim> index(const std::array<double, dim>& x) const {
    std::array<int, dim> i;
    for (int k = 0; k < dim; ++k) i[k] = std::clamp(int((x[k] - low_[k]) / width_), 0, count_[k] - 1);
    return i;
  }
  std::size_t cell(const std::array<int, dim>& i) const {
    std::size_t c = 0;
    for (int k = 0; k < dim; ++k) c = c * std::size_t(count_[k]) + std::size_t(i[k]);
    return c;
  }
  double width_;
  std::array<double, dim> low_;
  std::array<int, dim> count_;
  std::vector<std::uint32_t> begin_, of_;
};

}  // namespace spindrift::sph
