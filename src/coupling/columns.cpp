// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/columns.hpp"

#include "kernels/base/constants.hpp"
#include "src/aero/flow/control.hpp"
#include "src/aero/flow/mass_balance.hpp"
#include "src/coupling/window.hpp"

namespace spindrift::coupling {

using io::ColumnOf, io::section_of;

Table<ReferenceMotion> motion_columns() {
  using Of = const ReferenceMotion&;
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<ReferenceMotion> table[] = {
      {"x_m", "m", "surge of the reference point from where the scene describes it", [](Of m) { return m.displacement[0]; }},
      {"y_m", "m", "sway of the reference point", [](Of m) { return m.displacement[1]; }},
      {"z_m", "m", "heave of the reference point", [](Of m) { return m.displacement[2]; }},
      {"roll_deg", "deg", "roll from the described position", [](Of m) { return 1.0 / degree * m.angles[0]; }},
      {"pitch_deg", "deg", "pitch from the described position", [](Of m) { return 1.0 / degree * m.angles[1]; }},
      {"yaw_deg", "deg", "yaw from the described position", [](Of m) { return 1.0 / degree * m.angles[2]; }},
      {"vx_m_s", "m/s", "velocity of the reference point along x", [](Of m) { return m.velocity[0]; }},
      {"vy_m_s", "m/s", "velocity of the reference point along y", [](Of m) { return m.velocity[1]; }},
      {"vz_m_s", "m/s", "velocity of the reference point along z", [](Of m) { return m.velocity[2]; }},
      {"wx_rad_s", "rad/s", "angular velocity about x, earth axes", [](Of m) { return m.omega[0]; }},
      {"wy_rad_s", "rad/s", "angular velocity about y, earth axes", [](Of m) { return m.omega[1]; }},
      {"wz_rad_s", "rad/s", "angular velocity about z, earth axes", [](Of m) { return m.omega[2]; }},
      {"ax_m_s2", "m/s2", "acceleration of the reference point along x", [](Of m) { return m.acceleration[0]; }},
      {"ay_m_s2", "m/s2", "acceleration of the reference point along y", [](Of m) { return m.acceleration[1]; }},
      {"az_m_s2", "m/s2", "acceleration of the reference point along z", [](Of m) { return m.acceleration[2]; }},
      {"awx_rad_s2", "rad/s2", "angular acceleration about x, earth axes", [](Of m) { return m.omega_rate[0]; }},
      {"awy_rad_s2", "rad/s2", "angular acceleration about y, earth axes", [](Of m) { return m.omega_rate[1]; }},
      {"awz_rad_s2", "rad/s2", "angular acceleration about z, earth axes", [](Of m) { return m.omega_rate[2]; }}};
  return table;
}

Table<Wrench> wrench_columns() {
  using Of = const Wrench&;
  static constexpr ColumnOf<Wrench> table[] = {{"fx_N", "N", "force along x, earth axes", [](Of w) { return w.force[0]; }},
                                               {"fy_N", "N", "force along y", [](Of w) { return w.force[1]; }},
                                               {"fz_N", "N", "force along z", [](Of w) { return w.force[2]; }},
                                               {"mx_N_m", "N m", "moment about x, earth axes", [](Of w) { return w.moment[0]; }},
                                               {"my_N_m", "N m", "moment about y", [](Of w) { return w.moment[1]; }},
                                               {"mz_N_m", "N m", "moment about z", [](Of w) { return w.moment[2]; }}};
  return table;
}

Table<bodies::BeamReading> beam_columns() {
  using Of = const bodies::BeamReading&;
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<bodies::BeamReading> table[] = {
      {"deflection_x_m", "m", "of the end along the beam's x, relative to its start", [](Of b) { return b.displacement[0]; }},
      {"deflection_y_m", "m", "of the end along its y", [](Of b) { return b.displacement[1]; }},
      {"turn_x_deg", "deg", "by which the end turns about the beam's x", [](Of b) { return b.rotation[0] / degree; }},
      {"turn_y_deg", "deg", "about its y", [](Of b) { return b.rotation[1] / degree; }},
      {"twist_deg", "deg", "about its z, from start to end", [](Of b) { return b.rotation[2] / degree; }},
      {"start_fx_N", "N", "force at the start, of what is beyond on what is before, along the beam's x there",
       [](Of b) { return b.start_force[0]; }},
      {"start_fy_N", "N", "along its y", [](Of b) { return b.start_force[1]; }},
      {"start_fz_N", "N", "along its z; negative: pressure", [](Of b) { return b.start_force[2]; }},
      {"start_mx_N_m", "N m", "bending moment at the start about the beam's x there", [](Of b) { return b.start_moment[0]; }},
      {"start_my_N_m", "N m", "bending moment about its y, of a tower fore-aft", [](Of b) { return b.start_moment[1]; }},
      {"start_mz_N_m", "N m", "torsion about its z", [](Of b) { return b.start_moment[2]; }},
      {"end_fx_N", "N", "force at the end, of what is beyond on the beam, along its x there",
       [](Of b) { return b.end_force[0]; }},
      {"end_fy_N", "N", "along its y", [](Of b) { return b.end_force[1]; }},
      {"end_fz_N", "N", "along its z; negative: pressure", [](Of b) { return b.end_force[2]; }},
      {"end_mx_N_m", "N m", "bending moment at the end about the beam's x there", [](Of b) { return b.end_moment[0]; }},
      {"end_my_N_m", "N m", "bending moment about its y", [](Of b) { return b.end_moment[1]; }},
      {"end_mz_N_m", "N m", "torsion about its z", [](Of b) { return b.end_moment[2]; }}};
  return table;
}

Table<double> constraint_columns() {
  static constexpr ColumnOf<double> table[] = {{"constraint_residual", "-",
                                                "largest residual of all joints' constraints, over the largest arm of a joint",
                                                [](const double& r) { return r; }}};
  return table;
}

Table<EnergyRow> energy_columns() {
  using Of = const EnergyRow&;
  using Balance = bodies::EnergyBalance;
  static constexpr ColumnOf<EnergyRow> table[] = {
      {"kinetic_J", "J", "kinetic energy of all bodies, added mass not included", [](Of e) { return e.kinetic; }},
      {"added_mass_work_J", "J", "work of the forces of added mass since the start",
       [](Of e) { return e.after_sources[Balance::added_mass]; }},
      {"joints_work_J", "J", "work of joints and their drivers since the start; ideal joints do none",
       [](Of e) { return e.after_sources[Balance::joints]; }},
      {"steps_J", "J", "kinetic energy that no work explains: made (or lost, below zero) by the time steps since the start",
       [](Of e) { return e.after_sources[Balance::error]; }}};
  return table;
}

Table<double> work_columns() {
  static constexpr ColumnOf<double> table[] = {
      {"work_J", "J", "work of this source of load on all bodies since the start", [](const double& w) { return w; }}};
  return table;
}

Table<RotorRow> rotor_columns() {
  using Of = const RotorRow&;
  static constexpr ColumnOf<RotorRow> table[] = {
      {"thrust_N", "N", "force of the air on the blades along the rotor axis, positive downwind",
       [](Of r) { return r.load.thrust; }},
      {"torque_N_m", "N m", "its moment about the axis, positive where the air drives the rotor",
       [](Of r) { return r.load.torque; }},
      {"power_W", "W", "torque times rotor speed", [](Of r) { return r.load.power; }},
      {"azimuth_deg", "deg", "azimuth of blade 1, zero upwards, 0 to 360", [](Of r) { return r.azimuth_deg; }},
      {"rpm", "rpm", "rotor speed", [](Of r) { return r.rpm; }}};
  return table;
}

Table<aero::RotorState> hub_columns() {
  using Of = const aero::RotorState&;
  static constexpr ColumnOf<aero::RotorState> table[] = {
      {"hub_x_m", "m", "hub, along the earth's x", [](Of s) { return s.hub[0]; }},
      {"hub_y_m", "m", "hub, along y", [](Of s) { return s.hub[1]; }},
      {"hub_z_m", "m", "hub, along z", [](Of s) { return s.hub[2]; }},
      {"hub_vx_m_s", "m/s", "velocity of the hub along x", [](Of s) { return s.hub_velocity[0]; }},
      {"hub_vy_m_s", "m/s", "velocity of the hub along y", [](Of s) { return s.hub_velocity[1]; }},
      {"hub_vz_m_s", "m/s", "velocity of the hub along z", [](Of s) { return s.hub_velocity[2]; }}};
  return table;
}

Table<Eigen::Vector3d> wind_columns() {
  using Of = const Eigen::Vector3d&;
  static constexpr ColumnOf<Eigen::Vector3d> table[] = {
      {"wind_x_m_s", "m/s", "undisturbed wind at the hub, gusts and turbulence included, along the earth's x",
       [](Of v) { return v[0]; }},
      {"wind_y_m_s", "m/s", "undisturbed wind at the hub along y", [](Of v) { return v[1]; }},
      {"wind_z_m_s", "m/s", "undisturbed wind at the hub along z", [](Of v) { return v[2]; }}};
  return table;
}

Table<aero::RotorLoad> blade_columns() {
  using Of = const aero::RotorLoad&;
  static constexpr ColumnOf<aero::RotorLoad> table[] = {
      {"thrust_N", "N", "share of one blade of the grid, along the axis", [](Of l) { return l.thrust; }},
      {"torque_N_m", "N m", "share of one blade of the grid, about the axis", [](Of l) { return l.torque; }}};
  return table;
}

Table<aero::BladeRootLoad> root_columns() {
  using Of = const aero::BladeRootLoad&;
  static constexpr ColumnOf<aero::BladeRootLoad> table[] = {
      {"root_downwind_N", "N", "force of the blade on the hub along the axis: air, weight and inertia",
       [](Of l) { return l.downwind; }},
      {"root_ahead_N", "N", "in the blade's direction of motion", [](Of l) { return l.ahead; }},
      {"root_outward_N", "N", "outward, square to the axis", [](Of l) { return l.outward; }},
      {"root_flap_N_m", "N m", "flapwise bending moment at the root, positive where the blade is pushed downwind",
       [](Of l) { return l.flap; }},
      {"root_edge_N_m", "N m", "edgewise bending moment at the root, positive where the blade is pushed ahead",
       [](Of l) { return l.edge; }}};
  return table;
}

Table<Eigen::Vector2d> tip_columns() {
  using Of = const Eigen::Vector2d&;
  static constexpr ColumnOf<Eigen::Vector2d> table[] = {
      {"tip_downwind_m", "m", "bending of the blade's tip downwind, square to the blade", [](Of tip) { return tip.x(); }},
      {"tip_ahead_m", "m", "bending of the blade's tip in its direction of motion", [](Of tip) { return tip.y(); }}};
  return table;
}

Table<aero::RotorLoads::Drive> drive_columns() {
  using Of = const aero::RotorLoads::Drive&;
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<aero::RotorLoads::Drive> table[] = {
      {"generator_torque_N_m", "N m", "of the generator, on the low-speed shaft", [](Of d) { return d.generator_torque; }},
      {"electrical_power_W", "W", "generator torque times its speed times efficiency", [](Of d) { return d.electrical_power; }},
      {"asked_pitch_deg", "deg", "blade pitch that the controller asks for", [](Of d) { return d.asked_pitch / degree; }}};
  return table;
}

Table<aero::RotorLoads::Drive> shaft_columns() {
  using Of = const aero::RotorLoads::Drive&;
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<aero::RotorLoads::Drive> table[] = {
      {"generator_rpm", "rpm", "speed of the generator, on the low-speed shaft",
       [](Of d) { return d.shaft.generator_speed / rad_s_per_rpm; }},
      {"shaft_torque_N_m", "N m", "torque that the twisted shaft carries from rotor to generator",
       [](Of d) { return d.shaft.torque; }},
      {"shaft_twist_deg", "deg", "angle of the rotor ahead of the generator", [](Of d) { return d.shaft.twist / degree; }}};
  return table;
}

Table<YawDrive::Reading> yaw_columns() {
  using Of = const YawDrive::Reading&;
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<YawDrive::Reading> table[] = {
      {"yaw_angle_deg", "deg", "of the nacelle about its bearing since the scene's position, positive from x to y",
       [](Of y) { return y.angle / degree; }},
      {"yaw_error_deg", "deg", "of the filtered wind from the rotor axis, positive where the nacelle must turn from x to y",
       [](Of y) { return y.error / degree; }},
      {"yaw_rate_deg_s", "deg/s", "at which the drive turns the nacelle; 0: it holds", [](Of y) { return y.rate / degree; }},
      {"yaw_moment_N_m", "N m", "of the drive on the nacelle, positive from x to y", [](Of y) { return y.moment; }}};
  return table;
}

Table<double> pitch_columns() {
  static constexpr double degree = radians_per_degree;
  static constexpr ColumnOf<double> table[] = {
      {"pitch_deg", "deg", "pitch of the blade, nose into the wind", [](const double& pitch) { return pitch / degree; }}};
  return table;
}

Table<moorings::LineTension> mooring_columns() {
  using Of = const moorings::LineTension&;
  static constexpr ColumnOf<moorings::LineTension> table[] = {
      {"tension_N", "N", "tension at the fairlead", [](Of t) { return t.fairlead; }}};
  return table;
}

Table<moorings::LineTension> anchor_columns() {
  using Of = const moorings::LineTension&;
  static constexpr ColumnOf<moorings::LineTension> table[] = {
      {"anchor_tension_N", "N", "tension at the anchor", [](Of t) { return t.anchor; }}};
  return table;
}

Table<LineEnd> junction_columns() {
  using Of = const LineEnd&;
  static constexpr ColumnOf<LineEnd> table[] = {
      {"at_x_m", "m", "where it is, earth frame: along x", [](Of j) { return j.position.x(); }},
      {"at_y_m", "m", "along y", [](Of j) { return j.position.y(); }},
      {"at_z_m", "m", "its height over still water", [](Of j) { return j.position.z(); }}};
  return table;
}

Table<double> wave_columns() {
  static constexpr ColumnOf<double> table[] = {
      {"elevation_m", "m", "surface elevation of the undisturbed waves at the earth origin", [](const double& v) { return v; }}};
  return table;
}

Table<WaterRow> water_columns() {
  using Of = const WaterRow&;
  static constexpr ColumnOf<WaterRow> table[] = {
      {"lost_particles", "-", "particles that slipped through walls so far", [](Of w) { return w.lost; }},
      {"left_particles", "-", "particles that left over the walls' upper edge or through open sides so far",
       [](Of w) { return w.left; }},
      {"x_max_m", "m", "farthest water along x: the front of a broken dam", [](Of w) { return w.extent.x_max; }},
      {"z_max_m", "m", "highest water", [](Of w) { return w.extent.z_max; }},
      {"mass_kg", "kg", "of the water in the tank", [](Of w) { return w.extent.mass; }},
      {"kinetic_energy_J", "J", "of the water", [](Of w) { return w.extent.kinetic_energy; }},
      {"potential_energy_J", "J", "of the water over z = 0, by its weight", [](Of w) { return w.extent.potential_energy; }},
      {"compression_energy_J", "J", "of the water, against its pressure", [](Of w) { return w.extent.compression_energy; }},
      {"work_of_solids_J", "J", "work of bodies, paddle and drive on the water so far",
       [](Of w) { return w.extent.work_of_solids; }},
      {"dissipated_J", "J", "taken by viscosity, density diffusion and walls so far", [](Of w) { return w.extent.dissipated; }},
      {"absorbed_J", "J", "taken by damping zones so far", [](Of w) { return w.extent.absorbed; }},
      {"left_J", "J", "kinetic and potential energy that particles took along which are no more in the tank",
       [](Of w) { return w.extent.left; }}};
  return table;
}

Table<sph::Wavemaker::Stroke> paddle_columns() {
  using Of = const sph::Wavemaker::Stroke&;
  static constexpr ColumnOf<sph::Wavemaker::Stroke> table[] = {
      {"displacement_m", "m", "of the paddle's face at still water", [](Of s) { return s.displacement; }},
      {"velocity_m_s", "m/s", "of the same", [](Of s) { return s.velocity; }}};
  return table;
}

Table<double> gauge_columns() {
  static constexpr ColumnOf<double> table[] = {
      {"elevation_m", "m",
       "height of the water's surface, without particles of the undisturbed waves; the bed where there is none",
       [](const double& v) { return v; }}};
  return table;
}

Table<double> run_up_columns() {
  static constexpr ColumnOf<double> table[] = {
      {"run_up_m", "m", "the same over the present place of the body's waterline there (z = 0 of the scene)",
       [](const double& v) { return v; }}};
  return table;
}

Table<sph::PatchReading> sensor_columns() {
  using Of = const sph::PatchReading&;
  static constexpr ColumnOf<sph::PatchReading> table[] = {
      {"mean_pressure_Pa", "Pa", "pressure of the water, mean over the patch and over mean_over_s, zero where it is dry",
       [](Of r) { return r.pressure; }},
      {"fx_N", "N", "force of the water on the patch along x, earth axes, mean over mean_over_s",
       [](Of r) { return r.force[0]; }},
      {"fy_N", "N", "along y", [](Of r) { return r.force[1]; }},
      {"fz_N", "N", "along z", [](Of r) { return r.force[2]; }}};
  return table;
}

Table<sea::ParticleSea::Reading> probe_columns() {
  using Of = const sea::ParticleSea::Reading&;
  static constexpr ColumnOf<sea::ParticleSea::Reading> table[] = {
      {"pressure_Pa", "Pa", "pressure of the water, zero where there is none", [](Of r) { return r.pressure; }},
      {"vx_m_s", "m/s", "velocity of the water along x, zero where there is none", [](Of r) { return r.velocity[0]; }},
      {"vy_m_s", "m/s", "along y", [](Of r) { return r.velocity[1]; }},
      {"vz_m_s", "m/s", "along z", [](Of r) { return r.velocity[2]; }}};
  return table;
}

Table<WindowReport> window_columns() {
  using Of = const WindowReport&;
  static constexpr ColumnOf<WindowReport> table[] = {
      {"evaluations", "-", "of the window by the scheme, probes included", [](Of r) { return double(r.log.evaluations); }},
      {"mismatch", "-", "loads that went in and came out, their difference over them", [](Of r) { return r.mismatch; }}};
  return table;
}

Table<WindowReport> strong_columns() {
  using Of = const WindowReport&;
  static constexpr ColumnOf<WindowReport> table[] = {
      {"columns", "-", "differences that the scheme has", [](Of r) { return double(r.log.columns); }},
      {"cuts", "-", "halvings of the window", [](Of r) { return double(r.log.cuts); }},
      {"retries", "-", "attempts after clearing and relaxing", [](Of r) { return double(r.log.retries); }}};
  return table;
}

Table<double> time_error_columns() {
  static constexpr ColumnOf<double> table[] = {
      {"time_error", "-",
       "estimate of the error in time of the window's last physical step, momentum over what the air has beyond the undisturbed "
       "stream; 0 where there are too few steps before it",
       [](const double& error) { return error; }}};
  return table;
}

Table<aero::MarchState> march_columns() {
  using Of = const aero::MarchState&;
  static constexpr ColumnOf<aero::MarchState> table[] = {
      {"pseudo_steps", "-", "pseudo-steps of the window's last physical step", [](Of m) { return double(m.steps - 1); }},
      {"density_residual", "kg/(m3 s)", "root mean square over the cells after them", [](Of m) { return m.now.density; }},
      {"residual_drop", "-", "the same over its largest in that step",
       [](Of m) { return m.first.density > 0.0 ? m.density_drop() : 0.0; }},
      {"balance_drop", "-", "norm of all scaled flux balances over that of the step's start",
       [](Of m) { return m.balance_drop(); }},
      {"unconverged_steps", "-", "steps so far that spent their pseudo-steps without the drop",
       [](Of m) { return double(m.unconverged); }},
      {"cfl", "-", "CFL number of the last pseudo-step", [](Of m) { return m.cfl; }},
      {"limited_cells", "-", "cells whose pressure, temperature or velocity its update would have changed by too much",
       [](Of m) { return m.last.limited; }},
      {"clipped_cells", "-", "cells in which its update of turbulence was shortened to keep it above its bound",
       [](Of m) { return m.last.clipped; }}};
  return table;
}

Table<aero::MassBalance> mass_columns() {
  using Of = const aero::MassBalance&;
  static constexpr ColumnOf<aero::MassBalance> table[] = {
      {"mass_inflow_kg_s", "kg/s", "air that comes in through the boundaries of the grid", [](Of m) { return m.inflow; }},
      {"mass_outflow_kg_s", "kg/s", "air that goes out through them", [](Of m) { return m.outflow; }},
      {"mass_growth_kg_s", "kg/s", "rate at which the mass of all cells grows, by the time scheme; steady: 0",
       [](Of m) { return m.growth; }},
      {"mass_residual_kg_s", "kg/s",
       "of all cells' balances, what the pseudo-steps left: growth and outflow less inflow, but for round-off",
       [](Of m) { return m.residual; }}};
  return table;
}

std::vector<io::ColumnSection> column_sections() {
  return {section_of("BODY.", "each body: its reference point ([bodies.BODY] reference_m, else the centre of mass)",
                     motion_columns()),
          section_of("BODY.SOURCE.",
                     "each source of load of a body (gravity, forces, joint_laws, beams, moorings, sea, contact, rotor, "
                     "yaw_drive), about its centre of mass",
                     wrench_columns()),
          section_of("JOINT.",
                     "each joint: its reaction; symmetry_BODY and plane_BODY hold bodies in the plane of a half or a 2-D sea",
                     wrench_columns()),
          section_of("BEAM.", "each beam: how it is bent and the loads at its ends", beam_columns()),
          section_of("joints.", "scenes with joints", constraint_columns()),
          section_of("energy.", "scenes with bodies: their balance of energy", energy_columns()),
          section_of("energy.SOURCE.", "each source of load", work_columns()),
          section_of("rotor.", "scenes with a rotor, with bodies or alone; of [rotors.NAME] rotor.NAME., here and below",
                     rotor_columns()),
          section_of("rotor.", "rotors on bodies", hub_columns()),
          section_of("rotor.", "rotors on bodies", wind_columns()),
          section_of("rotor.", "controlled rotors", drive_columns()),
          section_of("rotor.", "controlled rotors with an elastic shaft", shaft_columns()),
          section_of("rotor.", "rotors with a yaw drive", yaw_columns()),
          section_of("rotor.blade_1.", "each blade of a controlled rotor", pitch_columns()),
          section_of("rotor.blade_1.", "each blade, where rotor.blade_masses or rotor.blade_structure is given", root_columns()),
          section_of("rotor.blade_1.", "each blade that bends", tip_columns()),
          section_of("rotor.blade_1.", "each blade of the grid of a resolved rotor", blade_columns()),
          section_of("MOORING.", "each line", mooring_columns()),
          section_of("MOORING.", "each line of the model lumped_mass", anchor_columns()),
          section_of("JUNCTION.", "each junction of lines", junction_columns()),
          section_of("waves.", "engineering seas with waves", wave_columns()),
          section_of("sea.",
                     "seas of particles; masses and energies are those of both halves where sea.tank.sides_y is symmetric, "
                     "counts of particles those of the one",
                     water_columns()),
          section_of("wavemaker.", "tanks with a paddle", paddle_columns()),
          section_of("GAUGE.", "each gauge of a sea of particles", gauge_columns()),
          section_of("GAUGE.", "each gauge that goes with a body", run_up_columns()),
          section_of("SENSOR.", "each sensor of a sea of particles", sensor_columns()),
          section_of("PROBE.", "each probe of a sea of particles", probe_columns()),
          section_of("coupling.", "schemes other than monolithic", window_columns()),
          section_of("coupling.", "schemes that iterate", strong_columns()),
          section_of("air.", "resolved rotors on bodies", march_columns()),
          section_of("air.", "resolved rotors on bodies: balance of the air's mass", mass_columns()),
          section_of("air.", "resolved rotors on bodies, where aero.flow.time_tolerance is given", time_error_columns())};
}

}  // namespace spindrift::coupling
