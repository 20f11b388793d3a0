// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "kernels/base/constants.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/rotor_grid/pitching.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/rotor_defaults.hpp"
#include "src/coupling/symmetry.hpp"
#include "src/coupling/timeline.hpp"
#include "src/moorings/bed_file.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

template <class Options>
std::vector<std::string> names(const std::vector<scene::Named<Options>>& named) {
  std::vector<std::string> result;
  for (const auto& entry : named) result.push_back(entry.name);
  return result;
}

/// Names are columns of history.csv: one meaning each.
void check_names(scene::Document& document, const Scenario& s) {
  std::set<std::string> seen;
  const auto check = [&](const char* section, const std::vector<std::string>& all) {
    for (const std::string& name : all) {
      if (!seen.insert(name).second)
        document.problem(fmt::format("{}.{}", section, name),
                         fmt::format("\"{}\" is the name of another body, joint, beam, line or junction", name));
    }
  };
  check("bodies", names(s.bodies));
  check("joints", names(s.joints));
  check("beams", names(s.beams));
  check("moorings", names(s.moorings));
  check("junctions", names(s.junctions));
}

/// Rules between the yaw drive, its bearing and the rotor.
void check_yaw(scene::Document& document, const Scenario& s) {
  const aero::YawOptions& yaw = *s.control.yaw;
  if (s.resolves_air())
    return document.problem("control.yaw", fmt::format("does not go with aero.model \"{}\": the drive steps with the bodies and "
                                                       "the undisturbed wind; thrust_curve and bem have it",
                                                       s.aero.model));
  if (s.coupling.scheme != SchemeKind::monolithic)
    document.problem("coupling.scheme", "must be \"monolithic\" with [control.yaw]: the drive steps with the bodies");
  if (s.aero.model != "thrust_curve" && s.aero.model != "bem")
    document.problem("control.yaw", fmt::format("needs wind: aero.model is \"{}\"; thrust_curve and bem have it", s.aero.model));
  const auto joint = std::ranges::find(s.joints, yaw.joint, &scene::Named<bodies::JointOptions>::name);
  if (joint == s.joints.end()) {
    const std::vector<std::string> known = names(s.joints);
    return document.problem("control.yaw.joint",
                            fmt::format("names \"{}\", which is not in [joints]; known: {}", yaw.joint, fmt::join(known, ", ")));
  }
  const bodies::JointOptions& o = joint->options;
  if (o.type != JointType::revolute || o.rotation)
    document.problem("control.yaw.joint",
                     fmt::format("must be a revolute joint without [joints.{}.rotation]: the drive turns it", yaw.joint));
  constexpr double upright = 0.94;  // cos of 20 degrees
  if (std::abs(o.axis.normalized().z()) < upright)
    document.problem("control.yaw.joint", fmt::format("must turn about an upright axis: see joints.{}.axis", yaw.joint));
  std::string carrier = s.rotor.body;
  for (const auto& [name, bearing] : s.joints)
    if (name == s.rotor.joint && bearing.bodies.size() == 2) carrier = bearing.bodies[bearing.bodies[1] == s.rotor.body ? 0 : 1];
  if (o.bodies.size() == 2 && o.bodies[1] != carrier && o.bodies[1] != s.rotor.body)
    document.problem("control.yaw.joint", fmt::format("must have the body that carries the rotor, {}, as its second body, not {}",
                                                      carrier, o.bodies[1]));
}

/// Names of what reads the water, which columns begin with.
void check_gauge_names(scene::Document& document, const Scenario& s) {
  std::set<std::string> taken;
  const auto check_all = [&](const char* section, const auto& all) {
    for (std::size_t n = 0; n < all.size(); ++n) {
      const std::string key = fmt::format("sea.{}[{}].name", section, n), &name = all[n].name;
      if (name.empty() || name.find_first_of(" ,.\"\t\n") != std::string::npos)
        document.problem(key, "must be a name without spaces, commas, dots and quotes");
      if (!taken.insert(name).second) document.problem(key, "is the name of another gauge, probe or sensor");
      for (const auto& body : s.bodies)
        if (body.name == name) document.problem("bodies." + name, "is the name of a gauge, probe or sensor too");
    }
  };
  check_all("gauges", s.sea.gauges), check_all("probes", s.sea.probes), check_all("sensors", s.sea.sensors);
}

/// Rules between a sea of particles and the rest of the scene.
void check_particles(scene::Document& document, const Scenario& s) {
  const std::vector<sea::ParticleBody> bodies = particle_bodies(s.bodies);
  for (const sea::OptionProblem& p : particle_problems(s.sea, s.waves, sea_environment(s.environment), bodies))
    document.problem(p.key, p.what, p.follows_from);
  if (s.sea.particles->planar())
    for (const sea::OptionProblem& p : out_of_plane_problems(s)) document.problem(p.key, p.what, p.follows_from);
  else if (s.sea.tank->symmetric())
    for (const sea::OptionProblem& p : symmetry_problems(s, s.sea.tank->y_m[0])) document.problem(p.key, p.what, p.follows_from);
  if (s.sea.settle_s() > 0.0 && !whole_ratio(s.sea.settle_s(), s.time.window_s))
    document.problem("sea.initial.settle_s", fmt::format("must be a whole number of windows of {} s (nearest: {:.12g} s)",
                                                         s.time.window_s, nearest_multiple(s.sea.settle_s(), s.time.window_s)));
}

/// Height of the hub above still water as the scene describes it [m].
double hub_height(const Scenario& s) {
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint) return bodies::point_of(joint, s.bodies).z();
  return s.rotor.hub_m.z();
}

/// Rotor speed and blade pitch of the operating table, into the rotor's section or the driver of its bearing.
void take_operating_point(scene::Document& document, Scenario& s) {
  if (s.rotor.operating_point != "table") return;
  const std::string& own = s.rotor_section;
  if (s.rotor.operation.empty())
    return document.problem(own + ".operating_point",
                            fmt::format("is \"table\", but neither {0}.operation nor {0}.turbine names one", own));
  const aero::Operation table = aero::read_operation(s.rotor.operation);
  if (table.pitch.empty())
    return document.problem(own + ".operation",
                            fmt::format("has no column blade_pitch_deg, which {}.operating_point \"table\" needs", own));
  const aero::OperatingPoint point = table.at(s.wind.speed_m_s * aero::wind_profile(s.wind).share(hub_height(s)));
  s.rotor.speed = point.speed, s.rotor.blade_pitch = point.pitch;
  for (auto& [name, joint] : s.joints) {
    if (name != s.rotor.joint) continue;
    if (!joint.rotation)
      return document.problem(own + ".operating_point",
                              "is \"table\", but nothing drives the bearing: give [joints." + name + ".rotation]");
    joint.rotation->rate = std::copysign(point.speed, s.rotor.sense() < 0.0 ? -1.0 : joint.rotation->rate);
  }
}

/// What a turbine file says where the scene says nothing, and what follows from it. Files that cannot be read are told of by
/// check_rotor.
void take_from_turbine(scene::Document& document, Scenario& s) {
  if (!s.has_rotor() && !has_resolved_rotor(s) && !s.has_actuator()) return;
  int blades = 3;
  std::optional<aero::Operation> operation;
  try {
    if (!s.rotor.turbine.empty()) {
      const aero::TurbineFiles files = aero::turbine_files(s.rotor.turbine);
      if (s.rotor.operation.empty()) s.rotor.operation = files.operation;
      if (s.control.file.empty()) s.control.file = files.controller;
      blades = aero::read_turbine(s.rotor.turbine).blades;
    }
    take_operating_point(document, s);
    if (!s.rotor.operation.empty()) operation = aero::read_operation(s.rotor.operation);
  } catch (const scene::SceneError&) { return; }
  if (s.is_controlled()) aero::check_control(document, s.control, s.aero, s.rotor, operation, blades, s.rotor_section);
}

void take_from_turbines(scene::Document& document, Scenario& s) {
  if (s.rotors.empty()) return take_from_turbine(document, s);
  const bool named = !s.control.file.empty();
  for (auto& [name, rotor] : s.rotors) {
    Scenario one = s;
    one.rotor = rotor, one.rotor_section = "rotors." + name;
    if (!named) one.control.file.clear();
    take_from_turbine(document, one);
    if (s.is_controlled() && !s.control.file.empty() && !one.control.file.empty() && one.control.file != s.control.file)
      document.problem(one.rotor_section + ".turbine",
                       fmt::format("names another controller than rotors.{}.turbine: one [control] is for all rotors; give "
                                   "control.file",
                                   s.rotors.front().name));
    rotor = one.rotor, s.joints = std::move(one.joints);
    if (s.control.file.empty()) s.control.file = one.control.file;
  }
  s.rotor = s.rotors.front().options;
}

/// What of a scene several rotors cannot share.
void check_rotors(scene::Document& document, const Scenario& s) {
  for (const auto& [name, rotor] : s.rotors) {
    if (name.starts_with("blade_"))
      document.problem("rotors." + name, "must have another name: columns rotor.blade_1 and so on are those of blades");
    if (rotor.tower_foot_m && !s.aero.tower)
      document.problem(fmt::format("rotors.{}.tower_foot_m", name), "has no effect: there is no [aero.tower]");
  }
  if (s.aero.tower && document.given("aero.tower.foot_m") &&
      std::ranges::all_of(s.rotors, [](const auto& rotor) { return rotor.options.tower_foot_m.has_value(); }))
    document.problem("aero.tower.foot_m", "has no effect: each rotor has its own tower_foot_m");
  const std::vector<std::string> known = names(s.rotors);
  for (std::size_t n = 0; n < s.control.events.size(); ++n)
    if (const std::optional<std::string>& rotor = s.control.events[n].rotor;
        rotor && std::ranges::find(known, *rotor) == known.end())
      document.problem(fmt::format("control.events[{}].rotor", n),
                       fmt::format("names \"{}\", which is not in [rotors]; known: {}", *rotor, fmt::join(known, ", ")));
  if (s.coupling.scheme != SchemeKind::monolithic)
    document.problem("coupling.scheme",
                     "must be \"monolithic\" with [rotors]: several rotors load the bodies as they go, no window "
                     "is exchanged; a single one in [rotor] has the other schemes");
  if (s.rotors.size() == 1) return;
  if (s.control.model == aero::ControlModel::library)
    document.problem("control.model",
                     "\"library\" is for one rotor: a library keeps what it remembers in the program's memory, which "
                     "several rotors would share; take \"dtu\"");
  if (s.control.yaw)
    document.problem("control.yaw", fmt::format("is for one rotor: it follows the wind at that one's hub, and [rotors] has {}",
                                                s.rotors.size()));
  if (s.wind.event &&
      (s.wind.event->what == aero::WindEvent::ews_vertical || s.wind.event->what == aero::WindEvent::ews_horizontal))
    document.problem("wind.event.what", "extreme shear is that over one rotor, about its hub: [rotors] has several");
  std::set<std::array<double, 2>> feet;
  std::set<std::string> driven;
  for (const auto& [name, rotor] : s.rotors) {
    const std::string own = "rotors." + name;
    if (!rotor.joint.empty() && !driven.insert(rotor.joint).second)
      document.problem(own + ".joint", fmt::format("\"{}\" is the bearing of another rotor", rotor.joint));
    if (!s.aero.tower) continue;
    if (!rotor.tower_foot_m)
      document.problem(own + ".tower_foot_m", "must be given: there are several rotors and [aero.tower]");
    else if (!feet.insert(*rotor.tower_foot_m).second)
      document.problem(own + ".tower_foot_m", "is that of another rotor: the drag of one tower would count twice");
  }
}

void check_bathymetry(scene::Document& document, const Scenario& s) {
  const std::string& file = s.environment.bathymetry;
  if (file.empty()) return;
  if (std::ranges::none_of(s.moorings, [](const auto& line) { return moorings::lies_on_bed(line.options); }))
    return document.problem("environment.bathymetry", "has no effect: no line of the model lumped_mass meets the bed");
  try {
    check_bed(document, s.moorings, moorings::read_bed(file));
  } catch (const scene::SceneError& e) { document.problem("environment.bathymetry", e.what()); }
}

/// A saved state is the start: what would make another one has no effect.
void check_saved_start(scene::Document& document, const Scenario& s) {
  if (s.start.file.empty()) return;
  if (s.has_flow()) return document.problem("start.file", "has no effect: there are no bodies");
  const std::string why = "has no effect: start.file is the start";
  if (s.start.equilibrium) document.problem("start.equilibrium", why, "start.file");
  if (s.start.air_steps > 0) document.problem("start.air_steps", why, "start.file");
  if (!s.start.air.empty()) document.problem("start.air", why, "start.file");
  if (s.sea.settle_s() > 0.0) document.problem("sea.initial.settle_s", why, "start.file");
  if (s.sea.initial && s.sea.initial->state == "file") document.problem("sea.initial.state", why, "start.file");
}

/// What of a wind that changes resolved air can have.
void check_changing_wind(scene::Document& document, const Scenario& s) {
  const std::string leave_out = "leave out table, event and turbulence";
  if (!s.has_actuator() && !has_resolved_rotor(s))
    return document.problem("wind", "must be steady in resolved air without a rotor: " + leave_out);
  if (s.aero.flow->time == "steady")
    return document.problem("wind", "must be steady where aero.flow.time is \"steady\": take \"bdf2\", or " + leave_out);
  if (s.wind.turbulence && s.aero.flow->incidence != 0.0)
    document.problem("aero.flow.incidence_deg", "must be 0 with wind.turbulence: a box of turbulence blows level past the rotor");
  if (has_resolved_rotor(s) && s.aero.grid->sectors != "all") {
    const std::string take = ": take aero.grid.sectors = \"all\"";
    if (aero::turns(s.wind)) document.problem("wind", "must keep its direction with one sector of blades" + take);
    if (s.wind.varies_over_rotor()) document.problem("wind", "must be the same for all blades with one sector of them" + take);
  }
  if (const std::optional<aero::Corners> box = s.has_actuator() ? aero::box_corners(*s.aero.flow) : std::nullopt)
    if (const std::string why = aero::why_inflow_plane_outside(s.wind, wind_site(s), *box); !why.empty())
      document.problem("wind.turbulence.inflow_plane_m", why);
  if (has_resolved_rotor(s) && s.wind.turbulence && s.wind.turbulence->inflow_plane_m) {
    const double upwind = s.aero.grid->upstream_extent * rotor_radius(s);
    if (*s.wind.turbulence->inflow_plane_m > upwind)
      document.problem("wind.turbulence.inflow_plane_m",
                       fmt::format("must be at most {:.4g} m, where the grid of the rotor ends", upwind));
  }
}

/// Wind that rises or sinks over the ground would have to come out of it: the flow slows it down on its way to the rotor.
void check_wind_over_ground(scene::Document& document, const Scenario& s) {
  const bool table = aero::rises(s.wind);
  if (!table && s.aero.flow->incidence == 0.0) return;
  for (const aero::PatchOptions& side : s.aero.flow->boundaries)
    if (aero::is_wall(aero::of(side.condition)) && (side.patch == "z_min" || side.patch == "z_max"))
      document.problem(
          table ? "wind.table" : "aero.flow.incidence_deg",
          fmt::format("must not have the wind {}: no air goes through patch \"{}\" ({})",
                      table ? "rise or sink, in vertical_m_s" : "blow upwards", side.patch, aero::of(side.condition).name));
}

/// Of a rotor that no body carries.
void check_standing_actuator(scene::Document& document, const Scenario& s) {
  aero::check_actuator(document, s.aero, s.rotor, "rotor.hub_m");
  if (!s.rotor.operation.empty()) try {
      aero::read_operation(s.rotor.operation);
    } catch (const scene::SceneError& e) { document.problem("rotor.operation", e.what()); }
  if (!s.rotor.joint.empty()) document.problem("rotor.joint", "has no effect: there are no [bodies]");
  if (!s.rotor.body.empty()) document.problem("rotor.body", "has no effect: there are no [bodies]");
}

void check_flows(scene::Document& document, const aero::WindOptions& wind) {
  constexpr double least = 1e-6;  // m/s: far below it the flow's own scales, squares of it among them, are no numbers any more
  if (wind.speed_m_s <= 0.0)
    document.problem("wind.speed_m_s", "must be > 0: the resolved air flows");
  else if (wind.speed_m_s < least)
    document.problem("wind.speed_m_s", fmt::format("must be at least {:g} m/s: the resolved air flows", least));
}

/// Of a rotor that goes through a standing grid with its bodies.
void check_carried_actuator(scene::Document& document, const Scenario& s) {
  const auto [rotor, hub_key] = placed_rotor(s);
  aero::check_actuator(document, s.aero, rotor, hub_key);
  if (!s.start.air.empty())
    document.problem("start.air", fmt::format("takes the air of a blade-resolved rotor; that of aero.model \"{}\" settles by "
                                              "start.air_steps",
                                              s.aero.model));
  if (s.aero.flow->start != "wind") document.problem("aero.flow.start", "must be \"wind\" where bodies carry the rotor");
  check_flows(document, s.wind);
}

/// What of [control] the blades of resolved air can follow: those of a disc or of one sector are alike.
void check_blades_of_their_own(scene::Document& document, const Scenario& s) {
  const bool disc = s.aero.model == "actuator_disc";
  if (!disc && !(has_resolved_rotor(s) && s.aero.grid->sectors == "one")) return;
  const std::string why = disc ? "needs blades of their own, which a disc has not: take aero.model \"actuator_line\""
                               : "needs blades of their own: one sector stands for all; take aero.grid.sectors = \"all\"";
  for (std::size_t n = 0; n < s.control.events.size(); ++n)
    if (s.control.events[n].what == aero::ControlEvent::blade_stuck)
      document.problem(fmt::format("control.events[{}].what", n), "\"blade_stuck\" " + why);
  if (s.control.individual_pitch) document.problem("control.individual_pitch", why);
}

/// The grid of resolved blades follows their pitch so far from that of [rotor]. Events that are known to take them farther are
/// told here, what the controller does as the run goes.
void check_pitch_of_grid(scene::Document& document, const Scenario& s) try {
  constexpr double degree = radians_per_degree, most = aero::BladePitching::most_change;
  const bool library = s.control.model == aero::ControlModel::library;
  if (library && !s.control.drive_train) return;
  const aero::ControllerOptions controller = library ? aero::ControllerOptions() : aero::read_controller(s.control.file);
  const aero::DriveTrainOptions train = library ? *s.control.drive_train : aero::DriveTrainOptions(controller);
  const double made = s.rotor.blade_pitch;
  if (const bool parked = s.control.start == aero::ControlStart::parked; parked && std::abs(train.feather - made) > 1e-6)
    document.problem("control.start", fmt::format("\"parked\" has the blades at feather, {:g} degrees; their grid is made at "
                                                  "rotor.blade_pitch_deg, {:g}: give that the same",
                                                  train.feather / degree, made / degree));
  for (std::size_t n = 0; n < s.control.events.size(); ++n) {
    const aero::EventOptions& event = s.control.events[n];
    if (event.what == aero::ControlEvent::blade_stuck) continue;
    const bool starts = event.what == aero::ControlEvent::start_up;
    const bool slow = !library && (starts || event.what == aero::ControlEvent::shut_down);
    const double rate = slow ? controller.stop_pitch_rate : train.max_pitch_rate;
    if (rate * (s.time.end_s - event.time_s) <= most || (!starts && train.feather - made <= most)) continue;
    document.problem(
        fmt::format("control.events[{}].what", n),
        fmt::format("pitches the blades {} feather, {:g} degrees, at {:g} degrees per second: their grid, made at "
                    "rotor.blade_pitch_deg = {:g}, follows within {:g} degrees. End the run {:.3g} s after the event "
                    "at most, or take another aero.model",
                    starts ? "from" : "to", train.feather / degree, rate / degree, made / degree, most / degree, most / rate));
  }
} catch (const scene::SceneError&) {  // told by check_control
}

/// Rules between [control] and resolved air that bodies carry.
void check_control_of_air(scene::Document& document, const Scenario& s) {
  if (s.control.model == aero::ControlModel::library && is_strong(s.coupling.scheme))
    document.problem("coupling.scheme",
                     "must be a loose one with a controller library (\"cps\", \"cps2\", \"css\"): it is called once after every "
                     "step of the bodies, and no window may be repeated");
  check_blades_of_their_own(document, s);
  if (has_resolved_rotor(s)) check_pitch_of_grid(document, s);
  try {
    if (!s.rotor.turbine.empty() && aero::read_turbine(s.rotor.turbine).polars.empty())
      document.problem("control.model",
                       "needs a rotor.turbine with polars: the controller begins settled on the torque of blade elements");
  } catch (const scene::SceneError&) {  // told by check_rotor
  }
}

/// Rules between resolved air and the bodies that carry its rotor.
void check_resolved_air(scene::Document& document, const Scenario& s) {
  if (s.aero.flow->time == "steady")
    document.problem("aero.flow.time", "must be \"bdf1\", \"bdf2\" or \"bdf3\" where bodies carry the rotor: it moves with them");
  if (s.coupling.scheme == SchemeKind::monolithic)
    document.problem("coupling.scheme", "must not be \"monolithic\": resolved air answers once per window; take \"cps2\"");
  if (s.has_actuator()) return check_carried_actuator(document, s);
  if (!has_resolved_rotor(s))
    return document.problem("bodies", "have no effect beside an air without a rotor: give [aero.grid], or leave them out");
  aero::RotorOptions rotor = s.rotor;
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint) rotor.axis = joint.axis, rotor.speed = 1.0;  // the bearing's motion gives the speed
  aero::check_resolved_rotor(document, s.aero, rotor, flow_wind(s), aero::wind_profile(s.wind));
  if (s.start.air_steps > 0 && rotor.axis.cross(flow_wind(s)).norm() > 1e-6 * rotor.axis.norm() * flow_wind(s).norm())
    document.problem("start.air_steps",
                     "needs the wind along the rotor's axis: seen from the turning rotor no other flow is steady");
}

}  // namespace

std::span<const scene::SectionBase* const> all_sections() {
  static const std::array<const scene::SectionBase*, 19> sections{&time_section(),           &environment_section(),
                                                                  &aero::wind_section(),     &aero::aero_section(),
                                                                  &aero::rotor_section(),    &aero::rotors_section(),
                                                                  &aero::control_section(),  &sea::sea_section(),
                                                                  &sea::waves_section(),     &bodies::body_section(),
                                                                  &bodies::joint_section(),  &bodies::beam_section(),
                                                                  &moorings::line_section(), &moorings::junction_section(),
                                                                  &coupling_section(),       &start_section(),
                                                                  &runtime_section(),        &output_section(),
                                                                  &checkpoint_section()};
  return sections;
}

Eigen::Vector3d flow_wind(const Scenario& s) {
  return s.wind.speed_m_s * aero::blowing(s.wind.direction, s.aero.flow ? s.aero.flow->incidence : 0.0);
}

double rotor_radius(const Scenario& s) {
  if (!s.rotor.turbine.empty()) return aero::read_turbine(s.rotor.turbine).planform.span.back();
  return s.rotor.diameter_m ? 0.5 * *s.rotor.diameter_m : 0.0;
}

PlacedRotor placed_rotor(const Scenario& s) {
  PlacedRotor placed{s.rotor, s.rotor_section + ".hub_m"};
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint) {
      placed.rotor.hub_m = bodies::point_of(joint, s.bodies), placed.rotor.axis = joint.axis;
      placed.hub_key = "joints." + name + ".point_m";
    }
  return placed;
}

aero::WindSite wind_site(const Scenario& s) {
  return {.hub = placed_rotor(s).rotor.hub_m, .diameter = 2.0 * rotor_radius(s), .t_end = s.time.end_s};
}

aero::ResolvedRotorSetup resolved_rotor_setup(const Scenario& s) {
  constexpr double usual_load_change = 1e-3;
  aero::FlowOptions flow = *s.aero.flow;
  if (!flow.load_change && flow.time == "steady" && flow.drop > 0.0) flow.load_change = usual_load_change;
  return {std::move(flow),
          *s.aero.grid,
          s.rotor,
          flow_wind(s),
          s.environment.air_density_kg_m3,
          s.aero.flow->time == "steady" ? 0.0 : s.time.window_s,
          aero::wind_profile(s.wind)};
}

std::vector<Scenario> by_rotor(const Scenario& s) {
  std::vector<Scenario> each;
  for (const auto& [name, rotor] : s.rotors) {
    each.push_back(s);
    each.back().rotor = rotor, each.back().rotor_section = "rotors." + name;
  }
  if (s.rotors.empty() && s.has_rotor()) each.push_back(s);
  return each;
}

std::vector<sea::SeaBody> sea_bodies(const bodies::NamedBodies& bodies) {
  std::vector<sea::SeaBody> result;
  for (const auto& [name, body] : bodies) {
    sea::SeaBody sea_body{.name = name, .initial = described_motion(body), .cylinders = {}};
    for (const bodies::CylinderOptions& c : body.cylinders) sea_body.cylinders.push_back({c.name, make_cylinder(c, body)});
    result.push_back(std::move(sea_body));
  }
  return result;
}

std::vector<sea::ParticleBody> particle_bodies(const bodies::NamedBodies& bodies) {
  std::vector<sea::ParticleBody> result;
  for (const auto& [name, body] : bodies) {
    sea::ParticleBody particle_body{.name = name, .mass = body.mass_kg, .described = described_motion(body), .shapes = {}};
    for (const bodies::CylinderOptions& c : body.cylinders) particle_body.shapes.push_back(make_cylinder(c, body));
    for (const bodies::BoxOptions& b : body.boxes) particle_body.shapes.push_back(make_box(b, body));
    for (const bodies::SphereOptions& s : body.spheres) particle_body.shapes.push_back(make_sphere(s, body));
    for (const scene::MeshOptions& m : body.meshes)
      if (m.surface) particle_body.shapes.push_back(make_mesh(m, body));
    result.push_back(std::move(particle_body));
  }
  return result;
}

sea::SeaEnvironment sea_environment(const EnvironmentOptions& environment) {
  return {environment.water_density_kg_m3, environment.water_depth_m, environment.gravity_m_s2};
}

Scenario read_scenario(scene::Document& document) {
  add_rotor_defaults(document);
  Scenario s;
  s.source = document.source();
  s.time = document.read(time_section());
  s.environment = document.read(environment_section());
  s.aero = document.read(aero::aero_section());
  if (s.resolves_air() && !s.aero.flow) s.aero.flow.emplace();  // its absence is told; the rules below look at it
  s.bodies = document.read_named(bodies::body_section());
  s.joints = document.read_named(bodies::joint_section());
  s.beams = document.read_named(bodies::beam_section());
  s.rotors = document.read_named(aero::rotors_section());
  s.rotor =
      document.read_where(s.rotors.empty() && (s.has_rotor() || has_resolved_rotor(s) || s.has_actuator()), aero::rotor_section(),
                          s.rotors.empty() ? "aero.model is none" : "[rotors] has the rotors; give one of the two", "aero.model");
  if (!s.rotors.empty()) {
    s.rotor = s.rotors.front().options, s.rotor_section = "rotors." + s.rotors.front().name;
    if (s.aero.model == "none") document.problem("rotors", "has no effect: aero.model is none", "aero.model");
    if (s.resolves_air())
      document.problem("rotors",
                       fmt::format("does not go with aero.model \"{}\": resolved air has one rotor, in [rotor]; prescribed, "
                                   "thrust_curve and bem have several",
                                   s.aero.model));
  }
  s.wind = document.read_where(
      s.aero.model == "thrust_curve" || s.aero.model == "bem" || s.resolves_air(), aero::wind_section(),
      "aero.model = \"" + s.aero.model + "\" does not look at the wind; thrust_curve, bem and resolved air do", "aero.model");
  try {
    const double given = s.wind.speed_m_s;  // 0 where it is left out, also in the scene as it ran; so is the direction
    if (s.wind.direction != 0.0 && aero::has_directions(s.wind))
      document.problem("wind.direction_deg", "has no effect: the table has a column of this name");
    s.wind.speed_m_s = aero::starting_speed(s.wind), s.wind.direction = aero::starting_direction(s.wind);
    if (given > 0.0 && std::abs(given - s.wind.speed_m_s) > 0.01 * s.wind.speed_m_s)
      document.problem("wind.speed_m_s", fmt::format("has no effect: {} begins with {:.4g} m/s; leave this out",
                                                     s.wind.table.empty() ? "the .bts file" : "the table", s.wind.speed_m_s));
    if (s.resolves_air()) s.wind.incidence = s.aero.flow->incidence;
    if (!s.wind.steady() && s.resolves_air()) check_changing_wind(document, s);
    if (s.has_actuator()) check_wind_over_ground(document, s);
    if (s.wind.turbulence && s.wind.turbulence->inflow_plane_m && !s.resolves_air())
      document.problem("wind.turbulence.inflow_plane_m", "has no effect on blade elements, which take the box as it is");
  } catch (const scene::SceneError& e) {
    document.problem(s.wind.table.empty() ? "wind.turbulence.file" : "wind.table", e.what());
  }
  s.control = document.read_where(
      s.has_rotor(), aero::control_section(),
      s.resolves_air() ? "without [bodies] the rotor turns as rotor.speed_rpm has it: a drive train steps with them"
                       : "aero.model is none",
      "aero.model");
  take_from_turbines(document, s);
  s.sea = document.read(sea::sea_section());
  const bool planar = s.sea.particles && s.sea.particles->planar();
  const auto plane = [planar](double y) { return planar ? std::optional(y) : std::nullopt; };
  for (auto& [name, body] : s.bodies)
    load_surfaces(document, fmt::format("bodies.{}.meshes", name), body.meshes, plane(body.centre_m[1]));
  if (s.sea.tank) load_surfaces(document, "sea.tank.meshes", s.sea.tank->meshes, plane(0.0));
  s.waves = document.read_where(s.sea.model == "morison" || s.sea.model == "potential" || s.has_particles(), sea::waves_section(),
                                "sea.model is \"" + s.sea.model + "\"; morison, potential and sph have waves", "sea.model");
  if (s.has_given_waves() && !s.waves.ramp_s) s.waves.ramp_s = sea::growth_time(s.waves);
  s.moorings = document.read_named(moorings::line_section());
  s.junctions = document.read_named(moorings::junction_section());
  s.coupling = document.read_where(
      s.has_rotor(), coupling_section(),
      (s.resolves_air() ? "without [bodies]" : "aero.model is none,") + std::string(" there are no two parts to couple"),
      "aero.model");
  s.start = document.read(start_section());
  s.runtime = document.read(runtime_section());
  s.output = document.read(output_section());
  s.checkpoint = document.read(checkpoint_section());

  check_names(document, s);
  check_saved_start(document, s);
  if (has_resolved_rotor(s) && s.aero.flow->wall_distance == "poisson")
    document.problem("aero.flow.wall_distance",
                     "\"poisson\" is for grids that stand: with a resolved rotor it must be \"exact\"");
  if (!(s.has_rotor() && s.resolves_air()) && s.start.air_steps > 0)
    document.problem("start.air_steps", "has no effect: there is no rotor in resolved air on a body");
  for (const auto& [key, given] :
       {std::pair{"start.air", !s.start.air.empty()}, std::pair{"output.air_interval_s", s.output.air_interval_s.has_value()}})
    if (!(s.has_rotor() && s.resolves_air()) && given)
      document.problem(key, "has no effect: there is no resolved rotor on a body");
  if (!s.has_rotor() && s.start.ramp_s > 0.0)
    document.problem("start.ramp_s",
                     s.resolves_air() ? "has no effect: there are no [bodies]" : "has no effect: aero.model is none",
                     "aero.model");
  if (s.resolves_air() && s.aero.grid && s.aero.flow->motion)
    document.problem("aero.flow.motion", "has no effect: the grid of a rotor goes with the rotor");
  if (s.has_flow()) {
    const std::string bodiless = "has no effect: there are no [bodies], and the air takes a step in each time.window_s";
    if (s.time.step_s) document.problem("time.step_s", bodiless);
    if (s.time.integrator != TimeOptions().integrator) document.problem("time.integrator", bodiless);
    if (s.has_actuator()) check_standing_actuator(document, s);
    if (has_resolved_rotor(s)) aero::check_resolved_rotor(document, s.aero, s.rotor, flow_wind(s), aero::wind_profile(s.wind));
    if (has_resolved_rotor(s) && !s.rotor.joint.empty()) document.problem("rotor.joint", "has no effect: there are no [bodies]");
    if (has_resolved_rotor(s) && !s.rotor.body.empty()) document.problem("rotor.body", "has no effect: there are no [bodies]");
    const std::string alone = "without [bodies] the scene is one of air alone";
    for (const auto& [key, given] : {std::pair{"beams", !s.beams.empty()}, std::pair{"joints", !s.joints.empty()},
                                     std::pair{"moorings", !s.moorings.empty()}, std::pair{"junctions", !s.junctions.empty()},
                                     std::pair{"sea", s.has_sea()}})
      if (given) document.problem(key, "has no effect: " + alone);
    if (s.start.equilibrium) document.problem("start.equilibrium", "has no effect: " + alone);
    if (has_resolved_rotor(s) || s.has_actuator()) aero::check_blade_keys(document, s.aero, s.rotor, s.rotor_section);
    if (!has_resolved_rotor(s)) check_flows(document, s.wind);
    document.finish();
    return s;
  }
  if (s.resolves_air()) check_resolved_air(document, s);
  if (s.coupling.scheme == SchemeKind::automatic)
    s.coupling.scheme = s.resolves_air() ? SchemeKind::cps2 : SchemeKind::monolithic;
  check_coupling(document, s.coupling, s.time);
  check_bodies(document, s.bodies, s.joints, s.has_particles());
  check_beams(document, s.beams, s.bodies);
  for (const auto& [name, body] : s.bodies)
    for (const auto& [shapes, any] : {std::pair{"boxes", !body.boxes.empty()}, std::pair{"spheres", !body.spheres.empty()},
                                      std::pair{"meshes", !body.meshes.empty()}})
      if (!s.has_particles() && any)
        document.problem(fmt::format("bodies.{}.{}", name, shapes),
                         "has no effect: only sea.model = \"sph\" knows this shape, others cylinders", "sea.model");
  const std::vector<std::string> bodies = names(s.bodies), joints = names(s.joints);
  check_lines(document, s.moorings, s.junctions, bodies, s.environment.water_density_kg_m3);
  place_at_junctions(s.moorings, s.junctions, s.environment.water_depth_m);
  check_bathymetry(document, s);
  if (s.has_rotor())
    for (const Scenario& one : by_rotor(s)) check_rotor(document, s.aero, one.rotor, bodies, joints, one.rotor_section);
  if (!s.rotors.empty() && !s.resolves_air()) check_rotors(document, s);
  for (std::size_t n = 0; n < s.control.events.size(); ++n)
    if (s.rotors.empty() && s.control.events[n].rotor)
      document.problem(fmt::format("control.events[{}].rotor", n), "has no effect: there is one rotor, in [rotor]");
  if (!s.rotor.blade_structure.empty() && s.coupling.scheme != SchemeKind::monolithic)
    document.problem("coupling.scheme",
                     "must be \"monolithic\" with rotor.blade_structure: blades that bend step with the bodies");
  if (s.control.yaw) check_yaw(document, s);
  if (s.is_controlled() && s.resolves_air())
    check_control_of_air(document, s);
  else if (s.is_controlled() && s.coupling.scheme != SchemeKind::monolithic)
    document.problem("coupling.scheme",
                     s.control.model == aero::ControlModel::library
                         ? "must be \"monolithic\" with a controller library: it is called once after every accepted step of the "
                           "bodies, and no window may be repeated"
                         : "must be \"monolithic\" with [control]: the controller steps with the bodies");
  if ((s.aero.dynamic_inflow != "none" || s.aero.dynamic_stall != "none") && s.coupling.scheme != SchemeKind::monolithic)
    document.problem("coupling.scheme",
                     "must be \"monolithic\" with aero.dynamic_inflow or aero.dynamic_stall: the flow steps with the bodies");
  const auto report = [&](const std::vector<sea::OptionProblem>& problems) {
    for (const sea::OptionProblem& p : problems) document.problem(p.key, p.what, p.follows_from);
  };
  const std::vector<sea::SeaBody> wetted = sea_bodies(s.bodies);
  report(sea_problems(s.sea, s.waves, wetted));
  if (s.has_sea() && s.moorings.empty() && s.junctions.empty() &&
      std::ranges::all_of(wetted, [](const sea::SeaBody& b) { return b.cylinders.empty(); }))
    for (const auto& [key, given] : {std::pair{"sea.current_m_s", !s.sea.current_m_s.isZero(0.0)},
                                     std::pair{"sea.current_profile", !s.sea.current_profile.empty()}})
      if (given) document.problem(key, "has no effect: no body has [[bodies.NAME.cylinders]], and there are no [moorings]");
  if (s.has_sea() && !s.has_particles()) report(shape_problems(sea_environment(s.environment), wetted));
  check_gauge_names(document, s);
  if (s.has_particles() && s.sea.particles && s.sea.tank) check_particles(document, s);
  if (s.has_waves()) report(wave_problems(s.waves, sea_environment(s.environment)));
  document.finish();
  return s;
}

std::string describe_bodies(const Scenario& s) {
  if (s.bodies.empty()) return "none";
  std::string text = fmt::format("{} ({})", s.bodies.size(), fmt::join(names(s.bodies), ", "));
  if (!s.joints.empty()) text += fmt::format(", joints: {}", fmt::join(names(s.joints), ", "));
  if (!s.beams.empty()) text += fmt::format(", beams: {}", fmt::join(names(s.beams), ", "));
  return text;
}

std::string describe_rotor(const Scenario& s) {
  std::string text;
  if (has_resolved_rotor(s) || s.has_actuator())
    text = fmt::format("{}, {}{}", s.aero.model, s.rotor.turbine, s.bodies.empty() ? "" : ", on body " + s.rotor.body);
  else if (s.has_rotor())
    text = fmt::format("{} on body {}{}", s.aero.model, s.rotor.body, s.rotor.sense() < 0.0 ? ", turning counter-clockwise" : "");
  else
    return "none";
  if (s.rotor.operating_point == "table")
    text += fmt::format(", {:.4g} rpm and blade pitch {:.4g} deg of its operating table", s.rotor.speed / rad_s_per_rpm,
                        s.rotor.blade_pitch / radians_per_degree);
  if (s.control.model == aero::ControlModel::library)
    text += fmt::format(", controlled by the library {}", s.control.library);
  else if (s.is_controlled())
    text += fmt::format(", controlled by {} ({}{})", s.control.file,
                        s.control.tuning == aero::Tuning::floating ? "floating gains" : "gains of a fixed foundation",
                        s.control.events.empty() ? "" : fmt::format(", {} events", s.control.events.size())) +
            (s.control.peak_shaving ? fmt::format(", peak shaving to {:g} of the largest thrust", *s.control.peak_shaving) : "");
  if (s.control.yaw) text += fmt::format(", turned into the wind at {}", s.control.yaw->joint);
  return text;
}

std::string describe_sea(const Scenario& s) {
  if (!s.has_sea()) return "none";
  if (s.has_particles()) {
    std::string text = fmt::format("particles in {}-D, spacing {} m{}", s.sea.particles->dimensions, s.sea.particles->spacing_m,
                                   s.sea.tank->symmetric() ? ", half of what is symmetrical about its lower y" : "");
    if (s.sea.wavemaker)
      text += fmt::format(", {} making {} waves (H {} m, T {} s)", s.sea.wavemaker->type, s.waves.model, s.waves.height_m,
                          s.waves.period_s);
    return text;
  }
  std::size_t cylinders = 0;
  for (const auto& body : s.bodies) cylinders += body.options.cylinders.size();
  std::string text = fmt::format("{}, {} cylinder{}", s.sea.model, cylinders, cylinders == 1 ? "" : "s");
  text += !s.has_waves()         ? ", calm"
          : s.waves.file.empty() ? fmt::format(", waves {} (H {} m, T {} s)", s.waves.model, s.waves.height_m, s.waves.period_s)
                                 : fmt::format(", waves of {}", s.waves.file);
  if (s.has_waves() && s.waves.second_order) text += " to second order";
  if (s.waves.ramp_s.value_or(0.0) > 0.0) text += fmt::format(", growing over {:g} s", *s.waves.ramp_s);
  return text;
}

std::string describe_moorings(const Scenario& s) {
  if (s.moorings.empty()) return "none";
  std::set<std::string> models;
  for (const auto& line : s.moorings) models.insert(line.options.model);
  std::string text = fmt::format("{} line{} ({})", s.moorings.size(), s.moorings.size() == 1 ? "" : "s", fmt::join(models, ", "));
  if (!s.junctions.empty())
    text += fmt::format(", {} junction{} ({})", s.junctions.size(), s.junctions.size() == 1 ? "" : "s",
                        fmt::join(names(s.junctions), ", "));
  return text;
}

}  // namespace spindrift::coupling
