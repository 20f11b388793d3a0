// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/time_error.hpp"

#include <algorithm>
#include <cmath>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

TimeError::TimeError(const FlowSetting& setting, TileArrays& arrays, const PhysicalTime& time, const FlowResidual& residual)
    : asked_(setting.time_tolerance.has_value()),
      arrays_(arrays),
      time_(time),
      residual_(residual),
      gas_(setting.gas),
      least_(1e-4 * gas::density(setting.gas, setting.stream) * setting.speed) {
  if (asked_) sums.resize(arrays.tiles.size(), 2);
}

void TimeError::measure(std::size_t owned) {
  const std::span<double> partial = sums.of(owned);
  std::ranges::fill(partial, 0.0);
  if (!known()) return;
  const std::size_t levels = std::size_t(time_.order) + 1;
  // Lagrange's weights at the end of the step of the levels before it.
  std::array<double, most_levels> weights{};
  for (std::size_t n = 0; n < levels; ++n) {
    weights[n] = 1.0;
    for (std::size_t m = 0; m < levels; ++m)
      if (m != n) weights[n] *= time_.ago[m] / (time_.ago[m] - time_.ago[n]);
  }
  const double share = milne_share(time_.weights.now, time_.ago[levels - 1] / time_.dt);
  const FlowTile& tile = arrays_.tiles[owned];
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t component = tile.inner.component;
  for_rows(tile.box, [&](int k, int j) {
    double error = 0.0, beyond = 0.0;
    for (int i = 0; i < tile.box.ni; ++i) {
      const auto w = gas::conserved(
          gas_, gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component)));
      const double volume = g.volume_data.data()[g.cell_box.at(k, j, i)];
      const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
      const Eigen::Vector3d place(x[0], x[g.cell_box.component], x[2 * g.cell_box.component]);
      // Beyond the stream at each level, so that cells whose volume changes, and a wind that does, have no error by themselves.
      const Eigen::Vector3d now = Eigen::Vector3d(w.mx, w.my, w.mz) - w.rho * residual_.undisturbed(place, 0.0);
      Eigen::Vector3d off = volume * now;
      for (std::size_t n = 0; n < levels; ++n) {
        const double* past = tile.past[n].data() + tile.inner.at(k, j, i);
        off -= weights[n] * (Eigen::Vector3d(past[component], past[2 * component], past[3 * component]) -
                             past[0] * residual_.undisturbed(place, time_.ago[n]));
      }
      error += off.squaredNorm() / volume;
      beyond += volume * (now.squaredNorm() + least_ * least_);
    }
    partial[0] += share * share * error, partial[1] += beyond;
  });
}

std::optional<double> TimeError::estimate() const {
  if (!known()) return {};
  return std::sqrt(sums.result[0] / sums.result[1]);
}

bool WindowSteps::refine(double error) {
  if (!too_large(error) || count_ == most) return false;
  count_ *= 2;
  return true;
}

void WindowSteps::end_window(double error) {
  if (count_ > 1 && error < std::ldexp(tolerance_, -(order_ + 2))) count_ /= 2;
}

}  // namespace spindrift::aero
