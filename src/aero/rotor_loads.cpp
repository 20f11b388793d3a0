// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_loads.hpp"

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

namespace {

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
      wind_(wind_of(wind)) {
  const Motion& body = start[placement.body];
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
  if (aero.thrust_frame == "earth") thrust_direction_ = axis;
  if (aero.model == "prescribed") model_ = Prescribed(aero);
  if (aero.model == "thrust_curve") model_ = ThrustCurve(aero, rotor, air_density);
  if (aero.model == "bem") model_ = BladeElementMomentum(read_turbine(rotor.turbine), aero.induction, air_density);
}

Eigen::Quaterniond RotorLoads::support_attitude(std::span<const Motion> bodies) const {
  if (!placement_.support) return bodies[placement_.body].attitude;
  return *placement_.support == RotorPlacement::earth ? Eigen::Quaterniond::Identity() : bodies[*placement_.support].attitude;
}

RotorState RotorLoads::state(double t, std::span<const Motion> bodies) const {
  const Motion& body = bodies[placement_.body];
  const Eigen::Quaterniond support = support_attitude(bodies);
  RotorState now;
  now.hub = body.point(hub_);
  now.hub_velocity = body.point_velocity(hub_);
  now.axis = body.attitude * axis_;
  now.up = support * support_up_;
  now.omega = body.omega_earth();
  now.relative_wind = relative_wind(now.hub, now.hub_velocity, now.axis);
  if (!placement_.support) {
    now.azimuth = whole_turns_off(start_azimuth_ + speed_ * t);
    now.speed = speed_;
    now.omega += speed_ * now.axis;
    return now;
  }
  const Eigen::Quaterniond since = support.conjugate() * body.attitude * start_turn_.conjugate();
  now.azimuth = whole_turns_off(start_azimuth_ + 2.0 * std::atan2(since.vec().dot(support_axis_), since.w()));
  now.speed = now.omega.dot(now.axis);
  if (*placement_.support != RotorPlacement::earth) now.speed -= bodies[*placement_.support].omega_earth().dot(now.axis);
  return now;
}

RotorLoad RotorLoads::load(double t, const RotorState& now, double ramp) const {
  RotorLoad load;
  if (const auto* bem = std::get_if<BladeElementMomentum>(&model_)) {
    const DiscLoad disc = (*bem)(wind_, {now.hub_velocity, now.omega, now.axis, now.up, now.azimuth, blade_pitch_, now.hub});
    load.force = ramp * disc.force, load.moment = ramp * disc.moment;
    load.thrust = load.force.dot(now.axis), load.torque = load.moment.dot(now.axis);
  } else {
    AxialLoad axial;
    if (const auto* prescribed = std::get_if<Prescribed>(&model_)) axial = (*prescribed)(t, now.azimuth);
    if (const auto* curve = std::get_if<ThrustCurve>(&model_)) axial = (*curve)(now.relative_wind, now.speed, blade_pitch_);
    load.thrust = ramp * axial.thrust, load.torque = ramp * axial.torque;
    load.force = load.thrust * thrust_direction_.value_or(now.axis), load.moment = load.torque * now.axis;
  }
  load.power = load.torque * now.speed;
  return load;
}

void RotorLoads::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp) const {
  const RotorState now = state(t, bodies);
  const RotorLoad load = this->load(t, now, ramp);
  wrenches[placement_.body].add_force(load.force, now.hub);
  wrenches[placement_.body].add_moment(load.moment);
}

void RotorLoads::add_at_hub(std::span<const Motion> bodies, std::span<Wrench> wrenches, const Eigen::Vector3d& force,
                            const Eigen::Vector3d& moment) const {
  wrenches[placement_.body].add_force(force, bodies[placement_.body].point(hub_));
  wrenches[placement_.body].add_moment(moment);
}

}  // namespace spindrift::aero
