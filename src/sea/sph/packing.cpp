// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/sph/kernel_wendland.hpp"

namespace spindrift::sph {

namespace {

constexpr double h_over_spacing = 1.5;  // support of three spacings
constexpr int turns = 200;              // the concentration is then even to a few per mille (tank_test.cpp)

/// Points by cells of a support's width, in a box round all of them.
template <int dim>
class Cells {
 public:
  Cells(std::span<const std::array<double, dim>> points, double width) : width_(width) {
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
  /// Points of the cells round a place.
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

}  // namespace

template <int dim>
void pack_evenly(std::vector<std::array<double, dim>>& points, std::span<const std::array<double, dim>> fixed, double spacing) {
  if (points.empty()) return;
  const KernelWendland<dim> kernel(h_over_spacing * spacing);
  const double h = kernel.h(), volume = std::pow(spacing, dim), support = 2.0 * h;
  constexpr double rate = 0.4, longest = 0.1;  // of h^2 times the gradient; of a spacing, in one turn
  const std::size_t moving = points.size();
  const std::vector<std::array<double, dim>> start = points;
  std::vector<std::array<double, dim>> all = points, next(moving);
  all.insert(all.end(), fixed.begin(), fixed.end());
  for (int turn = 0; turn < turns; ++turn) {
    const Cells<dim> cells(all, support);
    for (std::size_t i = 0; i < moving; ++i) {
      std::array<double, dim> way{};
      cells.for_near(all[i], [&](std::uint32_t j) {
        std::array<double, dim> x;
        double r2 = 0.0;
        for (int k = 0; k < dim; ++k) x[k] = all[i][k] - all[j][k], r2 += x[k] * x[k];
        if (r2 >= support * support || j == i) return;
        const double push = -rate * h * h * volume * kernel.slope(std::max(r2, 1e-30));
        for (int k = 0; k < dim; ++k) way[k] += push * x[k];
      });
      double length = 0.0, whole = 0.0;
      for (int k = 0; k < dim; ++k) length += way[k] * way[k];
      const double factor = std::min(1.0, longest * spacing / std::max(std::sqrt(length), 1e-30));
      for (int k = 0; k < dim; ++k) next[i][k] = all[i][k] + factor * way[k], whole += std::pow(next[i][k] - start[i][k], 2);
      if (whole > spacing * spacing) next[i] = all[i];
    }
    std::copy(next.begin(), next.end(), all.begin());
  }
  points = std::move(next);
}
template void pack_evenly<2>(std::vector<std::array<double, 2>>&, std::span<const std::array<double, 2>>, double);
template void pack_evenly<3>(std::vector<std::array<double, 3>>&, std::span<const std::array<double, 3>>, double);

}  // namespace spindrift::sph
