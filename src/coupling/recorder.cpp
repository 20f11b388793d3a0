// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/rigid/rotation.hpp"

namespace spindrift::coupling {

namespace {

std::size_t declare(io::History& history, const std::string& prefix,
                    std::initializer_list<std::array<const char*, 3>> name_unit_meaning) {
  std::size_t first = 0;
  bool is_first = true;
  for (const auto& [name, unit, meaning] : name_unit_meaning) {
    const std::size_t index = history.add({prefix + name, unit, meaning});
    if (is_first) first = index;
    is_first = false;
  }
  return first;
}

std::size_t declare_motion(io::History& history, const std::string& body) {
  return declare(history, body + ".",
                 {{"x_m", "m", "surge of the reference point since the start"},
                  {"y_m", "m", "sway of the reference point"},
                  {"z_m", "m", "heave of the reference point"},
                  {"roll_deg", "deg", "roll since the start"},
                  {"pitch_deg", "deg", "pitch since the start"},
                  {"yaw_deg", "deg", "yaw since the start"},
                  {"vx_m_s", "m/s", "velocity of the reference point along x"},
                  {"vy_m_s", "m/s", "velocity of the reference point along y"},
                  {"vz_m_s", "m/s", "velocity of the reference point along z"},
                  {"wx_rad_s", "rad/s", "angular velocity about x, earth axes"},
                  {"wy_rad_s", "rad/s", "angular velocity about y, earth axes"},
                  {"wz_rad_s", "rad/s", "angular velocity about z, earth axes"},
                  {"ax_m_s2", "m/s2", "acceleration of the reference point along x"},
                  {"ay_m_s2", "m/s2", "acceleration of the reference point along y"},
                  {"az_m_s2", "m/s2", "acceleration of the reference point along z"},
                  {"awx_rad_s2", "rad/s2", "angular acceleration about x, earth axes"},
                  {"awy_rad_s2", "rad/s2", "angular acceleration about y, earth axes"},
                  {"awz_rad_s2", "rad/s2", "angular acceleration about z, earth axes"}});
}

std::size_t declare_wrench(io::History& history, const std::string& prefix) {
  return declare(history, prefix + ".",
                 {{"fx_N", "N", "force along x, earth axes"},
                  {"fy_N", "N", "force along y"},
                  {"fz_N", "N", "force along z"},
                  {"mx_N_m", "N m", "moment about x, earth axes"},
                  {"my_N_m", "N m", "moment about y"},
                  {"mz_N_m", "N m", "moment about z"}});
}

void put(std::span<double> row, std::size_t& column, const Eigen::Vector3d& v, double scale = 1.0) {
  for (int i = 0; i < 3; ++i) row[column++] = scale * v[i];
}

void put(std::span<double> row, std::size_t column, const Wrench& w) {
  put(row, column, w.force);
  put(row, column, w.moment);
}

}  // namespace

ReferenceMotion reference_motion(const Motion& now, const Motion& initial, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& acceleration, const Eigen::Vector3d& omega_rate) {
  const Eigen::Vector3d arm = now.attitude * point, omega = now.omega_earth();
  return {.displacement = now.point(point) - initial.point(point),
          .velocity = now.point_velocity(point),
          .acceleration = acceleration + omega_rate.cross(arm) + omega.cross(omega.cross(arm)),
          .angles = euler_angles(now.attitude * initial.attitude.conjugate()),
          .omega = omega,
          .omega_rate = omega_rate};
}

Recorder::Recorder(Machine& machine, io::History& history) : machine_(machine) {
  const auto bodies = machine.system().bodies();
  const auto loads = machine.system().loads();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    body_columns_.push_back(declare_motion(history, bodies[b].name));
    for (std::size_t s = 0; s < loads.size(); ++s)
      if (machine.loads_body(s, b)) loads_.push_back({s, b, declare_wrench(history, bodies[b].name + "." + loads[s].name)});
  }
  for (const bodies::Joint& joint : machine.system().joints()) joint_columns_.push_back(declare_wrench(history, joint.name));
  if (machine.rotor())
    rotor_column_ = declare(history, "rotor.",
                            {{"thrust_N", "N", "thrust along the rotor axis, downwind"},
                             {"torque_N_m", "N m", "aerodynamic torque about the axis, positive when the air drives the rotor"},
                             {"power_W", "W", "torque times rate"},
                             {"azimuth_deg", "deg", "azimuth of blade 1, zero upwards, 0 to 360"},
                             {"rpm", "rpm", "rate of the rotor"},
                             {"hub_x_m", "m", "hub, along the earth's x"},
                             {"hub_y_m", "m", "hub, along y"},
                             {"hub_z_m", "m", "hub, along z"},
                             {"hub_vx_m_s", "m/s", "velocity of the hub along x"},
                             {"hub_vy_m_s", "m/s", "velocity of the hub along y"},
                             {"hub_vz_m_s", "m/s", "velocity of the hub along z"}});
  if (machine.rotor() && machine.rotor()->is_controlled()) {
    control_column_ = declare(history, "rotor.",
                              {{"generator_torque_N_m", "N m", "of the generator, on the low-speed shaft"},
                               {"electrical_power_W", "W", "generator torque times rate times efficiency"},
                               {"asked_pitch_deg", "deg", "blade pitch that the controller asks for"}});
    for (std::size_t blade = 1; blade <= machine.rotor()->drive_blades(); ++blade)
      history.add({"rotor.blade_" + std::to_string(blade) + ".pitch_deg", "deg", "pitch of the blade, nose into the wind"});
  }
  if (machine.moorings())
    for (std::size_t line = 0; line < machine.moorings()->size(); ++line) {
      const std::string& name = machine.moorings()->name(line);
      mooring_columns_.push_back(history.add({name + ".tension_N", "N", "tension at the fairlead"}));
      if (machine.moorings()->is_dynamic(line)) history.add({name + ".anchor_tension_N", "N", "tension at the anchor"});
    }
  if (machine.has_waves())
    wave_column_ = history.add({"waves.elevation_m", "m", "surface elevation of the undisturbed waves at the earth origin"});
  if (machine.particle_plan()) declare_particles(history);
}

void Recorder::declare_particles(io::History& history) {
  const sea::ParticlePlan& plan = *machine_.particle_plan();
  particle_column_ = declare(history, "sea.",
                             {{"lost_particles", "-", "particles that left the tank so far"},
                              {"x_max_m", "m", "farthest water along x: the front of a broken dam"},
                              {"z_max_m", "m", "highest water"},
                              {"kinetic_energy_J", "J", "of the water"}});
  if (plan.wavemaker)
    declare(history, "wavemaker.",
            {{"displacement_m", "m", "of the paddle's face at still water"}, {"velocity_m_s", "m/s", "of the same"}});
  for (const sea::GaugeOptions& gauge : plan.gauges)
    history.add({gauge.name + ".elevation_m", "m", "height of the water's surface; the bed where there is none"});
  for (const sea::ProbeOptions& probe : plan.probes)
    declare(history, probe.name + ".",
            {{"pressure_Pa", "Pa", "pressure of the water, zero where there is none"},
             {"vx_m_s", "m/s", "velocity of the water along x, zero where there is none"},
             {"vy_m_s", "m/s", "along y"},
             {"vz_m_s", "m/s", "along z"}});
}

void Recorder::put_particles(std::span<double> row, double t) const {
  const sea::ParticlePlan& plan = *machine_.particle_plan();
  const sea::ParticleSea& sea = *machine_.particles();
  std::size_t column = particle_column_;
  const auto extent = sea.extent();
  for (double value : {double(sea.lost()), extent.x_max, extent.z_max, extent.kinetic_energy}) row[column++] = value;
  if (plan.wavemaker) {
    const auto paddle = sea.paddle(t);
    row[column++] = paddle.displacement, row[column++] = paddle.velocity;
  }
  std::vector<std::array<double, 2>> places;
  for (const sea::GaugeOptions& gauge : plan.gauges) places.push_back(gauge.point_m);
  // Where there is no water the surface is the bed and nothing moves: no column holds what is not a number.
  const std::vector<double> heights = sea.surface(places);
  for (std::size_t n = 0; n < places.size(); ++n)
    row[column++] = std::isfinite(heights[n]) ? heights[n] : plan.tank.bed_at(places[n][0]);
  for (const sea::ProbeOptions& probe : plan.probes) {
    const auto reading = sea.probe(probe.point_m);
    row[column++] = reading.pressure;
    put(row, column, reading.velocity.allFinite() ? reading.velocity : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
}

void Recorder::fill(std::span<double> row, const bodies::BodiesState& state, double t) {
  // Bodies that are held before t = 0 are as they start: drivers and loads that depend on time begin there.
  static const bodies::Evaluation nothing;
  const bodies::Evaluation& now = state.motions.empty() ? nothing : machine_.system().evaluate(state, std::max(t, 0.0));
  const auto bodies = machine_.system().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ReferenceMotion m = reference_motion(state.motions[b], bodies[b].initial, machine_.reference_point(b),
                                               now.acceleration[b], now.angular_acceleration[b]);
    std::size_t column = body_columns_[b];
    put(row, column, m.displacement);
    put(row, column, m.angles, 1.0 / radians_per_degree);
    put(row, column, m.velocity);
    put(row, column, m.omega);
    put(row, column, m.acceleration);
    put(row, column, m.omega_rate);
  }
  for (const Load& load : loads_) put(row, load.column, now.by_source[load.source][load.body]);
  for (std::size_t j = 0; j < joint_columns_.size(); ++j) put(row, joint_columns_[j], now.joint_reactions[j]);
  if (machine_.rotor()) {
    const aero::RotorState rotor = machine_.rotor()->state(t, state.motions);
    const aero::RotorLoad load = machine_.written_rotor_load(t, rotor);
    std::size_t column = rotor_column_;
    for (double value : {load.thrust, load.torque, load.power, rotor.azimuth / radians_per_degree, rotor.speed / rad_s_per_rpm})
      row[column++] = value;
    put(row, column, rotor.hub);
    put(row, column, rotor.hub_velocity);
    if (machine_.rotor()->is_controlled()) {
      const aero::RotorLoads::Drive drive = machine_.rotor()->drive();
      column = control_column_;
      row[column++] = drive.generator_torque, row[column++] = drive.electrical_power;
      row[column++] = drive.asked_pitch / radians_per_degree;
      for (double pitch : drive.pitch) row[column++] = pitch / radians_per_degree;
    }
  }
  if (machine_.moorings())
    for (std::size_t line = 0; line < mooring_columns_.size(); ++line) {
      const moorings::LineTension tension = machine_.moorings()->tension(line, state.motions);
      row[mooring_columns_[line]] = tension.fairlead;
      if (machine_.moorings()->is_dynamic(line)) row[mooring_columns_[line] + 1] = tension.anchor;
    }
  if (machine_.particles()) put_particles(row, t);
  if (machine_.has_waves()) row[wave_column_] = machine_.sea()->elevation(0.0, 0.0, t);
}

}  // namespace spindrift::coupling
