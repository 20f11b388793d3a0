// The undisturbed sea: see wave_field.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_field.hpp"

#include <algorithm>
#include <cmath>

#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

WaveField::WaveField(const WavesOptions& options, const SeaEnvironment& environment)
    : depth_(environment.water_depth), ramp_end_(options.ramp_s) {
  if (options.model == "none" || options.height_m == 0.0) return;
  const WaveModel& model = wave_models().named(options.model);
  components_ = model.components(options, environment);
  groups_.resize((components_.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < components_.size(); ++i)
    waves::set_lane(groups_[i / lanes], int(i % lanes), components_[i], depth_);
  // Stretching a wave of second order would undo that order.
  if (model.second_order || options.stretching == "extrapolated")
    stretching_ = Stretching::extrapolated;
  else if (options.stretching == "vertical")
    stretching_ = Stretching::vertical;
}

double WaveField::ramp(double t) const {
  if (ramp_end_ == 0.0 || t >= ramp_end_) return 1.0;
  return t <= 0.0 ? 0.0 : 0.5 * (1.0 - std::cos(pi * t / ramp_end_));
}

waves::Surface WaveField::surface(double t, double x, double y) const {
  waves::Surface s = waves::surface(groups_, t, x, y);
  const double r = ramp(t);
  s.elevation *= r, s.slope_x *= r, s.slope_y *= r;
  return s;
}

waves::Kinematics WaveField::kinematics(double t, const Eigen::Vector3d& point, double elevation) const {
  double z = std::min(point.z(), elevation);
  if (stretching_ == Stretching::wheeler)
    z = (z - elevation) * depth_ / (depth_ + elevation);
  else if (stretching_ == Stretching::vertical)
    z = std::min(z, 0.0);
  waves::Kinematics k = waves::kinematics(groups_, t, point.x(), point.y(), std::max(z, -depth_));
  const double r = ramp(t);
  k.velocity *= r, k.acceleration *= r, k.pressure_over_density *= r;
  return k;
}

}  // namespace spindrift::sea
