// SPDX-License-Identifier: Apache-2.0
#include "src/sea/potential.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/rigid/rotation.hpp"
#include "kernels/waves/cummins.hpp"
#include "kernels/waves/morison.hpp"
#include "src/scene/error.hpp"

namespace spindrift::sea {

namespace {

// Places in the memory.
constexpr std::size_t time_at = 0, head_at = 1, history_at = 2;

/// A 6x6 matrix of [force; moment] about a point, moved to the centre of mass; `arm`: from the centre to the point, earth axes.
Matrix6 moved(const Matrix6& about_point, const Eigen::Vector3d& arm) {
  Matrix6 to_point = Matrix6::Identity();  // motion of the centre to that of the point
  to_point.topRightCorner<3, 3>() = -waves::cross_matrix(arm);
  return to_point.transpose() * about_point * to_point;
}

}  // namespace

PoseOfPoint pose_of(const Motion& now, const Motion& initial, const Eigen::Vector3d& point) {
  PoseOfPoint pose;
  pose.point = now.point(point);
  pose.displacement << pose.point - initial.point(point), euler_angles(now.attitude * initial.attitude.conjugate());
  pose.velocity << now.point_velocity(point), now.omega_earth();
  return pose;
}

PotentialBody::PotentialBody(const PotentialOptions& o, const SeaEnvironment& environment, const Motion& initial,
                             const std::vector<waves::Component>& waves, double step_s)
    : environment_(environment),
      initial_(initial),
      point_(initial.attitude.conjugate() * (o.point_m - initial.position)),
      step_(step_s) {
  const WamitScale scale{o.length_m, environment.water_density, environment.gravity};
  const WamitRadiation radiation = read_radiation(o.radiation_file, scale);
  const std::size_t steps = o.radiation == "none" ? 0 : std::size_t(std::lround(o.memory_s / step_s));
  std::vector<double> damping(radiation.omega.size()), series(steps + 1);
  retardation_.assign(steps + 1, Matrix6::Zero());
  Matrix6 from_memory = Matrix6::Zero();
  double largest[6] = {};
  for (const Matrix6& b : radiation.damping)
    for (int i = 0; i < 6; ++i) largest[i] = std::max(largest[i], std::abs(b(i, i)));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double most = 0.0;
      for (std::size_t k = 0; k < damping.size(); ++k) {
        damping[k] = 0.5 * (radiation.damping[k](i, j) + radiation.damping[k](j, i));
        most = std::max(most, std::abs(damping[k]));
      }
      // Below this share of the modes' own damping a coefficient is the boundary elements' round-off.
      constexpr double noise = 1e-6;
      const bool remembers = steps > 0 && most > noise * std::sqrt(largest[i] * largest[j]) && most > 0.0;
      for (std::size_t n = 0; n <= steps && remembers; ++n)
        retardation_[n](i, j) = series[n] = waves::retardation(radiation.omega, damping, double(n) * step_s);
      const std::size_t last = radiation.omega.size() - 1;
      from_memory(i, j) = 0.5 * (radiation.added_mass[last](i, j) + radiation.added_mass[last](j, i));
      if (!remembers) continue;
      from_memory(i, j) = waves::infinite_added_mass(from_memory(i, j), radiation.omega[last], series, step_s);
      Pair pair{i, j, {}};
      for (double k : series) pair.weight.push_back(k * step_s);
      pairs_.push_back(std::move(pair));
    }
  infinite_ = radiation.infinite ? Matrix6(0.5 * (*radiation.infinite + radiation.infinite->transpose())) : from_memory;
  if (steps > 0) memory_size_ = history_at + 6 * (steps + 1);

  if (!o.hydrostatics_file.empty()) {
    linear_hydrostatics_ = true;
    stiffness_ = read_hydrostatics(o.hydrostatics_file, scale);
    const double lift = environment.water_density * environment.gravity * *o.volume_m3;
    const Eigen::Vector3d at(o.buoyancy_centre_m[0], o.buoyancy_centre_m[1], 0.0);  // its height is in the stiffness
    buoyancy_ << 0.0, 0.0, lift, (at - Eigen::Vector3d(o.point_m.x(), o.point_m.y(), 0.0)).cross(Eigen::Vector3d(0.0, 0.0, lift));
  }
  if (waves.empty()) return;
  const WamitExcitation excitation = read_excitation(o.excitation_file, scale);
  for (const waves::Component& wave : waves) {
    const double along = std::cos(wave.direction) * o.point_m.x() + std::sin(wave.direction) * o.point_m.y();
    exciting_.push_back({wave.angular_frequency, wave.phase + wave.wave_number * along,
                         wave.amplitude * excitation.at(wave.angular_frequency, wave.direction)});
  }
}

Vector6 PotentialBody::memory_force(double t, const Vector6& velocity) const {
  if (!recalled_) return Vector6::Zero();
  // Between the two times of the sums in a straight line; the newest interval by the trapezoidal rule.
  const double since = std::clamp(t - time_, 0.0, step_), share = since / step_;
  Vector6 force = (1.0 - share) * now_ + share * later_;
  force += 0.5 * since * (retardation_[0] * velocity + ((1.0 - share) * retardation_[0] + share * retardation_[1]) * newest_);
  return -force;
}

Wrench PotentialBody::load(double t, double ramp, const Motion& motion) const {
  const PoseOfPoint pose = pose_of(motion, initial_, point_);
  Vector6 force = buoyancy_ - stiffness_ * pose.displacement + memory_force(t, pose.velocity);
  for (const Exciting& e : exciting_) {
    // Re{X exp(i (w t - phase))}
    const double angle = e.omega * t - e.phase, c = std::cos(angle), s = std::sin(angle);
    force += ramp * (e.force.real() * c - e.force.imag() * s);
  }
  Wrench load{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), motion.position};
  load.add_force(force.head<3>(), pose.point);
  load.add_moment(force.tail<3>());
  return load;
}

void PotentialBody::add_added_mass(const Motion& motion, Matrix6& mass) const {
  mass += moved(infinite_, motion.point(point_) - motion.position);
}

void PotentialBody::begin(double t, const Motion& motion, std::span<double> memory) const {
  std::fill(memory.begin(), memory.end(), 0.0);  // at rest until now
  memory[time_at] = t;
  const Vector6 velocity = pose_of(motion, initial_, point_).velocity;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + history_at);
}

void PotentialBody::recall(std::span<const double> memory) {
  recalled_ = !memory.empty();
  if (!recalled_) return;
  time_ = memory[time_at];
  const std::size_t count = retardation_.size(), head = std::size_t(memory[head_at]);
  const double* history = memory.data() + history_at;
  const auto velocity = [&](std::size_t age, int mode) {
    std::size_t place = head + age;
    if (place >= count) place -= count;
    return history[6 * place + std::size_t(mode)];
  };
  now_.setZero(), later_.setZero();
  for (int mode = 0; mode < 6; ++mode) newest_[mode] = velocity(0, mode);
  for (const Pair& pair : pairs_) {
    // At t: trapezoidal over ages 0 ... count - 1. A step later, but for the newest interval: over ages 1 ... count - 1.
    double now = 0.5 * pair.weight[0] * velocity(0, pair.j), later = 0.0;
    for (std::size_t age = 1; age < count; ++age) now += pair.weight[age] * velocity(age, pair.j);
    for (std::size_t age = 1; age < count; ++age) later += pair.weight[age] * velocity(age - 1, pair.j);
    later -= 0.5 * pair.weight[1] * velocity(0, pair.j);
    now_[pair.i] += now, later_[pair.i] += later;
  }
}

void PotentialBody::remember(double t, const Motion& motion, std::span<double> memory) const {
  const std::size_t count = retardation_.size();
  const std::size_t head = memory[head_at] == 0.0 ? count - 1 : std::size_t(memory[head_at]) - 1;
  const Vector6 velocity = pose_of(motion, initial_, point_).velocity;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + std::ptrdiff_t(history_at + 6 * head));
  memory[time_at] = t, memory[head_at] = double(head);
}

}  // namespace spindrift::sea
