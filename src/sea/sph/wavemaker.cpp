// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/wavemaker.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/smooth_step.hpp"
#include "kernels/waves/wavemaker.hpp"

namespace spindrift::sph {

Wavemaker::Wavemaker(const Paddle& paddle, std::span<const waves::Component> components, bool second_order, double stroke)
    : paddle_(paddle) {
  const double depth = -paddle.bed;
  for (const waves::Component& c : components) {
    const double kh = c.wave_number * depth;
    const double transfer =
        paddle.flap ? waves::flap_transfer(kh, c.wave_number * (paddle.hinge - paddle.bed)) : waves::piston_transfer(kh);
    // a cos(k x - omega t + phase) comes from S/2 sin(omega t - k x_paddle - phase): the wave is in step with the paddle's speed.
    const double phase = -c.wave_number * paddle.x - c.phase;
    const double amplitude = stroke > 0.0 ? 0.5 * stroke : c.amplitude / transfer;
    harmonics_.push_back({amplitude, c.angular_frequency, phase});
    if (second_order) {
      harmonics_.push_back({waves::piston_second(2.0 * amplitude * transfer, depth, kh), 2.0 * c.angular_frequency, 2.0 * phase});
      break;
    }
  }
  if (paddle.ramp_s > 0.0) return;
  const double start = of_harmonics(paddle.start_s).displacement;
  (paddle.in_waves ? before_ : offset_) = start;
}

Wavemaker::Stroke Wavemaker::of_harmonics(double t) const {
  Stroke s{0.0, 0.0};
  for (const Harmonic& h : harmonics_) {
    s.displacement += h.amplitude * std::sin(h.omega * t + h.phase);
    s.velocity += h.amplitude * h.omega * std::cos(h.omega * t + h.phase);
  }
  return s;
}

Wavemaker::Stroke Wavemaker::stroke(double t) const {
  const double since = t - paddle_.start_s;
  if (since <= 0.0) return {before_, 0.0};
  Stroke s = of_harmonics(t);
  s.displacement -= offset_;
  if (since >= paddle_.ramp_s) return s;
  const double x = since / paddle_.ramp_s, ramp = smooth_step(x), rate = 6.0 * x * (1.0 - x) / paddle_.ramp_s;
  return {ramp * s.displacement, ramp * s.velocity + rate * s.displacement};
}

Motion Wavemaker::at_rest() const { return {.position = {paddle_.x, 0.0, paddle_.flap ? paddle_.hinge : 0.0}}; }

Motion Wavemaker::motion(double t) const {
  const Stroke s = stroke(t);
  Motion m = at_rest();
  if (!paddle_.flap) {
    m.position[0] += s.displacement, m.velocity[0] = s.velocity;
    return m;
  }
  const double arm = -paddle_.hinge, slope = s.displacement / arm;
  m.attitude = Eigen::AngleAxisd(std::atan(slope), Eigen::Vector3d::UnitY());
  m.omega[1] = s.velocity / arm / (1.0 + slope * slope);
  return m;
}

double Wavemaker::reach() const {
  double sum = std::abs(offset_);
  for (const Harmonic& h : harmonics_) sum += std::abs(h.amplitude);
  return sum;
}

}  // namespace spindrift::sph
