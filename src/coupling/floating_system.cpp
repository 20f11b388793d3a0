// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/floating_system.hpp"

#include <utility>

#include "src/bodies/loads.hpp"
#include "src/coupling/symmetry.hpp"
#include "src/moorings/bed_file.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

using Motions = std::span<const Motion>;

std::vector<Motion> described_motions(const bodies::NamedBodies& bodies) {
  std::vector<Motion> motions;
  for (const auto& body : bodies) motions.push_back(described_motion(body.options));
  return motions;
}

void add_point_loads(const Scenario& s, LoadSources& sources) {
  std::vector<bodies::PointLoad> loads = make_point_loads(s.bodies);
  if (loads.empty()) return;
  std::vector<int> on;
  for (const bodies::PointLoad& load : loads) on.push_back(load.body);
  sources.add(point_load_source("forces", std::move(loads)), marked(s.bodies.size(), on));
}

void add_joint_laws(const Scenario& s, LoadSources& sources) {
  std::vector<bodies::JointLaw> laws = make_joint_laws(s.joints, s.bodies);
  if (laws.empty()) return;
  std::vector<int> on;
  for (const bodies::JointLaw& law : laws) on.insert(on.end(), {law.i, law.j});
  sources.add(joint_law_source(std::move(laws)), marked(s.bodies.size(), on));
}

void add_beams(const Scenario& s, const std::vector<bodies::Beam>& beams, LoadSources& sources) {
  std::vector<int> on;
  for (const bodies::Beam& beam : beams) on.insert(on.end(), {beam.i, beam.j});
  sources.add(beam_source(beams, s.environment.gravity()), marked(s.bodies.size(), on));
}

moorings::LineEnvironment line_environment(const Scenario& s, const SeaSource& sea) {
  moorings::LineEnvironment around{s.environment.gravity_m_s2, s.environment.water_density_kg_m3};
  if (s.has_waves() || !s.sea.current_m_s.isZero(0.0) || !s.sea.current_profile.empty())
    around.water = [&sea](double t, const Eigen::Vector3d& point) { return sea.water(t, point); };
  if (!s.environment.bathymetry.empty()) around.bed = std::make_shared<const Bed>(moorings::read_bed(s.environment.bathymetry));
  return around;
}

void add_moorings(const Scenario& s, moorings::Moorings& lines, LoadSources& sources) {
  std::vector<int> on;
  for (const auto& [name, junction] : s.junctions) lines.add_junction(name, junction);
  for (const auto& [name, line] : s.moorings) {
    lines.add(name, line);
    for (const std::string& body : {line.body, line.anchor_body}) on.push_back(bodies::index_of(s.bodies, body));
  }
  bodies::LoadSource source{"moorings", [&lines](double t, Motions m, std::span<Wrench> w) { lines.add_loads(t, m, w); }, {}};
  if (lines.memory_size() > 0) {
    source.added_mass = [&lines](double, Motions m, std::span<bodies::Matrix6> a) { lines.add_added_mass(m, a); };
    source.memory = {lines.memory_size(), [&lines](double t, Motions m, std::span<double> memory) { lines.begin(t, m, memory); },
                     [&lines](std::span<const double> memory) { lines.recall(memory); },
                     [&lines](double t, double h, Motions m, std::span<double> memory) { lines.remember(t, h, m, memory); }};
  }
  sources.add(std::move(source), marked(s.bodies.size(), on));
}

void add_yaw_drive(const Scenario& s, YawDrive& yaw, const aero::RotorLoads& rotor, LoadSources& sources) {
  bodies::LoadSource source{"yaw_drive", [&yaw](double t, Motions m, std::span<Wrench> w) { yaw.add_loads(t, m, w); }, {}};
  source.memory = {YawDrive::memory_size,
                   [&yaw, &rotor](double t, Motions m, std::span<double> memory) { yaw.begin(t, rotor, m, memory); },
                   [&yaw](std::span<const double> memory) { yaw.recall(memory); },
                   [&yaw, &rotor](double t, double, Motions m, std::span<double> memory) { yaw.remember(t, rotor, m, memory); }};
  sources.add(std::move(source), marked(s.bodies.size(), {yaw.nacelle(), yaw.carrier()}));
}

}  // namespace

FloatingSystem::FloatingSystem(Scenario scenario)
    : scenario_(std::move(scenario)),
      timeline_(scenario_.time.window_s, scenario_.tick_s(), scenario_.time.end_s, scenario_.sea.settle_s()),
      sea_(scenario_, timeline_.tick_s(), loads_) {
  const Scenario& s = scenario_;
  const std::vector<Motion> start = described_motions(s.bodies);
  std::vector<std::string> names;
  for (const auto& body : s.bodies) {
    names.push_back(body.name);
    reference_points_.push_back(body.options.reference() - body.options.centre_m);
  }
  std::vector<bodies::Body> bodies = make_bodies(s.bodies);
  std::vector<bodies::Joint> joints = make_joints(s.joints, s.bodies);

  // The order of the sources is that of their columns in history.
  sources.add(gravity_source(bodies, s.environment.gravity_m_s2), std::vector<bool>(names.size(), true));
  add_point_loads(s, sources);
  add_joint_laws(s, sources);
  if (!s.beams.empty()) {
    beams_ = make_beams(s.beams, s.bodies, bodies, joints);
    for (const bodies::Beam& beam : beams_)
      for (const int end : {beam.i, beam.j})
        if (end != bodies::earth) bodies[std::size_t(end)].on_beam = true;
    add_beams(s, beams_, sources);
  }
  for (bodies::Joint& joint : joints_in_plane(s)) joints.push_back(std::move(joint));
  if (!s.moorings.empty()) {
    moorings_.emplace(names, start, line_environment(s, sea_));
    add_moorings(s, *moorings_, sources);
  }
  sea_.add_to(sources);
  rotors_ = make_rotors(s, start, timeline_.tick_s(), loads_);
  for (RotorSource& rotor : rotors_) rotor.add_to(sources);
  if (s.control.yaw) {
    yaw_.emplace(*s.control.yaw, s.joints, s.bodies);
    add_yaw_drive(s, *yaw_, *rotor(), sources);
  }
  multibody_ = std::make_unique<bodies::System>(std::move(bodies), std::move(joints), sources.take(), s.time.integrator);
  loads_changed();
}

void FloatingSystem::replace_rotor_loads(RotorSource::Loads loads, const aero::RotorLoad* written) {
  rotors_.front().replace(std::move(loads), written);
  loads_changed();
}

void FloatingSystem::loads_changed() {
  multibody_->set_loads_from_outside((!rotors_.empty() && rotors_.front().is_replaced()) || sea_.plan());
}

void refuse(const FloatingSystem& floating, std::string key, std::string value, std::string message) {
  throw scene::SceneError({{floating.scenario().source, 0, std::move(key), std::move(value), std::move(message)}});
}

}  // namespace spindrift::coupling
