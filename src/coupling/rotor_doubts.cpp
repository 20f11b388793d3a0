// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/rotor_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/aero/bem.hpp"
#include "src/aero/blade_roots.hpp"
#include "src/aero/control_doubts.hpp"
#include "src/aero/doubts.hpp"
#include "src/aero/flexible_blades.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/turbine_doubts.hpp"
#include "src/aero/wind.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/flow_scene.hpp"

namespace spindrift::coupling {

namespace {

/// Blades in resolved air move by their own length of cells in a window, not by a sector.
void doubt_turn(scene::Doubts& doubts, const Scenario& s, double speed) {
  constexpr double most = 12.0;
  if (!s.resolves_air() || s.aero.flow->time == "steady" || s.aero.model == "actuator_disc") return;
  if (const double turn = std::abs(speed) * s.time.window_s / radians_per_degree; turn > most)
    doubts.push_back({"time.window_s", fmt::format("{:.4g} s, in which the rotor turns by {:.3g} degrees", s.time.window_s, turn),
                      fmt::format("up to {:g} degrees", most), "shorten it: a window is a step of the flow"});
}

/// A rotor that hardly turns in the run.
void doubt_run_of_rotor(scene::Doubts& doubts, const Scenario& s, double speed) {
  constexpr double least = 0.25;
  if (s.resolves_air() && s.aero.flow->time == "steady") return;
  if (const double turns = std::abs(speed) * s.time.end_s / (2.0 * pi); turns > 0.0 && turns < least)
    doubts.push_back({"time.end_s", fmt::format("{:.4g} s, in which the rotor makes {:.2g} of a turn", s.time.end_s, turns),
                      "a quarter of a turn at least", "look at its unit: s"});
}

/// The scene's key that gives the rotor its speed at the start.
std::string speed_key(const Scenario& s) {
  if (s.rotor.operating_point == "table") return "rotor.operation";
  if (s.rotor.joint.empty()) return "rotor.speed_rpm";
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint && joint.rotation) return "joints." + name + ".rotation.speed_rpm";
  return s.is_controlled() && !s.rotor.operation.empty() ? "rotor.operation" : "bodies." + s.rotor.body;
}

/// Cells over an actuator's rotor.
void doubt_cells(scene::Doubts& doubts, const Scenario& s, double radius) {
  if (!s.has_actuator() || !s.aero.flow->generate || s.aero.flow->generate->kind != "stretched_box" || radius <= 0.0) return;
  const aero::GenerateOptions& grid = *s.aero.flow->generate;
  const Eigen::Vector3d hub = placed_rotor(s).rotor.hub_m;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double outer = 0.9;
    const double reach = axis == 0 ? 0.0 : outer * radius;
    if (std::abs(std::sin(s.wind.direction)) > 0.1) break;  // across the box
    if (const auto d = std::size_t(axis); hub[axis] - reach < grid.core_low_m[d] || hub[axis] + reach > grid.core_high_m[d])
      doubts.push_back({"aero.flow.generate.core_low_m",
                        fmt::format("a core from {:.4g} to {:.4g} m along {} where the rotor goes from {:.4g} to {:.4g} m",
                                    grid.core_low_m[d], grid.core_high_m[d], "xyz"[axis], hub[axis] - reach, hub[axis] + reach),
                        "the rotor in the core, beyond which cells grow", "look at the core's corners and at the hub"});
  }
  if (const double cell = grid.cell_m; cell > 0.25 * radius)
    doubts.push_back({"aero.flow.generate.cell_m", fmt::format("{:.4g} m for blades of {:.4g} m", cell, radius),
                      "up to a quarter of the radius; a tenth is usual", "the rotor falls between the cells"});
}

double gyration(const bodies::BodyOptions& body, const Eigen::Vector3d& axis) {
  return std::sqrt(std::max(0.0, axis.dot(body.inertia_kg_m2 * axis)) / body.mass_kg);
}

/// The largest about an axis square to this one.
double gyration_across(const bodies::BodyOptions& body, const Eigen::Vector3d& axis) {
  double most = 0.0;
  const Eigen::Vector3d first = axis.unitOrthogonal(), second = axis.cross(first);
  constexpr int directions = 12;  // of half a turn
  for (int n = 0; n < directions; ++n) {
    const double angle = pi * n / directions;
    most = std::max(most, gyration(body, std::cos(angle) * first + std::sin(angle) * second));
  }
  return most;
}

/// What blades have at least where no key has their length: none of a rotor's mass is farther out than its tips, and the area
/// that they sweep gives up to 600 W/m2.
double least_radius(const Scenario& s) {
  constexpr double most_W_m2 = 600.0;
  double least = 0.0;
  if (!s.rotor.joint.empty())
    for (const auto& [name, body] : s.bodies)
      if (name == s.rotor.body) least = gyration(body, placed_rotor(s).rotor.axis.normalized());
  if (s.rotor.operation.empty()) return least;
  const aero::Operation table = aero::read_operation(s.rotor.operation);
  return table.power.empty() ? least : std::max(least, std::sqrt(std::ranges::max(table.power) / (pi * most_W_m2)));
}

/// The body that turns with the rotor, where a bearing of its own carries it.
void doubt_rotor_body(scene::Doubts& doubts, const Scenario& s, const aero::RotorAtStart& rotor) {
  if (s.rotor.joint.empty()) return;
  const aero::RotorOptions placed = placed_rotor(s).rotor;
  for (const auto& [name, body] : s.bodies) {
    if (name != s.rotor.body) continue;
    const Eigen::Vector3d axis = placed.axis.normalized();
    aero::RotorAtStart described = rotor;
    described.hub = placed.hub_m, described.axis = axis;
    append(doubts,
           rotor_body_doubts({"bodies." + name, body.centre_m, gyration(body, axis), gyration_across(body, axis)}, described));
  }
}

/// Where a body carries its rotor: beside its shapes, or its centre of mass, by no more than the arms of multi-rotor floaters.
void doubt_place(scene::Doubts& doubts, const Scenario& s, double radius) {
  constexpr double most = 4.0;  // radii
  if (radius <= 0.0) return;
  const PlacedRotor placed = placed_rotor(s);
  for (const auto& [name, body] : s.bodies) {
    if (name != s.rotor.body) continue;
    Eigen::AlignedBox3d box = bodies::bounds(body);
    box.extend(body.centre_m);
    const Eigen::Vector3d& hub = placed.rotor.hub_m;
    const double aside = std::sqrt(box.squaredExteriorDistance(Eigen::Vector3d(hub.x(), hub.y(), box.center().z())));
    if (aside > most * radius)
      doubts.push_back({placed.hub_key, fmt::format("the hub is {:.4g} m aside of body {}", aside, name),
                        fmt::format("up to {:.4g} m, {:g} times the blades' length", most * radius, most),
                        "look at x and y and their unit, m, and at the place of the body"});
  }
}

/// Blades of any size swing with tips of some 40 m/s per radian of bending: 0.6 Hz at 89 m, 8 Hz at 5 m.
void doubt_bending(scene::Doubts& doubts, const RotorSource& rotor) {
  constexpr double least = 5.0, most = 500.0;
  const aero::FlexibleBlades* blades = rotor.loads.flexible();
  if (!blades || rotor.radius <= 0.0) return;
  const double frequency = blades->omega_turning(0.0).front() / (2.0 * pi), product = frequency * rotor.radius;
  if (product < least || product > most)
    doubts.push_back({"rotor.blade_structure",
                      fmt::format("a first frequency of {:.3g} Hz for blades of {:.4g} m", frequency, rotor.radius),
                      fmt::format("{:.2g} to {:.2g} Hz for that length", least / rotor.radius, most / rotor.radius),
                      "look at the units of its columns: kg/m, N m2"});
}

/// A rotor that loads nothing that floats: joints and beams do not lead from its body to any with shapes.
void doubt_separate(scene::Doubts& doubts, const Scenario& s) {
  if (!s.has_sea() || s.rotor.body.empty()) return;
  std::set<std::string> joined{s.rotor.body};
  for (std::size_t before = 0; before != joined.size();) {
    before = joined.size();
    const auto join = [&](const std::vector<std::string>& both) {
      for (const std::string& one : both)
        if (one != "earth" && joined.contains(one))
          for (const std::string& other : both)
            if (other != "earth") joined.insert(other);
    };
    for (const auto& joint : s.joints) join(joint.options.bodies);
    for (const auto& beam : s.beams) join(beam.options.bodies);
  }
  const auto has_shapes = [](const auto& body) { return bodies::extent(body.options) > 0.0; };
  const auto floats_apart =
      std::ranges::find_if(s.bodies, [&](const auto& b) { return has_shapes(b) && !joined.contains(b.name); });
  const bool carried = std::ranges::any_of(s.bodies, [&](const auto& b) { return has_shapes(b) && joined.contains(b.name); });
  if (!carried && floats_apart != s.bodies.end())
    doubts.push_back(
        {"rotor.body", fmt::format("no joint leads from {} to {} or another body in the water", s.rotor.body, floats_apart->name),
         "a rotor on what floats", "it moves without the rotor's weight and load; look at the bodies of the joints"});
}

}  // namespace

scene::Doubts rotor_doubts(const Scenario& s, const RotorSource& of, const Start& start, double carried) {
  scene::Doubts doubts;
  const aero::RotorState now = of.loads.state(0.0, start.state.motions);
  aero::RotorAtStart rotor{
      .hub = now.hub, .axis = now.axis, .speed = now.speed, .speed_key = speed_key(s), .over_water = s.has_sea()};
  rotor.parked = s.is_controlled() && s.control.start == aero::ControlStart::parked;
  rotor.radius = of.radius;
  if (rotor.radius == 0.0) rotor.least_radius = least_radius(s);
  if (s.aero.model != "blade_resolved") rotor.reynolds = of.loads.reynolds(0.0, now);
  if (const aero::RotorLoad load = of.loads.load(0.0, now); s.resolves_air()) {  // by blade elements
    if (load.torque != 0.0) rotor.thrust = load.thrust, rotor.power = load.power;
  } else {
    rotor.thrust = load.thrust;
    if (s.aero.model == "bem" || load.torque != 0.0) rotor.power = load.power;
    if (carried > 0.0 && std::abs(load.thrust) > 0.5 * carried)
      doubts.push_back({"aero", fmt::format("a thrust of {:.3g} N at the start", load.thrust),
                        fmt::format("up to half the weight of all bodies, {:.3g} N", carried), "look at its unit: N, not kN"});
    else if (s.aero.model == "prescribed" && load.thrust < 0.0)
      doubts.push_back({"aero", fmt::format("a thrust of {:.3g} N at the start, against the rotor's axis", load.thrust),
                        "above zero: the air pushes the rotor downwind", "look at the signs of the thrust and of the axis"});
    else if (constexpr double least = 1e-4;
             carried > 0.0 && s.aero.model == "prescribed" && load.thrust != 0.0 && std::abs(load.thrust) < least * carried)
      doubts.push_back({"aero", fmt::format("a thrust of {:.3g} N at the start", load.thrust),
                        fmt::format("{:g} of the weight of all bodies, {:.3g} N, at least", least, carried),
                        "look at its unit: N, not kN"});
  }
  append(doubts, aero::rotor_doubts(s.aero, placed_rotor(s).rotor, s.wind, s.environment.air_density_kg_m3, rotor));
  doubt_separate(doubts, s);
  doubt_place(doubts, s, rotor.radius);
  doubt_bending(doubts, of);
  append(doubts, aero::control_doubts(s.control, s.aero.curve));
  doubt_rotor_body(doubts, s, rotor);
  doubt_turn(doubts, s, rotor.speed);
  doubt_cells(doubts, s, rotor.radius);
  doubt_run_of_rotor(doubts, s, rotor.speed);
  return doubts;
}

scene::Doubts rotor_file_doubts(const Scenario& s, std::set<std::string>& told) {
  scene::Doubts doubts;
  const auto first = [&](const std::string& file) { return !file.empty() && told.insert(file).second; };
  if (first(s.rotor.turbine)) append(doubts, aero::turbine_doubts(s.rotor.turbine));
  if (!s.rotor.turbine.empty()) {
    const auto masses = [&](const char* key, const std::string& file, auto read) {
      if (!first(file)) return;
      const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
      append(doubts, aero::blade_mass_doubts(std::string("rotor.") + key, turbine, read(turbine, file)));
    };
    masses("blade_masses", s.rotor.blade_masses, aero::read_blade_masses);
    masses("blade_structure", s.rotor.blade_structure, [](const aero::Turbine& turbine, const std::string& file) {
      return aero::read_blade_structure(turbine, file).masses;
    });
  }
  if (first(s.rotor.operation)) {
    append(doubts, aero::operation_doubts(s.rotor.operation, rotor_radius(s)));
    if (!s.rotor.turbine.empty() && doubts.empty()) append(doubts, aero::chord_doubts(s.rotor.turbine, s.rotor.operation));
  }
  if (s.control.model == aero::ControlModel::dtu && first(s.control.file))
    append(doubts, aero::controller_doubts(s.control.file, rotor_radius(s)));
  return doubts;
}

std::optional<aero::RotorLoad> standing_rotor_load(const Scenario& s) {
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  if (turbine.polars.empty()) return std::nullopt;
  const aero::RotorOptions rotor = placed_rotor(s).rotor;
  const Eigen::Vector3d axis = rotor.axis.normalized();
  const aero::BladeElementMomentum elements(turbine, "madsen", s.environment.air_density_kg_m3);
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - axis.z() * axis;
  up = up.norm() < 1e-6 ? Eigen::Vector3d::UnitX() : up.normalized();
  const aero::DiscLoad load = elements(aero::wind_of(s.wind, wind_site(s)), {Eigen::Vector3d::Zero(), rotor.speed * axis, axis,
                                                                             up, rotor.azimuth, rotor.blade_pitch, rotor.hub_m});
  const double torque = load.moment.dot(axis);
  return aero::RotorLoad{load.force.dot(axis), torque, torque * rotor.speed, torque, load.force, load.moment};
}

scene::Doubts standing_rotor_doubts(const Scenario& s) {
  const aero::RotorOptions rotor = placed_rotor(s).rotor;
  aero::RotorAtStart start{
      .hub = rotor.hub_m, .axis = rotor.axis, .speed = rotor.speed, .speed_key = speed_key(s), .radius = rotor_radius(s)};
  if (const std::optional<aero::RotorLoad> load = standing_rotor_load(s)) start.thrust = load->thrust, start.power = load->power;
  scene::Doubts all = aero::rotor_doubts(s.aero, rotor, s.wind, s.environment.air_density_kg_m3, start);
  std::set<std::string> told;
  append(all, rotor_file_doubts(s, told));
  doubt_turn(all, s, rotor.speed);
  doubt_cells(all, s, start.radius);
  return all;
}

scene::Doubts lean_doubts(const FloatingSystem& floating, const aero::RotorLoads& rotor, const Start& start) {
  scene::Doubts doubts;
  constexpr double most = 0.03, near = 0.3;
  const aero::RotorState now = rotor.state(0.0, start.state.motions);
  const double thrust = std::abs(rotor.load(0.0, now).thrust);
  for (const auto& [name, beam] : floating.scenario().beams) {
    const double length = (beam.end_m - beam.start_m).norm();
    if ((now.hub - beam.end_m).norm() > near * length) continue;
    const beam::Properties p = read_properties(beam);
    double lean = 0.0;
    for (std::size_t n = 1; n < p.position.size(); ++n) {
      const double step = p.position[n] - p.position[n - 1], arm = length - 0.5 * (p.position[n] + p.position[n - 1]);
      lean += thrust * arm * arm * step / (0.5 * (p.bending_x[n] + p.bending_x[n - 1]));
    }
    if (lean > most * length)
      doubts.push_back({"beams." + name,
                        fmt::format("the thrust of {:.3g} kN bends its end by {:.3g} m, {:.2g} % of its length", 1e-3 * thrust,
                                    lean, 100.0 * lean / length),
                        fmt::format("up to {:g} %: steel yields there", 100.0 * most),
                        "look at the units of its properties and moduli, and whether diameters are radii"});
  }
  return doubts;
}

scene::Doubts wake_doubts(const FloatingSystem& floating, const Start& start) {
  scene::Doubts doubts;
  constexpr double spreading = 0.1, reach = 20.0;  // diameters behind which a wake has mostly recovered
  const std::vector<Scenario> each = by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n)
    for (std::size_t m = 0; m < each.size(); ++m) {
      if (m == n) continue;
      const RotorSource &rotor = floating.rotors()[n], &other = floating.rotors()[m];
      const aero::RotorState at = rotor.loads.state(0.0, start.state.motions),
                             ahead = other.loads.state(0.0, start.state.motions);
      const Eigen::Vector3d from = at.hub - ahead.hub;
      if (n > m && from.norm() < rotor.radius + other.radius && std::abs(from.dot(at.axis)) < 0.1 * rotor.radius)
        doubts.push_back(
            {each[n].rotor_section,
             fmt::format("hubs of {} and {} are {:.4g} m apart", each[m].rotor_section, each[n].rotor_section, from.norm()),
             fmt::format("more than {:.4g} m, the two radii together", rotor.radius + other.radius),
             "blades would meet: look at the hubs' places"});
      const Eigen::Vector3d wind = rotor.loads.wind().at(0.0, ahead.hub);
      if (floating.scenario().aero.model == "prescribed" || wind.norm() == 0.0) continue;
      const double behind = from.dot(wind.normalized()), aside = (from - behind * wind.normalized()).norm();
      if (behind > 0.5 * other.radius && behind < 2.0 * reach * other.radius &&
          aside < rotor.radius + other.radius + spreading * behind)
        doubts.push_back({each[n].rotor_section,
                          fmt::format("{:.4g} m behind {} in the wind, {:.4g} m aside: in its wake, which is not modelled",
                                      behind, each[m].rotor_section, aside),
                          fmt::format("more than {:.4g} m aside there", rotor.radius + other.radius + spreading * behind),
                          "each rotor meets the undisturbed wind: its thrust and power are those without the other"});
    }
  return doubts;
}

}  // namespace spindrift::coupling
