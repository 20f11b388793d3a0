// The undisturbed sea: see wave_field.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_field.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/waves/realisation.hpp"
#include "kernels/waves/stokes.hpp"

namespace spindrift::sea {
namespace {

std::vector<waves::Component> regular_wave(const WavesOptions& options, const SeaEnvironment& environment) {
  const double omega = 2.0 * pi / options.period_s, amplitude = 0.5 * options.height_m;
  const waves::Component airy{.wave_number = waves::wave_number(omega, environment.water_depth, environment.gravity),
                              .angular_frequency = omega,
                              .amplitude = amplitude,
                              .speed_amplitude = amplitude * omega,
                              .phase = options.phase,
                              .direction = options.direction};
  if (options.model == "airy") return {airy};
  return {airy, waves::stokes_second(airy, environment.water_depth)};
}

std::vector<waves::Component> irregular_sea(const WavesOptions& options, const SeaEnvironment& environment) {
  waves::SeaState sea{options.height_m, options.period_s, 1.0};
  if (options.model == "jonswap")
    sea.peak_enhancement = options.peak_enhancement.value_or(waves::peak_enhancement(options.height_m, options.period_s));
  std::vector<waves::Component> components(std::size_t(options.components));
  if (options.spacing == "equal_energy")
    waves::equal_energy(sea, components);
  else
    waves::equal_frequency(sea, components);
  waves::finish_realisation(sea, std::uint64_t(options.seed), options.direction, environment.water_depth, environment.gravity,
                            components);
  return components;
}

}  // namespace

WaveField::WaveField(const WavesOptions& options, const SeaEnvironment& environment)
    : depth_(environment.water_depth), ramp_end_(options.ramp_s) {
  if (options.model == "none" || options.height_m == 0.0) return;
  const bool regular = options.model == "airy" || options.model == "stokes2";
  components_ = regular ? regular_wave(options, environment) : irregular_sea(options, environment);
  groups_.resize((components_.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < components_.size(); ++i)
    waves::set_lane(groups_[i / lanes], int(i % lanes), components_[i], depth_);
  // A Stokes wave is an expansion about still water that holds up to the crest: stretching it would undo its second order.
  if (options.model == "stokes2" || options.stretching == "extrapolated")
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
