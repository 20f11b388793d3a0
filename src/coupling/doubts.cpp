// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <span>

#include "src/aero/doubts.hpp"
#include "src/bodies/doubts.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/floating_doubts.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/mode_doubts.hpp"
#include "src/coupling/rotor_doubts.hpp"
#include "src/coupling/time_doubts.hpp"
#include "src/moorings/bed_file.hpp"
#include "src/moorings/doubts.hpp"
#include "src/sea/doubts.hpp"

namespace spindrift::coupling {

namespace {

/// Of each rotor, by the scene with it alone: what is said of one stands under its own section, what is said of all of them once.
template <class Find>
void doubt_rotors(scene::Doubts& doubts, const FloatingSystem& floating, const Find& find) {
  const std::vector<Scenario> each = by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n) {
    for (scene::Doubt& doubt : find(each[n], floating.rotors()[n])) {
      if (doubt.key == "rotor" || doubt.key.starts_with("rotor.")) doubt.key.replace(0, 5, each[n].rotor_section);
      const auto same = [&](const scene::Doubt& other) { return other.key == doubt.key && other.what == doubt.what; };
      if (std::ranges::none_of(doubts, same)) doubts.push_back(doubt);
    }
  }
}

/// A body without shapes on the end of a tower is near that end: nacelles reach some 15 m from towers of 100 m.
void doubt_tower_head(scene::Doubts& doubts, const Scenario& s) {
  constexpr double most = 0.3;
  for (const auto& [name, beam] : s.beams)
    for (const auto& [body_name, body] : s.bodies) {
      const double off = (body.centre_m - beam.end_m).norm(), length = (beam.end_m - beam.start_m).norm();
      if (body_name != beam.bodies[1] || bodies::extent(body) > 0.0 || off <= most * length) continue;
      doubts.push_back({"bodies." + body_name + ".centre_m", fmt::format("{:.4g} m from the end of beam {}", off, name),
                        fmt::format("up to {:.3g} m, {:g} of the beam's length", most * length, most),
                        "look at its unit, m, and at end_m of the beam: both in earth coordinates"});
    }
}

/// The highest hub or end of a beam [m].
std::optional<double> tower_top(const Scenario& s) {
  std::optional<double> top;
  const auto reaches = [&](double height) { top = std::max(top.value_or(height), height); };
  if (s.has_rotor())
    for (const Scenario& one : by_rotor(s)) reaches(placed_rotor(one).rotor.hub_m.z());
  for (const auto& beam : s.beams) reaches(std::max(beam.options.start_m.z(), beam.options.end_m.z()));
  return top;
}

/// Of bodies, lines, turbine, sea and times, with the bodies where `motions` has them.
scene::Doubts plain_doubts(const FloatingSystem& floating, std::span<const Motion> motions) {
  const Scenario& s = floating.scenario();
  scene::Doubts all = body_doubts(s.bodies, {tower_top(s), s.has_particles() && s.sea.particles->planar()});
  append(all, bodies::beam_doubts(s.beams));
  doubt_tower_head(all, s);
  moorings::LineSurroundings around{s.has_sea() ? s.environment.water_depth_m : -1.0, weight(floating),
                                    s.environment.water_density_kg_m3, s.environment.gravity_m_s2, s.time.step()};
  std::optional<Bed> bed;
  if (!s.environment.bathymetry.empty()) around.bed = &bed.emplace(moorings::read_bed(s.environment.bathymetry));
  sea::BodiesInSea in_sea{
      .entry_speed = bodies::entry_speed(s.bodies, s.joints, s.beams, s.environment.gravity_m_s2, s.sea.lowest_surface())};
  for (const auto& [name, body] : s.bodies) {
    around.masses_kg[name] = body.mass_kg, around.centres[name] = body.centre_m, around.pieces[name] = bodies::pieces(body);
    if (const Eigen::AlignedBox3d box = bodies::bounds(body); !box.isEmpty())
      around.shapes[name] = box, in_sea.boxes.emplace_back(name, box);
    for (const bodies::CylinderOptions& c : body.cylinders)
      in_sea.members.push_back({c.name, std::max(c.diameter_m, c.end_diameter_m.value_or(0.0)), c.start_m, c.end_m});
  }
  append(all, line_doubts(s.moorings, around));
  append(all, junction_doubts(s.junctions, around));
  doubt_meshes(all, s);
  if (s.has_sea() && !s.has_particles())
    append(all, bodies::overlap_doubts(
                    s.bodies, s.sea.potential && !s.sea.potential->hydrostatics_file.empty() ? s.sea.potential->body : ""));
  if (s.has_sea() && !motions.empty()) in_sea.draft = doubt_floating(all, floating, motions);
  if (s.has_sea()) append(all, sea_doubts(s.sea, s.waves, sea_environment(s.environment), in_sea));
  if (s.has_sea()) append(all, wave_doubts(s.waves, sea_environment(s.environment)));
  if (s.has_sea()) doubt_linear_loads(all, floating);
  std::set<std::string> told;
  for (const Scenario& one : by_rotor(s)) append(all, rotor_file_doubts(one, told));
  append(all, time_doubts(floating));
  return all;
}

std::vector<Motion> described_starts(const FloatingSystem& floating) {
  std::vector<Motion> motions;
  for (const auto& body : floating.scenario().bodies) motions.push_back(start_motion(body.options));
  return motions;
}

}  // namespace

scene::Doubts doubts(FloatingSystem& floating, const Start& start, const Stability& stability) {
  scene::Doubts all = plain_doubts(floating, start.state.motions);
  // First: rotors of what capsizes are doubted too.
  if (!start.state.motions.empty()) append(all, statics_doubts(floating, start));
  const FullLoads full(floating);
  doubt_rotors(all, floating,
               [&](const Scenario& s, const RotorSource& rotor) { return rotor_doubts(s, rotor, start, weight(floating)); });
  if (start.state.motions.empty()) return all;
  append(all, wake_doubts(floating, start));
  append(all, acceleration_doubts(floating, start));
  append(all, growth_doubts(floating, stability));
  doubt_rotors(all, floating, [&](const Scenario& s, const RotorSource&) { return tuning_doubts(s, stability); });
  append(all, displaced_equilibrium_doubts(floating, start));
  doubt_rotors(all, floating, [&](const Scenario& s, const RotorSource& rotor) {
    scene::Doubts found = resonance_doubts(floating, rotor.loads, blades_of(s), start, stability);
    append(found, lean_doubts(floating, rotor.loads, start));
    return found;
  });
  append(all, step_doubts(floating, stability));
  return all;
}

scene::Doubts doubts_as_described(const FloatingSystem& floating) { return plain_doubts(floating, described_starts(floating)); }

std::vector<std::string> resolution_notes(const FloatingSystem& floating) {
  const Scenario& s = floating.scenario();
  if (!floating.particle_plan()) return {};
  scene::Doubts none;
  const double draft = s.bodies.empty() ? 0.0 : doubt_floating(none, floating, described_starts(floating));
  return sea::resolution_notes(s.sea, s.waves, draft);
}

scene::Doubts air_doubts(const Scenario& s) {
  scene::Doubts all;
  if (has_resolved_rotor(s) || s.has_actuator()) all = standing_rotor_doubts(s);
  if (const auto& motion = s.aero.flow->motion; motion && motion->oscillates() && motion->period_s > 2.0 * s.time.end_s)
    all.push_back({"aero.flow.motion.period_s", fmt::format("{:.4g} s in a run of {:.4g} s", motion->period_s, s.time.end_s),
                   "up to twice the run", "look at its unit: s"});
  for (const scene::Doubt& doubt : flow_doubts(*s.aero.flow, s.wind.speed_m_s, s.time.window_s, s.environment.air_density_kg_m3))
    if (std::ranges::find(all, doubt.key, &scene::Doubt::key) == all.end()) all.push_back(doubt);
  return all;
}

}  // namespace spindrift::coupling
