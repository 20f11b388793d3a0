// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_loads.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
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

UnsteadyFlow::Stall stall_named(std::string_view name) {
  if (name == "oye") return UnsteadyFlow::Stall::oye;
  if (name == "beddoes_leishman") return UnsteadyFlow::Stall::beddoes_leishman;
  return UnsteadyFlow::Stall::none;
}

/// Of blades at rest in the turning rotor, bent by the air and by their own weight and inertia.
FlexibleBlades::Bending settled_bending(const BladeElementMomentum& bem, const FlexibleBlades& blades, const HubField& hub,
                                        const Wind& wind, double t, DiscMotion motion, std::span<const double> flow) {
  FlexibleBlades::Bending bending;
  const std::size_t used = std::size_t(FlexibleBlades::modes * blades.blades());
  std::array<double, std::size_t(FlexibleBlades::modes) * FlexibleBlades::max_blades> air{};
  constexpr int most = 50;  // the air's force hardly changes with bending: each pass leaves a tenth or less of the error
  constexpr double enough = 1e-12;
  for (int pass = 0; pass < most; ++pass) {
    const FlexibleBlades::Bending before = bending;
    const BentBlades bent = blades.bent(before);
    motion.bent = &bent;
    bem.on_modes(wind, motion, t, flow, std::span(air).first(used));
    blades.settle(motion, hub, air, bending);
    double change = 0.0, size = 0.0;
    for (std::size_t k = 0; k < used; ++k)
      change = std::max(change, std::abs(bending.amplitudes[k] - before.amplitudes[k])),
      size = std::max(size, std::abs(bending.amplitudes[k]));
    if (change <= enough * size) break;
  }
  return bending;
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
  if (aero.model == "bem")
    model_ = BladeElementMomentum(read_turbine(rotor.turbine), aero.induction, air_density,
                                  {.inflow = aero.dynamic_inflow == "oye",
                                   .inflow_time = aero.inflow_time_s,
                                   .stall = stall_named(aero.dynamic_stall),
                                   .speed_of_sound = aero.speed_of_sound_m_s},
                                  aero.kinematic_viscosity(air_density));
  if (!rotor.blade_masses.empty()) {
    const Turbine turbine = read_turbine(rotor.turbine);
    roots_.emplace(turbine, read_blade_masses(turbine, rotor.blade_masses));
  }
  if (!rotor.blade_structure.empty() && aero.model == "bem") {
    const Turbine turbine = read_turbine(rotor.turbine);
    const BladeStructure structure = read_blade_structure(turbine, rotor.blade_structure);
    roots_.emplace(turbine, structure.masses);
    flexible_.emplace(turbine, structure, rotor.blade_damping);
  }
  if (const auto* bem = std::get_if<BladeElementMomentum>(&model_)) parts_.flow = bem->memory_size();
  if (flexible_) parts_.bending = flexible_->memory_size();
  if (aero.tower) tower_.emplace(*aero.tower, tower_frame(state(0.0, start)), air_density);
  if (control.model == ControlModel::none) return;
  const int blades = rotor.turbine.empty() ? 3 : read_turbine(rotor.turbine).blades;
  if (control.model == ControlModel::library) {
    control_.emplace(control, blades, TurbineControl::Start{rotor.azimuth, rotor.speed, rotor.blade_pitch}, step_s);
  } else {
    const ControllerOptions controller = read_controller(control.file);
    const auto operation = rotor.operation.empty() ? std::nullopt : std::optional(read_operation(rotor.operation));
    double start_pitch = rotor.blade_pitch;
    if (control.peak_shaving) {
      const auto& bem = std::get<BladeElementMomentum>(model_);
      shaving_ = shave_peak([&](double w, double speed, double pitch) { return steady_load(bem, w, speed, pitch); },
                            law_of(control, controller, operation), *operation, *control.peak_shaving);
      start_pitch = std::max(start_pitch, shaving_->least_pitch(state(0.0, start).relative_wind));
    }
    control_.emplace(control, controller, operation, blades, TurbineControl::Start{rotor.azimuth, rotor.speed, start_pitch},
                     shaving_);
  }
  start_ = control_->start();
  parts_.control = control_->memory_size();
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

DiscMotion RotorLoads::disc_motion(const RotorState& now, std::span<const double> memory) const {
  DiscMotion motion{now.hub_velocity, now.omega, now.axis, now.up, now.azimuth, start_.pitch, now.hub};
  motion.sense = now.sense;
  if (control_ && !memory.empty()) motion.pitches = control_->pitch(memory);
  if (tower_ && tower_->changes_wind()) motion.tower = &*tower_, motion.tower_frame = tower_frame(now);
  return motion;
}

HubField RotorLoads::hub_field(const RotorState& now) const {
  HubField field{now.omega, Eigen::Vector3d::Zero(), gravity_};
  if (!bearing_.is_turned()) field.omega_rate = now.carrier_omega().cross(Eigen::Vector3d(now.speed * now.shaft()));
  return field;
}

void RotorLoads::fill_air_load(const Wind& wind, double t, const RotorState& now, bool at_rest, AirLoad& load) const {
  const auto& bem = std::get<BladeElementMomentum>(model_);
  const std::span<const double> memory(memory_), flow = parts_.of_flow(memory);
  DiscMotion motion = disc_motion(now, memory);
  const int blades = int(roots());
  load.roots.resize(std::size_t(blades));
  for (int b = 0; b < blades; ++b)
    load.roots[std::size_t(b)] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                  roots_->root(now.axis, blade_direction(motion, b, blades))};
  if (!flexible_) {
    load.disc = bem(wind, motion, t, flow, load.roots);
    return;
  }
  const bool moves = !memory.empty() && !at_rest;
  load.bending = moves ? flexible_->predicted(parts_.of_bending(memory), t)
                       : settled_bending(bem, *flexible_, hub_field(now), wind, t, motion, flow);
  const BentBlades bent = flexible_->bent(load.bending);
  motion.bent = &bent;
  load.disc = bem.on_modes(wind, motion, t, flow,
                           std::span(load.on_modes).first(std::size_t(FlexibleBlades::modes * flexible_->blades())), load.roots);
}

const RotorLoads::AirLoad& RotorLoads::air_load(double t, const RotorState& now) const {
  if (last_.known && last_.t == t && last_.now == now) return last_;
  fill_air_load(wind_, t, now, false, last_);
  last_.known = true, last_.t = t, last_.now = now;
  return last_;
}

RotorLoad RotorLoads::load(double t, const RotorState& now, double ramp) const {
  const bool of_sections = std::holds_alternative<BladeElementMomentum>(model_);
  return load(wind_, t, now, ramp, of_sections ? &air_load(t, now) : nullptr);
}

RotorLoad RotorLoads::load(const Wind& wind, double t, const RotorState& now, double ramp, const AirLoad* air) const {
  RotorLoad load;
  if (air) {
    const DiscLoad& disc = air->disc;
    Eigen::Matrix<double, 6, 1> reaction = Eigen::Matrix<double, 6, 1>::Zero();
    if (flexible_) {
      DiscMotion motion = disc_motion(now, memory_);
      const BentBlades bent = flexible_->bent(air->bending);
      motion.bent = &bent;
      reaction = flexible_->reaction(motion, hub_field(now), air->bending, air->on_modes);
    }
    load.force = ramp * disc.force, load.moment = ramp * disc.moment;
    load.thrust = load.force.dot(now.axis), load.torque = load.moment.dot(now.shaft()), load.shaft_torque = load.torque;
    if (flexible_) {
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
  if (tower_) {
    const TowerLoad drag = tower_->drag(tower_frame(now), wind, t);
    load.force += ramp * drag.force, load.moment += ramp * drag.moment;
  }
  if (control_) add_drive(now, load.shaft_torque, ramp, load.moment);
  return load;
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
  const auto* bem = std::get_if<BladeElementMomentum>(&model_);
  return bem ? bem->reynolds(wind_, disc_motion(now, memory_), t) : std::nullopt;
}

std::vector<BladeRootLoad> RotorLoads::root_loads(double t, std::span<const Motion> bodies, const Eigen::Vector3d& acceleration,
                                                  const Eigen::Vector3d& omega_rate, const Eigen::Vector3d& gravity,
                                                  double ramp) const {
  const Motion& body = bodies[bearing_.body()];
  const RotorState now = state(t, bodies);
  const Eigen::Vector3d arm = now.hub - body.position, turning = body.omega_earth();
  HubMotion hub{acceleration + omega_rate.cross(arm) + turning.cross(turning.cross(arm)), now.omega, omega_rate};
  if (!bearing_.is_turned()) hub.omega_rate += turning.cross(Eigen::Vector3d(now.speed * now.shaft()));
  const AirLoad& air = air_load(t, now);
  DiscMotion disc = disc_motion(now, memory_);
  const int blades = int(roots_->blades());
  std::vector<BladeRootLoad> loads;
  BentBlades bent;
  if (flexible_) bent = flexible_->bent(air.bending), disc.bent = &bent;
  for (int b = 0; b < blades; ++b) {
    const Eigen::Vector3d out = blade_direction(disc, b, blades);
    Wrench w = air.roots[std::size_t(b)];
    w.force *= ramp, w.moment *= ramp;
    std::vector<MassMotion> moved;
    if (flexible_) {
      Eigen::Matrix<double, 6, 1> beyond;
      const HubField field = hub_field(now);
      beyond << hub.acceleration, hub.omega_rate - field.omega_rate;
      moved = flexible_->mass_motions(disc, b, field, beyond, air.bending, air.on_modes);
    }
    roots_->add_mass_loads(hub, now.axis, out, gravity, w, moved);
    loads.push_back(BladeRoots::seen(w, now.axis, out, now.sense));
  }
  return loads;
}

TurbineControl::Measured RotorLoads::measured(double t, const RotorState& now) const {
  TurbineControl::Measured m{.torque = air_moment_ ? air_moment_(t).dot(now.shaft()) : load(t, now).shaft_torque,
                             .wind = now.relative_wind};
  if (flexible_ && !memory_.empty()) {
    const Eigen::Matrix3d turning = flexible_->added_mass(disc_motion(now, memory_)).bottomRightCorner<3, 3>();
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
  if (control_) control_->begin(t, measured(t, now), memory.first(parts_.control));
  if (parts_.flow > 0) std::get<BladeElementMomentum>(model_).begin(wind_, disc_motion(now, memory), t, parts_.of_flow(memory));
  if (flexible_) {
    // At rest in the turning rotor: amplitudes go with the azimuth, and so have rates.
    const std::span<const double> flow = parts_.of_flow(std::span<const double>(memory));
    constexpr double soon = 0.02;  // [s]
    RotorState later = now;
    later.azimuth += soon * now.speed;
    DiscMotion motion = disc_motion(now, memory);
    const auto& bem = std::get<BladeElementMomentum>(model_);
    FlexibleBlades::Bending bending = settled_bending(bem, *flexible_, hub_field(now), wind_, t, motion, flow);
    const FlexibleBlades::Bending next =
        settled_bending(bem, *flexible_, hub_field(later), wind_, t, disc_motion(later, memory), flow);
    for (std::size_t k = 0; k < bending.rates.size(); ++k) bending.rates[k] = (next.amplitudes[k] - bending.amplitudes[k]) / soon;
    const BentBlades bent = flexible_->bent(bending);
    motion.bent = &bent;
    OnModes air{};
    std::get<BladeElementMomentum>(model_).on_modes(
        wind_, motion, t, flow, std::span(air).first(std::size_t(FlexibleBlades::modes * flexible_->blades())));
    flexible_->begin(t, motion, hub_field(now), bending, air, parts_.of_bending(memory));
  }
  recall(memory);
}

void RotorLoads::remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory) const {
  const RotorState now = state(t, bodies);
  if (control_) control_->advance(t, h, measured(t, now), memory.first(parts_.control));
  const std::span<double> flow = parts_.of_flow(memory);
  DiscMotion motion = disc_motion(now, memory);
  FlexibleBlades::Bending bending;
  BentBlades bent;
  if (flexible_)
    bending = flexible_->predicted(parts_.of_bending(memory), t), bent = flexible_->bent(bending), motion.bent = &bent;
  if (parts_.flow > 0) std::get<BladeElementMomentum>(model_).remember(wind_, motion, t, h, flow);
  if (flexible_) {
    OnModes air{};
    std::get<BladeElementMomentum>(model_).on_modes(
        wind_, motion, t, flow, std::span(air).first(std::size_t(FlexibleBlades::modes * flexible_->blades())));
    flexible_->advance(t, h, motion, hub_field(now), air, parts_.of_bending(memory));
  }
}

std::vector<Eigen::Vector2d> RotorLoads::tips(double t, std::span<const Motion> bodies) const {
  const RotorState now = state(t, bodies);
  const std::span<const double> memory(memory_);
  const DiscMotion motion = disc_motion(now, memory);
  const FlexibleBlades::Bending bending =
      memory.empty() ? settled_bending(std::get<BladeElementMomentum>(model_), *flexible_, hub_field(now), wind_, t, motion, {})
                     : flexible_->predicted(parts_.of_bending(memory), t);
  std::vector<Eigen::Vector2d> tips;
  for (int b = 0; b < flexible_->blades(); ++b) tips.push_back(flexible_->tip(motion, b, bending));
  return tips;
}

void RotorLoads::add_added_mass(double t, std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> matrices) const {
  if (memory_.empty()) return;
  const RotorState now = state(t, bodies);
  const Eigen::Vector3d arm = now.hub - bodies[bearing_.body()].position;
  // Acceleration of the hub from that of the body: a + alpha x arm.
  Eigen::Matrix<double, 6, 6> to_hub = Eigen::Matrix<double, 6, 6>::Identity();
  to_hub.topRightCorner<3, 3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
  matrices[bearing_.body()] += to_hub.transpose() * flexible_->added_mass(disc_motion(now, memory_)) * to_hub;
}

RotorLoads::Drive RotorLoads::drive() const {
  const std::span<const double> memory = std::span(memory_).first(parts_.control);
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

void RotorLoads::add_mean_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  constexpr int places = 8;  // of blade 1 in a turn: of three blades' harmonics none below the 24th is mistaken for the mean
  Wind mean_wind = wind_;
  mean_wind.in_time = nullptr;
  RotorState now = state(t, bodies);
  now.relative_wind = aero::relative_wind(mean_wind, t, now.hub, now.hub_velocity, now.axis);
  const bool of_sections = std::holds_alternative<BladeElementMomentum>(model_);
  AirLoad air;
  const double first = now.azimuth;
  for (int place = 0; place < places; ++place) {
    now.azimuth = whole_turns_off(first + 2.0 * pi * place / places);
    if (of_sections) fill_air_load(mean_wind, t, now, true, air);
    const RotorLoad load = this->load(mean_wind, t, now, 1.0 / places, of_sections ? &air : nullptr);
    bearing_.add_load(bodies, wrenches, load.force, load.moment);
  }
}

}  // namespace spindrift::aero
