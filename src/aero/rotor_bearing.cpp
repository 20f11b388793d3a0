// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_bearing.hpp"

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::aero {

double whole_turns_off(double angle) {
  const double rest = std::fmod(angle, 2 * pi);
  return rest < 0.0 ? rest + 2 * pi : rest;
}

RotorBearing::RotorBearing(const RotorPlacement& placement, double azimuth, std::span<const Motion> start)
    : placement_(placement), start_azimuth_(azimuth) {
  const Motion& body = start[this->body()];
  const Eigen::Vector3d axis = placement.axis.normalized();
  hub_ = body.attitude.conjugate() * (placement.hub - body.position);
  axis_ = body.attitude.conjugate() * axis;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - axis.z() * axis;
  if (up.norm() < 1e-6)
    up = Eigen::Vector3d::UnitX() - axis.x() * axis;  // a vertical axis has no upright blade: downwind instead
  const Eigen::Quaterniond support = support_attitude(start).conjugate();
  support_axis_ = support * axis;
  support_up_ = support * up.normalized();
  start_turn_ = support * body.attitude;
}

std::optional<std::size_t> RotorBearing::carrier() const {
  const int index = placement_.support.value_or(placement_.body);
  return index == RotorPlacement::earth ? std::nullopt : std::optional(std::size_t(index));
}

Eigen::Quaterniond RotorBearing::support_attitude(std::span<const Motion> bodies) const {
  if (!placement_.support) return bodies[body()].attitude;
  return *placement_.support == RotorPlacement::earth ? Eigen::Quaterniond::Identity() : bodies[*placement_.support].attitude;
}

RotorState RotorBearing::state(std::span<const Motion> bodies, double azimuth, double speed) const {
  const Motion& body = bodies[this->body()];
  const Eigen::Quaterniond support = support_attitude(bodies);
  RotorState now;
  now.hub = body.point(hub_);
  now.hub_velocity = body.point_velocity(hub_);
  now.axis = body.attitude * axis_;
  now.up = support * support_up_;
  now.omega = body.omega_earth();
  now.sense = placement_.sense;
  if (!is_turned()) {
    now.speed = speed;
    now.azimuth = whole_turns_off(azimuth);
    now.omega += now.speed * now.shaft();
    return now;
  }
  const Eigen::Quaterniond since = support.conjugate() * body.attitude * start_turn_.conjugate();
  now.azimuth = whole_turns_off(start_azimuth_ + now.sense * 2.0 * std::atan2(since.vec().dot(support_axis_), since.w()));
  now.speed = now.omega.dot(now.shaft());
  if (*placement_.support != RotorPlacement::earth) now.speed -= bodies[*placement_.support].omega_earth().dot(now.shaft());
  return now;
}

void RotorBearing::add_load(std::span<const Motion> bodies, std::span<Wrench> wrenches, const Eigen::Vector3d& force,
                            const Eigen::Vector3d& moment) const {
  wrenches[body()].add_force(force, bodies[body()].point(hub_));
  wrenches[body()].add_moment(moment);
}

}  // namespace spindrift::aero
