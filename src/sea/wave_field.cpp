// The undisturbed sea: see wave_field.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_field.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/waves/constrained.hpp"
#include "kernels/waves/diffraction_maccamy_fuchs.hpp"
#include "kernels/waves/directional.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

double bound_wave_limit(double significant_height, double gravity) { return std::sqrt(2.0 * gravity / significant_height); }

WaveField::WaveField(const WavesOptions& options, const SeaEnvironment& environment)
    : depth_(environment.water_depth), ramp_end_(options.ramp_s.value_or(0.0)) {
  if (options.model == "none") return;
  const WaveModel& model = wave_models().named(options.model);
  if (options.height_m == 0.0 && std::ranges::find(model.keys, "height_m") != model.keys.end()) return;
  components_ = model.components(options, environment);
  if (options.spreading_exponent)
    waves::spread(components_, *options.spreading_exponent, options.spreading_range, std::uint64_t(options.seed));
  if (options.crest_height_m)
    waves::raise_crest(components_, {*options.crest_height_m, options.crest_time_s, options.crest_place_m[0],
                                     options.crest_place_m[1], !options.crest_alone});
  groups_ = waves::grouped(components_, depth_);
  if (options.second_order) {
    std::vector<waves::Component> carriers = components_;
    std::erase_if(carriers, [limit = bound_wave_limit(options.height_m, environment.gravity)](const waves::Component& c) {
      return c.angular_frequency > limit;
    });
    bound_ = waves::BoundWaves(carriers, depth_, environment.gravity);
  }
  // Stretching a nonlinear wave would undo its order.
  if (model.nonlinear || options.stretching == "extrapolated")
    stretching_ = Stretching::extrapolated;
  else if (options.stretching == "vertical")
    stretching_ = Stretching::vertical;
}

std::vector<waves::ComponentGroup> WaveField::scattered(double radius) const {
  std::vector<waves::Component> components = components_;
  for (waves::Component& c : components) {
    const std::complex<double> inertia = waves::maccamy_fuchs(c.wave_number * radius);
    c.speed_amplitude *= std::abs(inertia), c.phase += std::arg(inertia);
  }
  return waves::grouped(components, depth_);
}

double WaveField::ramp(double t) const {
  if (ramp_end_ == 0.0 || t >= ramp_end_) return 1.0;
  return t <= 0.0 ? 0.0 : 0.5 * (1.0 - std::cos(pi * t / ramp_end_));
}

waves::Surface WaveField::surface(double t, double x, double y) const {
  waves::Surface s = waves::surface(groups_, t, x, y);
  const double r = ramp(t);
  s.elevation *= r, s.slope_x *= r, s.slope_y *= r;
  if (!bound_.empty()) {
    const waves::Surface b = bound_.surface(t, x, y);
    s.elevation += r * r * b.elevation, s.slope_x += r * r * b.slope_x, s.slope_y += r * r * b.slope_y;
  }
  return s;
}

waves::Kinematics WaveField::kinematics(double t, const Eigen::Vector3d& point, double elevation,
                                        std::span<const waves::ComponentGroup> groups) const {
  double z = std::min(point.z(), elevation);
  if (stretching_ == Stretching::wheeler)
    z = (z - elevation) * depth_ / (depth_ + elevation);
  else if (stretching_ == Stretching::vertical)
    z = std::min(z, 0.0);
  waves::Kinematics k = waves::kinematics(groups, t, point.x(), point.y(), std::max(z, -depth_));
  const double r = ramp(t);
  k.velocity *= r, k.acceleration *= r, k.pressure_over_density *= r;
  return k;
}

// To second order above still water: the linear waves by their value and slope at z = 0, the bound ones by their value.
waves::Kinematics WaveField::second_order(double t, const Eigen::Vector3d& point, double elevation) const {
  const double z = std::max(std::min(point.z(), elevation), -depth_), r = ramp(t), square = r * r;
  waves::Kinematics k = z > 0.0 ? waves::kinematics_above(groups_, t, point.x(), point.y(), z)
                                : waves::kinematics(groups_, t, point.x(), point.y(), z);
  const waves::Kinematics b = bound_.kinematics(t, point.x(), point.y(), std::min(z, 0.0));
  k.pressure_over_density = r * k.pressure_over_density + square * (b.pressure_over_density - 0.5 * k.velocity.squaredNorm());
  k.velocity = r * k.velocity + square * b.velocity;
  k.acceleration = r * k.acceleration + square * b.acceleration;
  return k;
}

}  // namespace spindrift::sea
