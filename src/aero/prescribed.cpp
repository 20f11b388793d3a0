// SPDX-License-Identifier: Apache-2.0
#include "src/aero/prescribed.hpp"

#include <algorithm>

#include "kernels/base/interpolation.hpp"
#include "kernels/rotor/fourier.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

Prescribed::Prescribed(const AeroOptions& o)
    : thrust_{o.thrust_N.value_or(0.0), o.thrust_cosine_N, o.thrust_sine_N},
      torque_{o.torque_N_m, o.torque_cosine_N_m, o.torque_sine_N_m},
      harmonic_step_(o.harmonic_step) {
  if (o.table.empty()) return;
  const scene::Columns file = scene::read_columns(o.table);
  file.allow_only({"time_s", "thrust_N", "torque_N_m"});
  file.require_rows(2);
  file.require_increasing("time_s", "time");
  const auto copy = [&](const char* name) { return std::vector<double>(file[name].begin(), file[name].end()); };
  time_ = copy("time_s");
  table_thrust_ = copy("thrust_N");
  table_torque_ = file.has("torque_N_m") ? copy("torque_N_m") : std::vector<double>(time_.size(), 0.0);
  if (o.interpolation == "cubic") {
    thrust_slope_.resize(time_.size()), torque_slope_.resize(time_.size());
    monotone_slopes(time_, table_thrust_, thrust_slope_);
    monotone_slopes(time_, table_torque_, torque_slope_);
  }
}

AxialLoad Prescribed::operator()(double t, double azimuth) const {
  if (time_.empty()) {
    const auto at = [&](const Series& s) { return fourier(s.mean, s.cosine, s.sine, harmonic_step_ * azimuth); };
    return {at(thrust_), at(torque_)};
  }
  if (thrust_slope_.empty()) return {interpolate_linear(time_, table_thrust_, t), interpolate_linear(time_, table_torque_, t)};
  const double inside = std::clamp(t, time_.front(), time_.back());
  return {interpolate_hermite(time_, table_thrust_, thrust_slope_, inside).value,
          interpolate_hermite(time_, table_torque_, torque_slope_, inside).value};
}

}  // namespace spindrift::aero
