// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/packing.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/sph/kernel_wendland.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/sea/sph/point_cells.hpp"

namespace spindrift::sph {

namespace {

constexpr double h_over_spacing = 1.5;  // support of three spacings
constexpr int turns = 200;              // the concentration is then even to a few per mille (tank_test.cpp)

/// Adds those images of the points that are within `reach` of the sides; of both horizontal axes one after the other, so that
/// corners have theirs.
template <int dim>
void add_images(std::vector<std::array<double, dim>>& points, const ImageSides& sides, double reach) {
  for (int k = 0; k < dim - 1; ++k) {
    if (!sides.period[std::size_t(k)]) continue;
    const auto [low, high] = *sides.period[std::size_t(k)];
    for (std::size_t n = 0, end = points.size(); n < end; ++n) {
      std::array<double, dim> image = points[n];
      const double x = image[k];
      if (x < low + reach) image[k] = x + (high - low), points.push_back(image);
      if (x > high - reach) image[k] = x - (high - low), points.push_back(image);
    }
  }
  for (std::size_t n = 0, end = points.size(); n < end && sides.plane; ++n) {
    std::array<double, dim> image = points[n];
    image[1] = 2.0 * *sides.plane - image[1];
    if (points[n][1] - *sides.plane < reach) points.push_back(image);
  }
}

}  // namespace

template <int dim>
void pack_evenly(std::vector<std::array<double, dim>>& points, std::span<const std::array<double, dim>> fixed, double spacing,
                 const ImageSides& sides) {
  if (points.empty()) return;
  const KernelWendland<dim> kernel(h_over_spacing * spacing);
  const double h = kernel.h(), volume = std::pow(spacing, dim), support = 2.0 * h;
  constexpr double rate = 0.4, longest = 0.1;  // of h^2 times the gradient; of a spacing, in one turn
  const std::size_t moving = points.size();
  const std::vector<std::array<double, dim>> start = points;
  std::vector<std::array<double, dim>> all = points, next(moving);
  all.insert(all.end(), fixed.begin(), fixed.end());
  const std::size_t without_images = all.size();
  for (int turn = 0; turn < turns; ++turn) {
    all.resize(without_images);
    add_images<dim>(all, sides, support);
    const PointCells<dim> cells(all, support);
    runtime::StopRequest::give_up_if_asked();
    // Each point's way is summed by itself, in the order of the cells: the same on any number of threads.
#pragma omp parallel for schedule(dynamic, 64)
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
template void pack_evenly<2>(std::vector<std::array<double, 2>>&, std::span<const std::array<double, 2>>, double,
                             const ImageSides&);
template void pack_evenly<3>(std::vector<std::array<double, 3>>&, std::span<const std::array<double, 3>>, double,
                             const ImageSides&);

}  // namespace spindrift::sph
