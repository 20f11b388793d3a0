// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

namespace {

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (double v : values) sum += v;
  return sum / double(values.size());
}

TowerFrame tower_frame(const RotorState& now) { return {now.hub, now.axis, now.up, now.hub_velocity, now.carrier_omega()}; }

/// Steady, in wind along the axis, of a rigid rotor away from its tower.
AxialLoad steady_load(const BladeElementMomentum& bem, double wind, double speed, double pitch) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  const DiscLoad disc =
      bem(Eigen::Vector3d(wind * axis), {Eigen::Vector3d::Zero(), speed * axis, axis, Eigen::Vector3d::UnitZ(), 0.0, pitch});
  return {disc.force.x(), disc.moment.x()};
}

}  // namespace

double rotor_diameter(const RotorOptions& rotor) {
  if (rotor.diameter_m) return *rotor.diameter_m;
  return rotor.turbine.empty() ? 0.0 : 2.0 * BladeElementMomentum(read_turbine(rotor.turbine), "madsen", 1.0).tip_radius();
}

RotorLoads::RotorLoads(const AeroOptions& aero, const RotorOptions& rotor, Wind wind, double air_density,
                       const RotorPlacement& placement, std::span<const Motion> start, const ControlOptions& control,
                       double step_s, const Eigen::Vector3d& gravity)
    : bearing_(placement, rotor.azimuth, start),
      start_{rotor.azimuth, rotor.speed, rotor.blade_pitch},
      wind_(std::move(wind)),
      gravity_(gravity) {
  if (aero.thrust_frame == "earth") thrust_direction_ = placement.axis.normalized();
  if (aero.model == "prescribed") model_ = Prescribed(aero);
  if (aero.model == "thrust_curve") model_ = ThrustCurve(aero, rotor, air_density);
  if (aero.model == "bem") model_ = BladeLoads(aero, rotor, air_density);
  if (aero.tower) tower_.emplace(*aero.tower, tower_frame(state(0.0, start)), air_density);
  if (control.model == ControlModel::none) return;
  tip_radius_ = 0.5 * rotor_diameter(rotor);
  const int count = rotor.turbine.empty() ? 3 : read_turbine(rotor.turbine).blades;
  if (control.model == ControlModel::library) {
    control_.emplace(control, count, TurbineControl::Start{rotor.azimuth, rotor.speed, rotor.blade_pitch}, step_s);
  } else {
    const ControllerOptions controller = read_controller(control.file);
    const auto operation = rotor.operation.empty() ? std::nullopt : std::optional(read_operation(rotor.operation));
    double start_pitch = rotor.blade_pitch;
    if (control.peak_shaving) {
      const BladeElementMomentum& bem = blades()->elements();
      shaving_ = shave_peak([&](double w, double speed, double pitch) { return steady_load(bem, w, speed, pitch); },
                            law_of(control, controller, operation), *operation, *control.peak_shaving);
      start_pitch = std::max(start_pitch, shaving_->least_pitch(state(0.0, start).relative_wind));
    }
    control_.emplace(control, controller, operation, count, TurbineControl::Start{rotor.azimuth, rotor.speed, start_pitch},
                     shaving_);
  }
  start_ = control_->start();
}

RotorState RotorLoads::state(double t, std::span<const Motion> bodies) const {
  double azimuth = start_.azimuth + start_.speed * t, speed = start_.speed;
  if (control_ && !memory_.empty()) {
    const TurbineControl::State drive = TurbineControl::state(memory_);
    speed = drive.speed, azimuth = drive.azimuth + drive.speed * (t - drive.time);
  }
  RotorState now = bearing_.state(bodies, azimuth, speed);
  now.relative_wind = aero::relative_wind(wind_, t, now.hub, now.hub_velocity, now.axis);
  return now;
}

/// `memory`: of all that the rotor remembers.
BladesAt RotorLoads::blades_at(const Wind& wind, double t, const RotorState& now, std::span<const double> memory) const {
  BladesAt at{wind,
              t,
              {now.hub_velocity, now.omega, now.axis, now.up, now.azimuth, start_.pitch, now.hub},
              {now.omega, Eigen::Vector3d::Zero(), gravity_},
              memory.empty() ? memory : memory.subspan(drive_size())};
  at.rotor.sense = now.sense;
  if (control_ && !memory.empty()) at.rotor.pitches = control_->pitch(memory);
  if (tower_ && tower_->changes_wind()) at.rotor.tower = &*tower_, at.rotor.tower_frame = tower_frame(now);
  if (!bearing_.is_turned()) at.hub.omega_rate = now.carrier_omega().cross(Eigen::Vector3d(now.speed * now.shaft()));
  return at;
}

const BladeLoads::Load& RotorLoads::blade_load(double t, const RotorState& now) const {
  if (last_.known && last_.t == t && last_.now == now) return last_.load;
  blades()->fill(blades_at(wind_, t, now, memory_), false, last_.load);
  last_.known = true, last_.t = t, last_.now = now;
  return last_.load;
}

RotorLoad RotorLoads::load(double t, const RotorState& now, double ramp) const {
  RotorLoad load = this->load(wind_, t, now, ramp, blades() ? &blade_load(t, now) : nullptr);
  if (control_) add_drive(now, load.shaft_torque, ramp, load.moment);
  return load;
}

RotorLoad RotorLoads::load(const Wind& wind, double t, const RotorState& now, double ramp, const BladeLoads::Load* air) const {
  RotorLoad load;
  if (air) {
    load.force = ramp * air->disc.force, load.moment = ramp * air->disc.moment;
    load.thrust = load.force.dot(now.axis), load.torque = load.moment.dot(now.shaft()), load.shaft_torque = load.torque;
    if (flexible()) {
      const Eigen::Matrix<double, 6, 1> reaction = blades()->reaction(blades_at(wind, t, now, memory_), *air);
      load.force += ramp * reaction.head<3>(), load.moment += ramp * reaction.tail<3>();
      load.shaft_torque += ramp * reaction.tail<3>().dot(now.shaft());
    }
  } else {
    AxialLoad axial;
    const double pitch = control_ && !memory_.empty() ? mean(control_->pitch(memory_)) : start_.pitch;
    if (const auto* prescribed = std::get_if<Prescribed>(&model_)) axial = (*prescribed)(t, now.azimuth);
    if (const auto* curve = std::get_if<ThrustCurve>(&model_)) axial = (*curve)(now.relative_wind, now.speed, pitch);
    load.thrust = ramp * axial.thrust, load.torque = ramp * axial.torque, load.shaft_torque = load.torque;
    load.force = load.thrust * thrust_direction_.value_or(now.axis), load.moment = load.torque * now.shaft();
  }
  load.power = load.torque * now.speed;
  return load;
}

void RotorLoads::add_tower_drag(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp) const {
  add_tower_drag(wind_, t, bodies, wrenches, ramp);
}

void RotorLoads::add_mean_tower_drag(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  add_tower_drag(mean_wind(), t, bodies, wrenches, 1.0);
}

void RotorLoads::add_tower_drag(const Wind& wind, double t, std::span<const Motion> bodies, std::span<Wrench> wrenches,
                                double ramp) const {
  const std::optional<std::size_t> body = body_of_tower_drag();
  if (!body) return;
  const RotorState now = state(t, bodies);
  const TowerLoad drag = tower_->drag(tower_frame(now), wind, t);
  wrenches[*body].add_force(ramp * drag.force, now.hub);
  wrenches[*body].add_moment(ramp * drag.moment);
}

/// On the body act the shaft's torque in place of that on the rotor (`torque`, ramped), and the gyroscopic moment of the spinning
/// rotor.
void RotorLoads::add_drive(const RotorState& now, double torque, double ramp, Eigen::Vector3d& moment) const {
  if (!memory_.empty()) moment += (ramp * TurbineControl::state(memory_).shaft_torque - torque) * now.shaft();
  moment -= now.carrier_omega().cross(Eigen::Vector3d(control_->drive_train().rotor_inertia_kg_m2 * now.speed * now.shaft()));
}

void RotorLoads::add_air_load(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, const HubLoad& air,
                              double ramp) const {
  Eigen::Vector3d moment = ramp * air.moment;
  if (control_) {
    const RotorState now = state(t, bodies);
    add_drive(now, moment.dot(now.shaft()), ramp, moment);
  }
  bearing_.add_load(bodies, wrenches, ramp * air.force, moment);
}

std::optional<ReynoldsReach> RotorLoads::reynolds(double t, const RotorState& now) const {
  return blades() ? blades()->elements().reynolds(wind_, blades_at(wind_, t, now, memory_).rotor, t) : std::nullopt;
}

std::vector<BladeRootLoad> RotorLoads::root_loads(double t, std::span<const Motion> bodies, const Eigen::Vector3d& acceleration,
                                                  const Eigen::Vector3d& omega_rate, const Eigen::Vector3d& gravity,
                                                  double ramp) const {
  const Motion& body = bodies[bearing_.body()];
  const RotorState now = state(t, bodies);
  const Eigen::Vector3d arm = now.hub - body.position, turning = body.omega_earth();
  HubMotion hub{acceleration + omega_rate.cross(arm) + turning.cross(turning.cross(arm)), now.omega, omega_rate};
  if (!bearing_.is_turned()) hub.omega_rate += turning.cross(Eigen::Vector3d(now.speed * now.shaft()));
  return blades()->root_loads(blades_at(wind_, t, now, memory_), blade_load(t, now), hub, gravity, ramp);
}

TurbineControl::Measured RotorLoads::measured(double t, const RotorState& now) const {
  TurbineControl::Measured m{.torque = air_moment_ ? air_moment_(t).dot(now.shaft()) : load(t, now).shaft_torque,
                             .wind = now.relative_wind};
  if (flexible() && !memory_.empty()) {
    const Eigen::Matrix3d turning = flexible()->added_mass(blades_at(wind_, t, now, memory_).rotor).bottomRightCorner<3, 3>();
    m.bending_inertia = -now.axis.dot(turning * now.axis);
  }
  if (!control_->library()) return m;
  const Eigen::Vector3d wind = wind_.at(t, now.hub), up = Eigen::Vector3d::UnitZ(), carrier = now.carrier_omega();
  Eigen::Vector3d along(now.axis.x(), now.axis.y(), 0.0);
  along = along.norm() > 0.0 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d nacelle;  // rows: downwind, left, up
  nacelle << along.transpose(), up.cross(along).transpose(), up.transpose();
  m.wind_speed = std::hypot(wind.x(), wind.y());
  m.yaw_error = m.wind_speed > 0.0 ? std::atan2(along.cross(wind).z(), along.dot(wind)) : 0.0;
  m.velocity = nacelle * now.hub_velocity, m.turning = nacelle * carrier;
  return m;
}

void RotorLoads::begin(double t, std::span<const Motion> bodies, std::span<double> memory) {
  recall({});
  const RotorState now = state(t, bodies);
  if (control_) {
    control_->begin(t, measured(t, now), memory.first(drive_size()));
    require_slow_tips(t, memory);
  }
  if (blades()) blades()->begin(blades_at(wind_, t, now, memory), now.speed, memory.subspan(drive_size()));
  recall(memory);
}

void RotorLoads::require_slow_tips(double t, std::span<const double> memory) const {
  constexpr double fastest = 1020.0;  // m/s: three times that of sound, beyond which air has no such loads
  const double speed = TurbineControl::state(memory).speed, tips = std::abs(speed) * tip_radius_;
  if (tips <= fastest) return;
  throw NumericalFailure(
      fmt::format("t = {:g} s: control: the rotor turns at {:.4g} rpm, its tips at {:.4g} m/s; the limit is {:g} m/s", t,
                  speed * 30.0 / pi, tips, fastest),
      "control", 0, t, fastest);
}

void RotorLoads::remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory) const {
  const RotorState now = state(t, bodies);
  if (control_) {
    control_->advance(t, h, measured(t, now), memory.first(drive_size()));
    require_slow_tips(t, memory);
  }
  if (blades()) blades()->remember(blades_at(wind_, t, now, memory), h, memory.subspan(drive_size()));
}

std::vector<Eigen::Vector2d> RotorLoads::tips(double t, std::span<const Motion> bodies) const {
  return blades()->tips(blades_at(wind_, t, state(t, bodies), memory_));
}

void RotorLoads::add_added_mass(double t, std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> matrices) const {
  if (memory_.empty()) return;
  const RotorState now = state(t, bodies);
  const Eigen::Vector3d arm = now.hub - bodies[bearing_.body()].position;
  // Acceleration of the hub from that of the body: a + alpha x arm.
  Eigen::Matrix<double, 6, 6> to_hub = Eigen::Matrix<double, 6, 6>::Identity();
  to_hub.topRightCorner<3, 3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
  // Under the generator's torque the rotor does not follow the body about the shaft: what bends there is off the drive train.
  if (control_) to_hub.bottomRightCorner<3, 3>() -= now.axis * now.axis.transpose();
  matrices[bearing_.body()] += to_hub.transpose() * flexible()->added_mass(blades_at(wind_, t, now, memory_).rotor) * to_hub;
}

RotorLoads::Drive RotorLoads::drive() const {
  const std::span<const double> memory = std::span(memory_).first(drive_size());
  const TurbineControl::State s = TurbineControl::state(memory);
  return {s.generator_torque,
          control_->drive_train().generator_efficiency * s.generator_torque * control_->generator_speed(memory), s.asked,
          control_->pitch(memory), control_->has_elastic_shaft() ? control_->shaft(memory) : TurbineControl::Shaft{}};
}

void RotorLoads::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp) const {
  const RotorState now = state(t, bodies);
  const RotorLoad load = this->load(t, now, ramp);
  wrenches[bearing_.body()].add_force(load.force, now.hub);
  wrenches[bearing_.body()].add_moment(load.moment);
}

Wind RotorLoads::mean_wind() const {
  Wind wind = wind_;
  wind.in_time = nullptr;
  return wind;
}

void RotorLoads::add_mean_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  constexpr int places = 8;  // of blade 1 in a turn: of three blades' harmonics none below the 24th is mistaken for the mean
  const Wind wind = mean_wind();
  RotorState now = state(t, bodies);
  now.relative_wind = aero::relative_wind(wind, t, now.hub, now.hub_velocity, now.axis);
  BladeLoads::Load air;
  RotorLoad sum;
  const double first = now.azimuth;
  for (int place = 0; place < places; ++place) {
    now.azimuth = whole_turns_off(first + 2.0 * pi * place / places);
    if (blades()) blades()->fill(blades_at(wind, t, now, memory_), true, air);
    const RotorLoad load = this->load(wind, t, now, 1.0 / places, blades() ? &air : nullptr);
    sum.force += load.force, sum.moment += load.moment, sum.shaft_torque += load.shaft_torque;
  }
  if (control_) add_drive(now, sum.shaft_torque, 1.0, sum.moment);
  bearing_.add_load(bodies, wrenches, sum.force, sum.moment);
}

}  // namespace spindrift::aero
