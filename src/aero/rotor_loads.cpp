// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_loads.hpp"

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

namespace {

/// Attitude of a body seen from its support.
Eigen::Quaterniond turn(const Motion& body, const std::optional<int>& support, std::span<const Motion> bodies) {
  if (!support || *support == RotorPlacement::earth) return body.attitude;
  return bodies[*support].attitude.conjugate() * body.attitude;
}

double whole_turns_off(double angle) {
  const double rest = std::fmod(angle, 2 * pi);
  return rest < 0.0 ? rest + 2 * pi : rest;
}

}  // namespace

RotorLoads::RotorLoads(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                       const RotorPlacement& placement, std::span<const Motion> start)
    : placement_(placement),
      start_azimuth_(rotor.azimuth),
      speed_(rotor.speed),
      blade_pitch_(rotor.blade_pitch),
      wind_(wind_velocity(wind)) {
  const Motion& body = start[placement.body];
  const Eigen::Vector3d axis = placement.axis.normalized();
  hub_ = body.attitude.conjugate() * (placement.hub - body.position);
  axis_ = body.attitude.conjugate() * axis;
  const bool moving_support = placement.support && *placement.support != RotorPlacement::earth;
  support_axis_ = moving_support ? Eigen::Vector3d(start[*placement.support].attitude.conjugate() * axis) : axis;
  start_turn_ = turn(body, placement.support, start);
  if (aero.model == "prescribed") model_ = Prescribed(aero);
  if (aero.model == "thrust_curve") model_ = ThrustCurve(aero, rotor, air_density);
}

RotorState RotorLoads::state(double t, std::span<const Motion> bodies) const {
  const Motion& body = bodies[placement_.body];
  RotorState now;
  now.hub = body.point(hub_);
  now.hub_velocity = body.point_velocity(hub_);
  now.axis = body.attitude * axis_;
  now.relative_wind = (wind_ - now.hub_velocity).dot(now.axis);
  if (!placement_.support) {
    now.azimuth = whole_turns_off(start_azimuth_ + speed_ * t);
    now.speed = speed_;
    return now;
  }
  const Eigen::Quaterniond since = turn(body, placement_.support, bodies) * start_turn_.conjugate();
  now.azimuth = whole_turns_off(start_azimuth_ + 2.0 * std::atan2(since.vec().dot(support_axis_), since.w()));
  Eigen::Vector3d spin = body.omega_earth();
  if (*placement_.support != RotorPlacement::earth) spin -= bodies[*placement_.support].omega_earth();
  now.speed = spin.dot(now.axis);
  return now;
}

RotorLoad RotorLoads::load(double t, const RotorState& now, double ramp) const {
  AxialLoad load;
  if (const auto* prescribed = std::get_if<Prescribed>(&model_)) load = (*prescribed)(t, now.azimuth);
  if (const auto* curve = std::get_if<ThrustCurve>(&model_)) load = (*curve)(now.relative_wind, now.speed, blade_pitch_);
  return {ramp * load.thrust, ramp * load.torque, ramp * load.torque * now.speed};
}

void RotorLoads::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp) const {
  const RotorState now = state(t, bodies);
  const RotorLoad load = this->load(t, now, ramp);
  wrenches[placement_.body].add_force(load.thrust * now.axis, now.hub);
  wrenches[placement_.body].add_moment(load.torque * now.axis);
}

}  // namespace spindrift::aero
