// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/rigid/rotation.hpp"

namespace spindrift::coupling {

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

ReferenceMotion reference_motion(const FloatingSystem& floating, std::size_t body, const Motion& now) {
  return reference_motion(now, described_motion(floating.scenario().bodies[body].options), floating.reference_point(body),
                          Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
}

Recorder::Recorder(FloatingSystem& floating, io::History& history) : floating_(floating) {
  const auto bodies = floating.multibody().bodies();
  const auto loads = floating.multibody().loads();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies_.emplace_back(history, bodies[b].name + ".", motion_columns());
    for (std::size_t s = 0; s < loads.size(); ++s)
      if (floating.sources.loads_body(s, b))
        loads_.push_back({s, b, {history, bodies[b].name + "." + loads[s].name + ".", wrench_columns()}});
  }
  for (const bodies::Joint& joint : floating.multibody().joints())
    joints_.emplace_back(history, joint.name + ".", wrench_columns());
  if (!joints_.empty()) constraints_.emplace(history, "joints.", constraint_columns());
  for (const bodies::Beam& beam : floating.beams()) beams_.emplace_back(history, beam.name + ".", beam_columns());
  if (!bodies.empty()) {
    energy_.emplace(history, "energy.", energy_columns());
    for (const bodies::LoadSource& source : loads) works_.emplace_back(history, "energy." + source.name + ".", work_columns());
  }
  for (const RotorSource& rotor : floating.rotors()) declare_rotor(history, rotor);
  if (floating.moorings())
    for (std::size_t line = 0; line < floating.moorings()->size(); ++line) {
      const std::string prefix = floating.moorings()->name(line) + ".";
      moorings_.emplace_back(history, prefix, mooring_columns());
      anchors_.emplace_back();
      if (floating.moorings()->is_dynamic(line)) anchors_.back().emplace(history, prefix, anchor_columns());
    }
  for (std::size_t j = 0; floating.moorings() && j < floating.moorings()->junctions(); ++j)
    junctions_.emplace_back(history, floating.moorings()->junction_name(j) + ".", junction_columns());
  if (floating.scenario().has_given_waves()) waves_.emplace(history, "waves.", wave_columns());
  if (floating.particle_plan())
    declare_particles(history);
  else
    declare_gauges(history);
}

void Recorder::declare_rotor(io::History& history, const RotorSource& rotor) {
  const std::string prefix = rotor.name + ".";
  const auto of_blade = [&](std::size_t blade) { return prefix + "blade_" + std::to_string(blade) + "."; };
  Rotor& columns = rotors_.emplace_back(
      Rotor{{history, prefix, rotor_columns()}, {history, prefix, hub_columns()}, {history, prefix, wind_columns()}});
  if (const aero::TurbineControl* control = rotor.loads.control()) {
    columns.drive.emplace(history, prefix, drive_columns());
    if (control->has_elastic_shaft()) columns.shaft.emplace(history, prefix, shaft_columns());
    for (std::size_t blade = 1; blade <= control->blades(); ++blade)
      columns.pitches.emplace_back(history, of_blade(blade), pitch_columns());
  }
  if (floating_.yaw()) yaw_.emplace(history, prefix, yaw_columns());
  const aero::BladeLoads* blades = rotor.loads.blades();
  for (std::size_t blade = 1; blades && blade <= blades->roots(); ++blade)
    columns.roots.emplace_back(history, of_blade(blade), root_columns());
  for (std::size_t blade = 1; blades && blades->flexible() && blade <= blades->roots(); ++blade)
    columns.tips.emplace_back(history, of_blade(blade), tip_columns());
}

void Recorder::fill_rotor(std::span<double> row, const Rotor& columns, const RotorSource& source,
                          const bodies::BodiesState& state, const bodies::Evaluation& now, double t) const {
  const aero::RotorLoads& rotor = source.loads;
  const aero::RotorState turned = rotor.state(t, state.motions);
  columns.load.fill(row, {source.written(t, turned), turned.azimuth / radians_per_degree, turned.speed / rad_s_per_rpm});
  columns.hub.fill(row, turned);
  columns.wind.fill(row, rotor.wind().at(t, turned.hub));
  if (columns.drive) {
    const aero::RotorLoads::Drive drive = rotor.drive();
    columns.drive->fill(row, drive);
    if (columns.shaft) columns.shaft->fill(row, drive);
    for (std::size_t blade = 0; blade < columns.pitches.size(); ++blade) columns.pitches[blade].fill(row, drive.pitch[blade]);
  }
  if (!columns.roots.empty()) {
    const std::size_t b = rotor.bearing().body();
    const std::vector<aero::BladeRootLoad> of_roots =
        rotor.root_loads(t, state.motions, now.acceleration[b], now.angular_acceleration[b],
                         floating_.scenario().environment.gravity(), source.ramp(t));
    for (std::size_t blade = 0; blade < columns.roots.size(); ++blade) columns.roots[blade].fill(row, of_roots[blade]);
  }
  if (!columns.tips.empty()) {
    const std::vector<Eigen::Vector2d> tips = rotor.tips(t, state.motions);
    for (std::size_t blade = 0; blade < columns.tips.size(); ++blade) columns.tips[blade].fill(row, tips[blade]);
  }
}

void Recorder::declare_gauges(io::History& history) {
  for (const sea::GaugeOptions& gauge : floating_.scenario().sea.gauges) {
    gauges_.emplace_back(history, gauge.name + ".", gauge_columns());
    run_ups_.emplace_back();
    if (!gauge.body.empty()) run_ups_.back().emplace(history, gauge.name + ".", run_up_columns());
  }
}

template <class Surface>
void Recorder::fill_gauges(std::span<double> row, std::span<const Motion> motions, const Surface& surface) const {
  const bodies::NamedBodies& bodies = floating_.scenario().bodies;
  std::vector<std::array<double, 2>> places;
  std::vector<double> marks;  // of gauges that go with bodies: where the waterline is
  for (const sea::GaugeOptions& gauge : floating_.scenario().sea.gauges) {
    Eigen::Vector3d at(gauge.point_m[0], gauge.point_m[1], 0.0);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].name == gauge.body) at = motions[b].point(at - described_motion(bodies[b].options).position);
    places.push_back({at[0], at[1]}), marks.push_back(at[2]);
  }
  const std::vector<double> heights = surface(places);
  for (std::size_t n = 0; n < places.size(); ++n) {
    gauges_[n].fill(row, heights[n]);
    if (run_ups_[n]) run_ups_[n]->fill(row, heights[n] - marks[n]);
  }
}

void Recorder::declare_particles(io::History& history) {
  const sea::ParticlePlan& plan = *floating_.particle_plan();
  water_.emplace(history, "sea.", water_columns());
  if (plan.wavemaker) paddle_.emplace(history, "wavemaker.", paddle_columns());
  declare_gauges(history);
  for (const sea::ProbeOptions& probe : plan.probes) probes_.emplace_back(history, probe.name + ".", probe_columns());
  for (const sea::SensorOptions& sensor : plan.sensors) sensors_.emplace_back(history, sensor.name + ".", sensor_columns());
}

void Recorder::fill_particles(std::span<double> row, std::span<const Motion> motions, double t) const {
  const sea::ParticlePlan& plan = *floating_.particle_plan();
  const sea::ParticleSea& sea = *floating_.particles();
  const sea::ParticleSea::Counts counts = sea.counts();
  water_->fill(row, {double(counts.lost), double(counts.left), sea.extent()});
  if (paddle_) paddle_->fill(row, sea.paddle(t));
  // Where there is no water the surface is the bed and nothing moves: no column holds what is not a number.
  fill_gauges(row, motions, [&](const std::vector<std::array<double, 2>>& places) {
    std::vector<double> heights = sea.surface(places);
    for (std::size_t n = 0; n < places.size(); ++n)
      if (!std::isfinite(heights[n])) heights[n] = plan.tank.bed_at(places[n][0]);
    return heights;
  });
  for (std::size_t n = 0; n < sensors_.size(); ++n) sensors_[n].fill(row, sea.sensor(n));
  for (std::size_t n = 0; n < plan.probes.size(); ++n) {
    sea::ParticleSea::Reading reading = sea.probe(plan.probes[n].point_m);
    if (!reading.velocity.allFinite()) reading.velocity.setZero();
    probes_[n].fill(row, reading);
  }
}

void Recorder::fill(std::span<double> row, const bodies::BodiesState& state, double t) {
  // Bodies that are held before t = 0 are as they start: drivers and loads that depend on time begin there.
  static const bodies::Evaluation nothing;
  const bodies::Evaluation& now = state.motions.empty() ? nothing : floating_.multibody().evaluate(state, std::max(t, 0.0));
  if (!now.report.ok()) {                                                         // the next step says why
    std::ranges::fill(row.subspan(1), std::numeric_limits<double>::quiet_NaN());  // all but the time
    return;
  }
  const auto bodies = floating_.multibody().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    bodies_[b].fill(row, reference_motion(state.motions[b], bodies[b].initial, floating_.reference_point(b), now.acceleration[b],
                                          now.angular_acceleration[b]));
  for (const Load& load : loads_) load.columns.fill(row, now.by_source[load.source][load.body]);
  for (std::size_t j = 0; j < joints_.size(); ++j) joints_[j].fill(row, now.joint_reactions[j]);
  if (constraints_) constraints_->fill(row, floating_.multibody().constraint_residual_now());
  for (std::size_t n = 0; n < beams_.size(); ++n)
    beams_[n].fill(row, read_beam(floating_.beams()[n], state.motions, now.acceleration, now.angular_acceleration,
                                  floating_.scenario().environment.gravity()));
  if (energy_) {
    const std::span<const double> work = state.work;
    for (std::size_t s = 0; s < works_.size(); ++s) works_[s].fill(row, work[s]);
    energy_->fill(row, {floating_.multibody().kinetic_energy(state), work.subspan(works_.size())});
  }
  for (std::size_t n = 0; n < rotors_.size(); ++n) fill_rotor(row, rotors_[n], floating_.rotors()[n], state, now, t);
  if (yaw_) yaw_->fill(row, floating_.yaw()->reading(t, *floating_.rotor(), state.motions));
  if (floating_.moorings()) {
    const std::vector<moorings::LineTension> tensions = floating_.moorings()->tensions(state.motions);
    for (std::size_t line = 0; line < moorings_.size(); ++line) {
      moorings_[line].fill(row, tensions[line]);
      if (anchors_[line]) anchors_[line]->fill(row, tensions[line]);
    }
    const std::vector<LineEnd> junctions = floating_.moorings()->junction_motions(state.motions);
    for (std::size_t j = 0; j < junctions_.size(); ++j) junctions_[j].fill(row, junctions[j]);
  }
  if (floating_.particles()) fill_particles(row, state.motions, t);
  if (waves_) waves_->fill(row, floating_.sea()->elevation(0.0, 0.0, t));
  if (!floating_.particle_plan() && !gauges_.empty())
    fill_gauges(row, state.motions, [&](const std::vector<std::array<double, 2>>& places) {
      std::vector<double> heights;
      for (const auto& [x, y] : places) heights.push_back(floating_.sea()->elevation(x, y, t));
      return heights;
    });
}

}  // namespace spindrift::coupling
