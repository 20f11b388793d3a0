// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/floating_system.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "runtime/trace/clock.hpp"
#include "src/aero/turbine.hpp"
#include "src/bodies/extent.hpp"
#include "src/bodies/loads.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/moorings/bed_file.hpp"

namespace spindrift::coupling {

namespace {

std::vector<Motion> described_motions(const bodies::NamedBodies& bodies) {
  std::vector<Motion> motions;
  for (const auto& body : bodies) motions.push_back(described_motion(body.options));
  return motions;
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto it = std::find(names.begin(), names.end(), name);
  return it == names.end() ? -1 : int(it - names.begin());
}

/// From the bearing, whose second body is the one that turns, or from the rotor's section where it names none.
aero::RotorPlacement place_rotor(const Scenario& s, const std::vector<std::string>& bodies) {
  aero::RotorPlacement placement{.body = index_of(bodies, s.rotor.body),
                                 .support = {},
                                 .hub = s.rotor.hub_m,
                                 .axis = s.rotor.axis,
                                 .sense = s.rotor.sense()};
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint) {
      const bool second = joint.bodies[1] == s.rotor.body;
      placement.support = index_of(bodies, joint.bodies[second ? 0 : 1]);
      placement.hub = joint.point_m;
      placement.axis = joint.axis;
    }
  return placement;
}

/// One wind for all rotors, each of which meets it at its own place: gusts and boxes are made for the middle of their hubs.
aero::WindSite site_of(std::span<const Scenario> each, std::span<const aero::RotorPlacement> placements) {
  aero::WindSite site{placements.front().hub, aero::rotor_diameter(each.front().rotor)};
  if (each.size() == 1) return site;
  const double direction = each.front().wind.direction;
  Eigen::Matrix3d axes;  // rows: along the wind, across, up
  axes << std::cos(direction), std::sin(direction), 0.0, -std::sin(direction), std::cos(direction), 0.0, 0.0, 0.0, 1.0;
  Eigen::AlignedBox3d hubs;
  for (std::size_t n = 0; n < each.size(); ++n) {
    hubs.extend(axes * placements[n].hub);
    site.diameter = std::max(site.diameter, aero::rotor_diameter(each[n].rotor));
  }
  site.hub = axes.transpose() * hubs.center();
  site.across = hubs.sizes().y(), site.up = hubs.sizes().z();
  return site;
}

/// [control] with the events that happen to this rotor.
aero::ControlOptions control_of(const Scenario& s, const std::string& rotor) {
  aero::ControlOptions control = s.control;
  std::erase_if(control.events, [&](const aero::EventOptions& event) { return event.rotor && *event.rotor != rotor; });
  return control;
}

/// Resolved air is estimated by blade elements, where the turbine has what they need.
aero::AeroOptions engineering_rung(const Scenario& s) {
  aero::AeroOptions aero = s.aero;
  if (aero.tower && s.rotor.tower_foot_m) aero.tower->foot_m = *s.rotor.tower_foot_m;
  if (s.resolves_air()) aero.model = aero::read_turbine(s.rotor.turbine).polars.empty() ? "none" : "bem";
  return aero;
}

}  // namespace

FloatingSystem::FloatingSystem(Scenario scenario)
    : scenario_(std::move(scenario)),
      timeline_(scenario_.time.window_s, scenario_.tick_s(), scenario_.time.end_s, scenario_.sea.settle_s()) {
  const Scenario& s = scenario_;
  const std::vector<Motion> start = described_motions(s.bodies);
  std::vector<std::string> names;
  for (const auto& body : s.bodies) {
    names.push_back(body.name);
    reference_points_.push_back(body.options.reference() - body.options.centre_m);
  }

  std::vector<bodies::Body> bodies = make_bodies(s.bodies);
  sources.add(gravity_source(bodies, s.environment.gravity_m_s2), std::vector<bool>(names.size(), true));

  if (std::vector<bodies::PointLoad> loads = make_point_loads(s.bodies); !loads.empty()) {
    std::vector<bool> on(names.size());
    for (const bodies::PointLoad& load : loads) on[std::size_t(load.body)] = true;
    sources.add(point_load_source("forces", std::move(loads)), on);
  }
  if (std::vector<bodies::JointLaw> laws = make_joint_laws(s.joints, s.bodies); !laws.empty()) {
    std::vector<bool> on(names.size());
    for (const bodies::JointLaw& law : laws)
      for (const int body : {law.i, law.j})
        if (body != bodies::earth) on[std::size_t(body)] = true;
    sources.add(joint_law_source(std::move(laws)), on);
  }
  std::vector<bodies::Joint> joints = make_joints(s.joints, s.bodies);
  if (!s.beams.empty()) {
    beams_ = make_beams(s.beams, s.bodies, bodies, joints);
    std::vector<bool> on(names.size());
    for (const bodies::Beam& beam : beams_) {
      on[std::size_t(beam.j)] = true;
      if (beam.i != bodies::earth) on[std::size_t(beam.i)] = true;
    }
    sources.add(beam_source(beams_, s.environment.gravity()), on);
  }
  if (!s.moorings.empty()) {
    moorings::LineEnvironment around{s.environment.gravity_m_s2, s.environment.water_density_kg_m3};
    if (s.has_waves() || !s.sea.current_m_s.isZero(0.0) || !s.sea.current_profile.empty())
      around.water = [this](double t, const Eigen::Vector3d& point) {
        if (!sea_ || particle_plan_) return LineWater{};
        const waves::Kinematics water = sea_now().water(t, point);
        return LineWater{water.velocity, water.acceleration, sea_now().elevation(point.x(), point.y(), t)};
      };
    if (!s.environment.bathymetry.empty()) around.bed = std::make_shared<const Bed>(moorings::read_bed(s.environment.bathymetry));
    moorings_.emplace(names, start, std::move(around));
    std::vector<bool> on(names.size());
    for (const auto& [name, junction] : s.junctions) moorings_->add_junction(name, junction);
    for (const auto& [name, line] : s.moorings) {
      moorings_->add(name, line);
      for (const std::string& body : {line.body, line.anchor_body})
        if (const int b = index_of(names, body); b >= 0) on[std::size_t(b)] = true;
    }
    bodies::LoadSource source{
        "moorings", [this](double t, std::span<const Motion> m, std::span<Wrench> w) { moorings_->add_loads(t, m, w); }, {}};
    if (moorings_->memory_size() > 0) {
      source.added_mass = [this](double, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
        moorings_->add_added_mass(m, a);
      };
      source.memory = {moorings_->memory_size(),
                       [this](double t, std::span<const Motion> m, std::span<double> memory) { moorings_->begin(t, m, memory); },
                       [this](std::span<const double> memory) { moorings_->recall(memory); },
                       [this](double t, double h, std::span<const Motion> m, std::span<double> memory) {
                         moorings_->remember(t, h, m, memory);
                       }};
    }
    sources.add(std::move(source), on);
  }
  if (s.has_particles()) {
    const std::vector<sea::ParticleBody> shaped = particle_bodies(s.bodies);
    particle_plan_ = sea::particle_plan(s.sea, s.waves, sea_environment(s.environment), shaped,
                                        bodies::entry_speed(s.bodies, s.joints, s.beams, s.environment.gravity_m_s2));
    for (sea::SensorOptions& sensor : particle_plan_->sensors)
      if (sensor.mean_over_s == 0.0) sensor.mean_over_s = s.time.window_s;
    std::vector<bool> on(names.size());
    bool only_cylinders = true;
    for (std::size_t b = 0; b < names.size(); ++b) {
      on[b] = !shaped[b].shapes.empty();
      only_cylinders = only_cylinders && s.bodies[b].options.boxes.empty() && s.bodies[b].options.spheres.empty() &&
                       s.bodies[b].options.meshes.empty();
    }
    if (only_cylinders && !names.empty()) {
      sea::SeaOptions still;
      still.model = "morison";  // at rest that is buoyancy and the water's inertia, which modes need
      still.axial_added_mass_coefficient = 1.0;
      sea_.emplace(still, sea::WavesOptions{}, sea_environment(s.environment), sea_bodies(s.bodies));
    }
    sources.add({"sea",
                 [this](double t, std::span<const Motion> m, std::span<Wrench> w) {
                   if (particles_)
                     particles_->add_loads(m, w);
                   else if (sea_)
                     sea_->add_loads(t, m, w);
                 },
                 [this](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
                   if (!particles_ && sea_) sea_->add_added_mass(t, m, a);  // particles push back by themselves
                 }},
                on);
    if (particle_plan_->parameters.contact && std::find(on.begin(), on.end(), true) != on.end())
      sources.add({"contact",
                   [this](double, std::span<const Motion> m, std::span<Wrench> w) {
                     if (particles_) particles_->add_contacts(m, w);
                   },
                   {}},
                  on);
  } else if (s.has_sea()) {
    const std::vector<sea::SeaBody> wetted = sea_bodies(s.bodies);
    sea_.emplace(s.sea, s.waves, sea_environment(s.environment), wetted, timeline_.tick_s());
    if (s.has_waves()) still_sea_.emplace(s.sea, sea::WavesOptions{}, sea_environment(s.environment), wetted, timeline_.tick_s());
    std::vector<bool> on(names.size());
    for (std::size_t b = 0; b < names.size(); ++b) on[b] = !wetted[b].cylinders.empty();
    for (const sea::DampingOptions& damping : s.sea.damping) on[std::size_t(index_of(names, damping.body))] = true;
    for (const sea::MatricesOptions& matrices : s.sea.matrices) on[std::size_t(index_of(names, matrices.body))] = true;
    if (s.sea.potential) on[std::size_t(index_of(names, s.sea.potential->body))] = true;
    bodies::LoadSource source{
        "sea", [this](double t, std::span<const Motion> m, std::span<Wrench> w) { sea_now().add_loads(t, m, w); }, {}};
    if (sea_->has_added_mass())
      source.added_mass = [this](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
        sea_now().add_added_mass(t, m, a);
      };
    if (sea_->memory_size() > 0)
      source.memory = {
          sea_->memory_size(),
          [this](double t, std::span<const Motion> m, std::span<double> memory) { sea_->begin(t, m, memory); },
          [this](std::span<const double> memory) { sea_->recall(memory); },
          [this](double t, double, std::span<const Motion> m, std::span<double> memory) { sea_->remember(t, m, memory); }};
    sources.add(std::move(source), on);
  }
  add_rotors(names, start);
  if (s.control.yaw) {
    yaw_.emplace(*s.control.yaw, s.joints, s.bodies);
    std::vector<bool> on(names.size());
    on[std::size_t(yaw_->nacelle())] = true;
    if (yaw_->carrier() != bodies::earth) on[std::size_t(yaw_->carrier())] = true;
    bodies::LoadSource source{
        "yaw_drive", [this](double t, std::span<const Motion> m, std::span<Wrench> w) { yaw_->add_loads(t, m, w); }, {}};
    source.memory = {
        YawDrive::memory_size,
        [this](double t, std::span<const Motion> m, std::span<double> memory) { yaw_->begin(t, *rotor(), m, memory); },
        [this](std::span<const double> memory) { yaw_->recall(memory); },
        [this](double t, double, std::span<const Motion> m, std::span<double> memory) {
          yaw_->remember(t, *rotor(), m, memory);
        }};
    sources.add(std::move(source), on);
  }
  multibody_ = std::make_unique<bodies::System>(std::move(bodies), std::move(joints), sources.take(), s.time.integrator);
  loads_changed();
}

void FloatingSystem::add_rotors(const std::vector<std::string>& bodies, std::span<const Motion> start) {
  const Scenario& s = scenario_;
  const std::vector<Scenario> each = by_rotor(s);
  if (each.empty()) return;
  std::vector<aero::RotorPlacement> placements;
  for (const Scenario& one : each) placements.push_back(place_rotor(one, bodies));
  const aero::Wind wind = aero::wind_of(s.wind, site_of(each, placements));
  for (std::size_t n = 0; n < each.size(); ++n) {
    const Scenario& one = each[n];
    const std::string own = s.rotors.empty() ? "" : s.rotors[n].name, name = own.empty() ? "rotor" : "rotor." + own;
    aero::RotorLoads& rotor =
        rotors_
            .emplace_back(Rotor{name,
                                rotor_radius(one),
                                {engineering_rung(one), one.rotor, wind, s.environment.air_density_kg_m3, placements[n], start,
                                 control_of(s, own), timeline_.tick_s(), s.environment.gravity()}})
            .loads;
    std::vector<bool> on(bodies.size());
    on[rotor.bearing().body()] = true;
    bodies::LoadSource source{name,
                              [this, &rotor](double t, std::span<const Motion> m, std::span<Wrench> w) {
                                if (rotor_elsewhere_)
                                  rotor_elsewhere_(t, m, w);
                                else if (mean_loads_)
                                  rotor.add_mean_loads(t, m, w);
                                else
                                  rotor.add_loads(t, m, w, ramp(t));
                              },
                              {}};
    if (rotor.flexible())
      source.added_mass = [this, &rotor](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
        if (!mean_loads_) rotor.add_added_mass(t, m, a);
      };
    if (rotor.memory_size() > 0)
      source.memory = {
          rotor.memory_size(),
          [&rotor](double t, std::span<const Motion> m, std::span<double> memory) { rotor.begin(t, m, memory); },
          [&rotor](std::span<const double> memory) { rotor.recall(memory); },
          [&rotor](double t, double h, std::span<const Motion> m, std::span<double> memory) { rotor.remember(t, h, m, memory); }};
    sources.add(std::move(source), on);
  }
}

void FloatingSystem::replace_rotor_loads(RotorLoadFunction loads, const aero::RotorLoad* written) {
  rotor_elsewhere_ = std::move(loads), rotor_written_ = written;
  loads_changed();
}

void FloatingSystem::loads_changed() { multibody_->set_loads_from_outside(rotor_elsewhere_ || particle_plan_); }

void FloatingSystem::fill_sea(std::span<const Motion> start, const runtime::World& world) {
  if (particle_plan_) particles_ = sea::ParticleSea::make(*particle_plan_, start, world);
}

double FloatingSystem::ramp(double t) const {
  const double length = scenario_.start.ramp_s;
  if (full_loads_ || t >= length) return 1.0;
  const double x = std::max(0.0, t / length);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace spindrift::coupling
