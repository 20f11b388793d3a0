// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/rigid/rotation.hpp"
#include "src/aero/doubts.hpp"
#include "src/aero/operation.hpp"
#include "src/bodies/doubts.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/rotor_doubts.hpp"
#include "src/moorings/bed_file.hpp"
#include "src/moorings/doubts.hpp"
#include "src/moorings/model.hpp"
#include "src/scene/columns.hpp"
#include "src/sea/doubts.hpp"

namespace spindrift::coupling {

namespace {

double weight(const FloatingSystem& floating) {
  double mass = 0.0;
  for (const auto& body : floating.scenario().bodies) mass += body.options.mass_kg;
  for (const bodies::Beam& beam : floating.beams())
    for (const beam::Station& share : beam.link.stations) mass += share.mass;
  return mass * std::abs(floating.scenario().environment.gravity_m_s2);
}

double volume(const bodies::BodyOptions& body) {
  double sum = 0.0;
  for (const bodies::CylinderOptions& c : body.cylinders) sum += make_cylinder(c, body).volume();
  for (const bodies::BoxOptions& b : body.boxes) sum += make_box(b, body).volume();
  for (const bodies::SphereOptions& s : body.spheres) sum += make_sphere(s, body).volume();
  for (const scene::MeshOptions& m : body.meshes) sum += m.surface->volume();
  return sum;
}

/// Units of surfaces of triangles, which a file does not tell: what they displace against the body's mass.
void doubt_meshes(scene::Doubts& doubts, const Scenario& s) {
  constexpr double most = 1e3;
  const auto doubt_surface = [&](const std::string& key, const ClosedSurface& surface) {
    if (surface.was_inside_out())
      doubts.push_back({key, "all facets run clockwise seen from outside", "counter-clockwise",
                        "they are turned; look whether it is the surface that you mean"});
    if (const auto crossing = surface.crossing())
      doubts.push_back(
          {key,
           fmt::format("facets {} and {} cut through each other at ({:.4g}, {:.4g}, {:.4g}) m", surface.facet(crossing->first),
                       surface.facet(crossing->second), crossing->place[0], crossing->place[1], crossing->place[2]),
           "parts that do not overlap", "what two of them enclose counts twice: unite them, or give each a file of its own"});
  };
  if (s.sea.tank)
    for (std::size_t n = 0; n < s.sea.tank->meshes.size(); ++n)
      doubt_surface(fmt::format("sea.tank.meshes[{}].file", n), *s.sea.tank->meshes[n].surface);
  for (const auto& [name, body] : s.bodies)
    for (std::size_t n = 0; n < body.meshes.size(); ++n) {
      const ClosedSurface& surface = *body.meshes[n].surface;
      const double displaced = s.environment.water_density_kg_m3 * surface.volume(), ratio = displaced / body.mass_kg;
      const Eigen::Vector3d size = surface.box().sizes();
      const std::string key = fmt::format("bodies.{}.meshes[{}].scale", name, n);
      if (ratio > most || ratio < 1.0 / most)
        doubts.push_back(
            {key,
             fmt::format("{:g}: {:.4g} x {:.4g} x {:.4g} m, which displace {:.4g} kg of water where the body has {:.4g} kg",
                         body.meshes[n].scale, size[0], size[1], size[2], displaced, body.mass_kg),
             "a shape that fits the mass", "an STL file has no unit: 0.001 for one in millimetres"});
      doubt_surface(fmt::format("bodies.{}.meshes[{}].file", name, n), surface);
    }
}

/// A body that the water does not touch at the start, and that nothing else carries: it falls, and no engineering sea has the
/// slam.
void doubt_above_water(scene::Doubts& doubts, const Scenario& s, const std::string& name, const bodies::Reach& reach) {
  if (s.has_particles() || reach.low <= 0.0 || s.environment.gravity_m_s2 == 0.0) return;
  const auto ties = [&name = name](const auto& tie) {
    return std::ranges::find(tie.options.bodies, name) != tie.options.bodies.end();
  };
  const bool moored = std::ranges::any_of(
      s.moorings, [&](const auto& line) { return line.options.body == name || line.options.anchor_body == name; });
  const bool by_matrices = std::ranges::any_of(s.sea.matrices, [&](const auto& m) { return m.body == name; }) ||
                           (s.sea.potential && s.sea.potential->body == name);
  if (moored || by_matrices || std::ranges::any_of(s.joints, ties) || std::ranges::any_of(s.beams, ties)) return;
  doubts.push_back({"bodies." + name, fmt::format("is wholly above the water at the start, from z = {:.4g} m up", reach.low),
                    "in the water, or held by a joint, beam or line",
                    "look at the heights of its shapes (still water is z = 0) and at displacement_m"});
}

/// Draft of the deepest body that the water carries; doubts about bodies below the bed and about weights that the water cannot
/// carry at all, or that hardly press it aside.
double doubt_floating(scene::Doubts& doubts, const FloatingSystem& floating, std::span<const Motion> motions) {
  const Scenario& s = floating.scenario();
  double draft = 0.0, displaced = 0.0;
  bool any = false;
  std::string first;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const auto& [name, body] = s.bodies[b];
    const bodies::Reach r = bodies::reach(body, motions[b]);
    if (!r.any) continue;
    if (r.low < -s.environment.water_depth_m - 1e-6)
      doubts.push_back({"bodies." + name, fmt::format("reaches down to z = {:.4g} m", r.low),
                        fmt::format("above the bed at {:.4g} m", -s.environment.water_depth_m),
                        "look at its shapes, displacement_m and environment.water_depth_m"});
    else if (constexpr double least = 2.0; floating.particle_plan() && r.low < 0.0) {
      const double gap = r.low + s.environment.water_depth_m, spacing = s.sea.particles->spacing_m;
      if (gap < least * spacing && gap > 1e-6)
        doubts.push_back({"bodies." + name,
                          fmt::format("starts {:.3g} m above the bed, {:.2g} spacings of the particles", gap, gap / spacing),
                          fmt::format("{:g} spacings at least", least),
                          "take smaller particles or deeper water: where no particle fits nothing carries it"});
    }
    if (constexpr double most = 200.0; r.low < -most && r.low >= -s.environment.water_depth_m)
      doubts.push_back({"bodies." + name, fmt::format("a draft of {:.4g} m", -r.low), fmt::format("up to {:g} m, of spars", most),
                        "look at the unit of its shapes: m"});
    doubt_above_water(doubts, s, name, r);
    if (r.low < 0.0) draft = std::max(draft, -r.low);
    any = any || r.low < 0.0;
    displaced += volume(body);
    if (first.empty()) first = name;
  }
  if (!any) return draft;  // dropped from above: it carries nothing yet
  // Joints to the earth, lines and point loads may carry what the water does not.
  const bool held = std::any_of(s.joints.begin(), s.joints.end(), [](const auto& joint) {
    return std::find(joint.options.bodies.begin(), joint.options.bodies.end(), "earth") != joint.options.bodies.end();
  });
  const double all = s.environment.water_density_kg_m3 * displaced,
               mass = weight(floating) / std::abs(s.environment.gravity_m_s2);
  const bool falls = draft < 0.02 * std::cbrt(displaced);
  if (held || falls) return draft;
  const auto would_float = [&](double kg) { return kg > 0.03 * all && kg < 1.05 * all; };
  const std::string key = "bodies." + first + ".mass_kg",
                    advice = would_float(1e3 * mass) ? "in t? give kg"
                             : would_float(1e-3 * mass)
                                 ? "in g? give kg, or the shapes' sizes in m"
                                 : "look at the mass in kg, and at the shapes' sizes in m (diameters, not radii)";
  if (mass > 1.05 * all)
    doubts.push_back({key, fmt::format("{:.4g} kg in all, whose shapes displace {:.4g} kg of water when wholly under", mass, all),
                      "less: else it sinks", advice});
  else if (mass < 0.03 * all)
    doubts.push_back({key, fmt::format("{:.4g} kg in all, whose shapes displace {:.4g} kg of water when wholly under", mass, all),
                      "more than 3 % of that: else it lies on the water like foam", advice});
  return draft;
}

/// Loads that nothing in the scene balances throw a body off at once.
void doubt_acceleration(scene::Doubts& doubts, FloatingSystem& floating, const Start& start) {
  if (floating.particle_plan()) return;  // its water is not there yet
  const bodies::Evaluation& now = floating.multibody().evaluate(start.state, 0.0);
  if (!now.report.ok()) return;
  const double gravity = std::abs(floating.scenario().environment.gravity_m_s2), bound = 1.2 * std::max(gravity, 1.0);
  const auto all = floating.multibody().bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const double a = now.acceleration[b].norm();
    if (a <= bound) continue;
    std::size_t worst = 0;
    for (std::size_t s = 0; s < now.by_source.size(); ++s)
      if (now.by_source[s][b].force.norm() > now.by_source[worst][b].force.norm()) worst = s;
    const double largest = now.by_source[worst][b].force.norm();
    const std::string by = largest < 0.5 * a * all[b].mass
                               ? "its joints, from other bodies"
                               : fmt::format("{} ({:.3g} N)", floating.multibody().loads()[worst].name, largest);
    doubts.push_back({"bodies." + all[b].name, fmt::format("starts with an acceleration of {:.4g} m/s2, mostly by {}", a, by),
                      fmt::format("up to {:.3g} m/s2, a free fall", bound),
                      "look at the units of mass, sizes and stiffness, or start in equilibrium"});
  }
}

/// Modes that grow: what the statics call unstable (metacentric height), and damping of the wrong sign.
/// What holds a rigid motion of this name where it is: the metacentric height roll and pitch, lines all others.
std::string what_holds(const std::string& mode) {
  if (mode.starts_with("roll") || mode.starts_with("pitch"))
    return "look at the height of the centre of mass (the metacentric height must be above zero), at the shapes and at the lines";
  return "look at the lines, at the loads that turn with it and at the shapes";
}

/// Of all modes, which come fastest first [1/s]; 0 without any.
double fastest_rate(const Stability& stability) {
  return stability.shown().modes.empty() ? 0.0 : std::abs(stability.shown().modes.front().eigenvalue);
}

void doubt_modes(scene::Doubts& doubts, const FloatingSystem& floating, const Stability& stability) {
  if (floating.particle_plan()) return;
  const bool drag =
      floating.scenario().has_given_waves();  // quadratic in the motion, it is not in the modes: only what no drag holds is told
  const double fastest = fastest_rate(stability);
  for (const bodies::Mode& mode : stability.shown().modes) {
    const double rate = mode.eigenvalue.real(), size = std::abs(mode.eigenvalue);
    if (rate <= 1e-3 * size || rate <= 1e-4 || size < 1e-6 * fastest) continue;
    const double doubling = std::log(2.0) / rate;
    const bool swings = mode.eigenvalue.imag() > 1e-9 * fastest;
    if (drag && (swings || doubling > 60.0)) continue;
    if (swings)
      doubts.push_back({"bodies",
                        fmt::format("{} grows by itself: damping {:.3g} % of critical, doubling in {:.3g} s", mode.name,
                                    100.0 * mode.damping_ratio(), doubling),
                        "damping above zero", "look at the signs of damping, or at a rotor whose thrust rises with the wind"});
    else
      doubts.push_back({"bodies", fmt::format("{} leaves the start by itself, doubling in {:.3g} s", mode.name, doubling),
                        "a start that is stable", what_holds(mode.name)});
  }
}

/// Where the operating table's power first is its largest [m/s]; 0 without a table or its power.
double rated_wind(const aero::RotorOptions& rotor) {
  if (rotor.operation.empty()) return 0.0;
  const aero::Operation table = aero::read_operation(rotor.operation);
  constexpr double near_rated = 0.99;
  const std::size_t rated = table.first_above(near_rated);
  return rated < table.wind.size() ? table.wind[rated] : 0.0;
}

/// Gains of a fixed foundation above rated wind, on a turbine that pitches more slowly than they act (Larsen & Hanson 2007, J.
/// Phys.: Conf. Ser. 75, 012073). The modes, whose rotor keeps speed and pitch, do not show it.
void doubt_tuning(scene::Doubts& doubts, const Scenario& s, const Stability& stability) {
  if (s.control.model != aero::ControlModel::dtu || s.control.tuning != aero::Tuning::fixed_foundation) return;
  if (s.wind.speed_m_s < rated_wind(s.rotor)) return;
  constexpr double fast_s = 12.0;  // the gains answer within some 10 to 17 s
  for (const bodies::Mode& mode : stability.shown().modes)
    if (mode.name == "pitch of " + s.rotor.body && mode.eigenvalue.imag() > 0.0 && mode.period_s() > fast_s)
      doubts.push_back(
          {"control.tuning",
           fmt::format("gains of a fixed foundation on {}, which pitches in {:.3g} s", s.rotor.body, mode.period_s()),
           fmt::format("\"floating\" where that takes longer than about {:g} s", fast_s),
           "above rated wind such gains take the air's damping away: the platform pitches ever more"});
}

/// A motion that a flexible beam takes part in, and that the blades meet once or three times a turn.
void doubt_resonance(scene::Doubts& doubts, const FloatingSystem& floating, const aero::RotorLoads& rotor, int blades,
                     const Start& start, const Stability& stability) {
  if (floating.beams().empty()) return;
  const double turns = std::abs(rotor.state(0.0, start.state.motions).speed) / (2.0 * pi);
  constexpr double close = 0.05, light = 0.1, rigid_Hz = 0.1;  // floats swing slower than rigid_Hz
  for (const bodies::Mode& mode : stability.shown().modes) {
    const double f = std::abs(mode.eigenvalue) / (2.0 * pi);
    if (mode.eigenvalue.imag() < 1e-6 || f < rigid_Hz || mode.damping_ratio() > light) continue;
    for (const int times : {1, blades})
      if (const double forced = times * turns; forced > 0.0 && std::abs(f - forced) < close * forced)
        doubts.push_back({"beams",
                          fmt::format("{} at {:.4g} Hz, {}P at {:.4g} Hz: {} meets it at every turn", mode.name, f, times, forced,
                                      times == 1 ? "the rotor" : "each blade"),
                          fmt::format("more than {:.0f} % apart", 100.0 * close),
                          "look at the beam's properties and the rotor's speed, or expect resonance"});
  }
}

/// A tower that the thrust on its top bends, clamped at its foot: towers of steel lean by 0.3 to 1.5 % of their length at rated
/// thrust, and yield at some 3 %.
void doubt_lean(scene::Doubts& doubts, const FloatingSystem& floating, const aero::RotorLoads& rotor, const Start& start) {
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
}

/// Steps that cut the fastest motion of the bodies into many more than any integrator needs. Lines and fluids may need them.
void doubt_fine_step(scene::Doubts& doubts, const FloatingSystem& floating, const Stability& stability) {
  constexpr double most = 1e5;
  const Scenario& s = floating.scenario();
  const auto is_dynamic = [](const auto& line) { return bool(moorings::line_models().named(line.options.model).make_dynamic); };
  if (floating.particle_plan() || s.resolves_air() || std::ranges::any_of(s.moorings, is_dynamic)) return;
  const double fastest = fastest_rate(stability);
  if (fastest <= 0.0 || 2.0 * pi / fastest < most * s.time.step()) return;
  doubts.push_back(
      {"time.step_s", fmt::format("{:.4g} s where the fastest motion takes {:.3g} s", s.time.step(), 2.0 * pi / fastest),
       fmt::format("up to {:g} steps to it: 50 to 1000 do", most), "the cost goes with their number; look at its unit: s"});
}

/// Steps that are stable and yet follow no swing of the bodies. Beams have stiff ones that hardly move.
void doubt_coarse_step(scene::Doubts& doubts, const FloatingSystem& floating, const Stability& stability) {
  constexpr double least = 10.0, light = 0.3;  // steps to a swing, as docs/user/choosing.md has it; damping of critical
  const Scenario& s = floating.scenario();
  if (floating.particle_plan()) return;
  const auto of_a_beam = [&](const std::string& name) {
    return std::ranges::any_of(s.beams, [&](const auto& beam) { return name.ends_with(" of " + beam.name); });
  };
  for (const bodies::Mode& mode : stability.linearisation.modes) {  // fastest first
    if (mode.eigenvalue.imag() <= 1e-6 || mode.damping_ratio() > light || of_a_beam(mode.name)) continue;
    if (s.time.step() > mode.period_s() / least)
      doubts.push_back({"time.step_s",
                        fmt::format("{:.4g} s where {} has a period of {:.4g} s", s.time.step(), mode.name, mode.period_s()),
                        fmt::format("up to {:.3g} s, {:g} steps to a period", mode.period_s() / least, least),
                        "longer steps damp it by themselves and change its period"});
    return;
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

/// Shorter than any swing of the bodies.
void doubt_length(scene::Doubts& doubts, const FloatingSystem& floating, const Stability& stability) {
  const Scenario& s = floating.scenario();
  if (floating.particle_plan() || s.has_waves() || !s.has_sea() || s.is_controlled()) return;
  double shortest = 0.0;
  for (const bodies::Mode& mode : stability.shown().modes)
    if (mode.eigenvalue.imag() > 1e-6 && (shortest == 0.0 || mode.period_s() < shortest)) shortest = mode.period_s();
  if (shortest > 0.0 && s.time.end_s < 0.5 * shortest)
    doubts.push_back({"time.end_s",
                      fmt::format("{:.4g} s where the fastest motion has a period of {:.4g} s", s.time.end_s, shortest),
                      "half a period at least", "look at its unit: seconds"});
}

/// Damping that stops a body at once, or hardly at all. Floats of any size swing in times of sqrt(size / g) (Froude), and are
/// damped in longer ones: by some per cent of critical, within 10 to 100 of these times.
void doubt_damping(scene::Doubts& doubts, const Scenario& s) {
  constexpr double least = 0.2, most = 1000.0;
  for (std::size_t n = 0; n < s.sea.damping.size(); ++n)
    for (const auto& [name, body] : s.bodies) {
      const double size = bodies::extent(body);
      if (name != s.sea.damping[n].body || size == 0.0) continue;
      const double natural = std::sqrt(size / std::max(1.0, std::abs(s.environment.gravity_m_s2)));
      const double force = s.sea.damping[n].force_N_s_m.maxCoeff();
      const Eigen::Vector3d moments = s.sea.damping[n].moment_N_m_s;
      const auto tell = [&, &name = name](const char* key, double decays) {
        if (decays < least * natural)
          doubts.push_back({fmt::format("sea.damping[{}].{}", n, key), fmt::format("stops body {} within {:.2g} s", name, decays),
                            fmt::format("{:.2g} s or more, {:g} of sqrt(size / g)", least * natural, least),
                            "look at its unit: N s/m, N m s"});
        else if (decays > most * natural)
          doubts.push_back(
              {fmt::format("sea.damping[{}].{}", n, key),
               fmt::format("slows body {} within {:.2g} s, {:.2g} of critical", name, decays, 0.5 * natural / decays),
               fmt::format("up to {:.2g} s, {:g} of sqrt(size / g)", most * natural, most),
               "look at its unit: N s/m, not kN s/m; N m s"});
      };
      if (force > 0.0) tell("force_N_s_m", body.mass_kg / force);
      double fastest = 0.0;
      for (int axis = 0; axis < 3; ++axis) fastest = std::max(fastest, moments[axis] / body.inertia_kg_m2(axis, axis));
      if (fastest > 0.0) tell("moment_N_m_s", 1.0 / fastest);
    }
}

/// Column-stabilised units may lean by so much when they are damaged (IMO MODU Code 2009, section 3.4).
constexpr double most_heel = 17.0;

/// As floats swing, so do they with springs and dampers of a matrix: see moorings/doubts.cpp for the stiffness.
void doubt_matrices(scene::Doubts& doubts, const Scenario& s) {
  constexpr double least_period = 0.3, least_decay = 0.2;
  for (std::size_t n = 0; n < s.sea.matrices.size(); ++n) {
    const sea::MatricesOptions& m = s.sea.matrices[n];
    const auto body = std::ranges::find(s.bodies, m.body, &scene::Named<bodies::BodyOptions>::name);
    const double size = body == s.bodies.end() ? 0.0 : bodies::extent(body->options);
    if (size == 0.0) continue;
    const double swing = std::sqrt(size / std::max(1.0, std::abs(s.environment.gravity_m_s2)));
    const auto first = [&](const std::vector<std::array<double, 6>>& rows, const char* key, const char* what, double least,
                           auto time) {
      for (int i = 0; i < int(rows.size()); ++i) {
        const double inertia = i < 3 ? body->options.mass_kg : body->options.inertia_kg_m2(i - 3, i - 3);
        const double value = rows[std::size_t(i)][std::size_t(i)];
        if (value <= 0.0 || time(inertia / value) >= least * swing) continue;
        doubts.push_back(
            {fmt::format("sea.matrices[{}].{}", n, key),
             fmt::format("{:.4g} in row {} {} body {} in {:.2g} s", value, i + 1, what, m.body, time(inertia / value)),
             fmt::format("{:.2g} s or more, {:g} of sqrt(size / g)", least * swing, least),
             "look at the units: N, m, rad and s"});
        return;
      }
    };
    first(m.stiffness, "stiffness", "swings", least_period, [](double x) { return 2.0 * pi * std::sqrt(x); });
    first(m.damping, "damping", "stops", least_decay, [](double x) { return x; });
  }
}

/// Floats in particles that capsize: their rest is on their side, or unstable with their mass high over the water. Those that
/// heel from one rest to another, as a log of square section does, have it near the water or below.
void doubt_top_heavy(scene::Doubts& doubts, const FloatingSystem& floating, const Start& start,
                     const bodies::Equilibrium& found) {
  if (!floating.particle_plan()) return;
  constexpr double high = 0.1, side_deg = 60.0;  // of half its diagonal
  const bodies::NamedBodies& bodies = floating.scenario().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& [name, body] = bodies[b];
    if (bodies::extent(body) == 0.0) continue;
    const Motion &now = start.state.motions[b], &rest = found.state.motions[b];
    const Eigen::Vector3d up = rest.attitude * (now.attitude.conjugate() * Eigen::Vector3d::UnitZ());
    const double over = rest.position.z(), heel = std::acos(std::clamp(up.z(), -1.0, 1.0)) / radians_per_degree;
    std::string what;
    if (heel > side_deg) what = fmt::format("the body capsizes: it rests turned by {:.3g} degrees from its start", heel);
    if ((found.unstable == "roll of " + name || found.unstable == "pitch of " + name) && over > high * bodies::extent(body))
      what =
          fmt::format("{} is unstable where the body floats, its centre of mass {:.3g} m over the water", found.unstable, over);
    if (!what.empty())
      doubts.push_back({"bodies." + name + ".centre_m", what, "a metacentric height above zero",
                        "look at the height of the centre of mass and at the shapes"});
  }
}

/// A start that an equilibrium takes the place of: the run would not be the decay test that the scene describes.
void doubt_displaced_equilibrium(scene::Doubts& doubts, const FloatingSystem& floating, const Start& start) {
  if (!start.equilibrium) return;
  constexpr double most = 0.1;  // of a place that is given as the first guess
  for (std::size_t b = 0; b < start.state.motions.size(); ++b) {
    const auto& [name, o] = floating.scenario().bodies[b];
    const Motion& found = start.state.motions[b];
    const ReferenceMotion m = reference_motion(floating, b, found);
    const std::string section = "bodies." + name;
    const auto doubt = [&](const char* key, const Eigen::Vector3d& given, const Eigen::Vector3d& is) {
      if (given.isZero(0.0) || (given - is).norm() <= most * given.norm()) return;
      doubts.push_back({section + key,
                        fmt::format("[{:.4g}, {:.4g}, {:.4g}], of which start.equilibrium leaves [{:.4g}, {:.4g}, {:.4g}]",
                                    given.x(), given.y(), given.z(), is.x(), is.y(), is.z()),
                        "one of the two", "for a start from there, as for a decay test, leave out start.equilibrium"});
    };
    doubt(".displacement_m", o.displacement_m, m.displacement);
    doubt(".rotation_deg", o.rotation / radians_per_degree, m.angles / radians_per_degree);
    doubt(".velocity_m_s", o.velocity_m_s, found.velocity);
    doubt(".omega_rad_s", o.omega_rad_s, found.omega_earth());
  }
}

/// Where the floating system would come to rest, or starts at rest, against where it is described.
void doubt_statics(scene::Doubts& doubts, FloatingSystem& floating, const Start& start) {
  if (!has_level_water(floating.scenario())) return;
  const auto found_now = [&] {
    const MeanLoads mean(floating);
    return find_equilibrium(floating.multibody(), start.state, 0.0);
  };
  const bodies::Equilibrium found = start.equilibrium ? *start.equilibrium : found_now();
  if (!found.problem.empty()) return;
  doubt_top_heavy(doubts, floating, start, found);
  if (floating.particle_plan() && !start.equilibrium) return;  // its water is not there yet
  const auto all = floating.multibody().bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const bodies::BodyOptions& body = floating.scenario().bodies[b].options;
    if (bodies::extent(body) == 0.0) continue;
    const ReferenceMotion m = reference_motion(floating, b, found.state.motions[b]);
    const double turned = m.angles.head<2>().cwiseAbs().maxCoeff() / radians_per_degree, heave = m.displacement.z();
    const double draft = -bodies::bounds(body).min().z();  // where it is described
    const double most_heave = floating.scenario().has_sea() && draft > 0.0 ? 0.3 * draft : bodies::extent(body);
    if (turned > most_heel || std::abs(heave) > most_heave)
      doubts.push_back({"bodies." + all[b].name,
                        fmt::format("rests {:.3g} m {} than described and heeled by {:.3g} degrees", std::abs(heave),
                                    heave > 0.0 ? "higher" : "lower", turned),
                        fmt::format("up to {:.3g} m, 0.3 of its draft, and {:g} degrees", most_heave, most_heel),
                        "look at the loads, the weight and its place, and at the shapes' sizes"});
    const double aside = m.displacement.head<2>().norm(),
                 most = std::max(0.5 * floating.scenario().environment.water_depth_m, bodies::extent(body));
    if (floating.scenario().has_sea() && !floating.scenario().moorings.empty() && aside > most)
      doubts.push_back({"moorings", fmt::format("body {} rests {:.4g} m aside of where it is described", all[b].name, aside),
                        fmt::format("up to {:.3g} m, half the depth or its size", most),
                        "look at the lines' stiffness and length, and at the units of the loads"});
  }
}

/// A table in time that the run does not come to, or leaves at its very start: its first or its last value holds.
void doubt_time_of_table(scene::Doubts& doubts, const std::string& key, const std::string& path, double end_s) {
  if (path.empty()) return;
  constexpr double least = 2e-3;  // ramps that then hold are longer
  const scene::Columns file = scene::read_columns(path);
  const std::span<const double> time = file["time_s"];
  const bool too_late = time.front() >= end_s || (time.size() > 2 && time[1] > end_s);
  if (time.size() < 2 || (!too_late && time.back() >= least * end_s)) return;
  doubts.push_back({key,
                    fmt::format("rows at {:.4g}, {:.4g} to {:.4g} s in a run of {:.4g} s", time[0], time[1], time.back(), end_s),
                    "rows within the run", "one value or one line holds all along; look at the unit of its time_s: s, not ms"});
}

/// A driver's table that begins or ends within the run while it moves: the joint starts or stops at once.
void doubt_driver(scene::Doubts& doubts, const std::string& key, const PrescribedMotion& motion, double end_s) {
  constexpr double least = 0.01;  // of the steepest
  if (motion.table.empty()) return;
  for (const auto& [t, verb, inside] : {std::tuple{motion.table.begin(), "begins", motion.table.begin() > 0.0},
                                        std::tuple{motion.table.end(), "ends", motion.table.end() < end_s}})
    if (const double share = std::abs(motion.table.at(t).rate) / std::max(motion.table.steepest(), 1e-300);
        inside && share > least)
      doubts.push_back(
          {key, fmt::format("{} at {:.4g} s with {:.2g} of its largest rate, in a run of {:.4g} s", verb, t, share, end_s),
           "at rest there, by rows of the same value, or over the whole run", "the joint moves or stops at once"});
}

void doubt_times(scene::Doubts& doubts, const FloatingSystem& floating) {
  constexpr double most_checkpoints = 320.0;
  const Scenario& s = floating.scenario();
  const bool wavy = s.has_waves() && s.waves.period_s > 0.0;
  if (wavy && s.time.window_s > s.waves.period_s / 8.0 && s.has_rotor() && s.coupling.scheme != SchemeKind::monolithic)
    doubts.push_back({"time.window_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.window_s, s.waves.period_s),
                      "up to an eighth of the period", "rotor and platform exchange loads once a window"});
  const bool own_steps = s.has_particles() && !s.time.step_s;  // those of the particles
  if (wavy && !own_steps && s.time.step() > s.waves.period_s / 8.0)
    doubts.push_back({"time.step_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.step(), s.waves.period_s),
                      "up to an eighth of the period", "the steps do not see the wave"});
  if (wavy && s.time.window_s * s.output.history_every > s.waves.period_s / 4.0)
    doubts.push_back(
        {"output.history_every",
         fmt::format("a row every {:.4g} s under waves of {:.4g} s", s.time.window_s * s.output.history_every, s.waves.period_s),
         "four rows to a period at least", "peaks fall between the rows"});
  if (wavy && s.time.end_s < s.waves.period_s)
    doubts.push_back({"time.end_s", fmt::format("{:.4g} s under waves of {:.4g} s", s.time.end_s, s.waves.period_s),
                      "one period at least", "the run ends before the first wave has passed"});
  const double growth = s.waves.ramp_s.value_or(0.0);
  const bool as_usual = growth == sea::growth_time(s.waves);  // nobody asked for it
  if (wavy && as_usual && s.time.end_s >= s.waves.period_s && growth > s.time.end_s)
    doubts.push_back({"time.end_s", fmt::format("{:.4g} s under waves that grow over {:.4g} s", s.time.end_s, growth),
                      "longer than that, or waves.ramp_s = 0", "the run ends before the waves have their height"});
  for (const auto& [key, value] :
       {std::pair{"waves.ramp_s", wavy && !as_usual ? growth : 0.0}, std::pair{"start.ramp_s", s.start.ramp_s},
        std::pair{"sea.wavemaker.ramp_s", s.sea.wavemaker ? s.sea.wavemaker->ramp_s.value_or(0.0) : 0.0}})
    if (value > s.time.end_s)
      doubts.push_back({key, fmt::format("{:.4g} s in a run of {:.4g} s", value, s.time.end_s), "shorter than the run",
                        "the run ends before what grows is there; look at its unit: s"});
  if (constexpr double least = 0.05; wavy && !as_usual && growth > 0.0 && growth < least * s.waves.period_s)
    doubts.push_back({"waves.ramp_s", fmt::format("{:.4g} s under waves of {:.4g} s", growth, s.waves.period_s),
                      "0, or a period or more", "waves of their full height meet the bodies at once; look at its unit: s"});
  if (s.wind.event && s.has_rotor() && s.wind.event->start_s > s.time.end_s)
    doubts.push_back({"wind.event.start_s", fmt::format("{:.4g} s in a run of {:.4g} s", s.wind.event->start_s, s.time.end_s),
                      "before the end of the run", "the gust does not come; look at its unit: s"});
  for (const bodies::Joint& joint : floating.multibody().joints())
    for (const auto& [kind, motion] : {std::pair{"rotation", &joint.rotation}, std::pair{"translation", &joint.translation}})
      if (*motion) doubt_driver(doubts, fmt::format("joints.{}.{}.table", joint.name, kind), **motion, s.time.end_s);
  doubt_time_of_table(doubts, "wind.table", s.has_rotor() ? s.wind.table : "", s.time.end_s);
  doubt_time_of_table(doubts, "aero.table", s.aero.table, s.time.end_s);
  for (const auto& [key, value] : {std::pair{"waves.crest_time_s", s.waves.crest_height_m ? s.waves.crest_time_s : 0.0},
                                   std::pair{"sea.wavemaker.start_s", s.sea.wavemaker ? s.sea.wavemaker->start_s : 0.0},
                                   std::pair{"sea.fields.from_s", s.sea.fields ? s.sea.fields->from_s : 0.0}})
    if (value > s.time.end_s)
      doubts.push_back({key, fmt::format("{:.4g} s in a run of {:.4g} s", value, s.time.end_s), "before the end of the run",
                        "it does not come; look at its unit: s"});
  if (const auto& box = s.wind.turbulence;
      box && box->model == aero::TurbulenceModel::kaimal && box->duration_s < 0.1 * s.time.end_s)
    doubts.push_back({"wind.turbulence.duration_s", fmt::format("{:.4g} s in a run of {:.4g} s", box->duration_s, s.time.end_s),
                      "a tenth of the run or more; ten minutes are usual",
                      "the same gusts come again and again; look at its unit: s"});
  for (std::size_t n = 0; n < s.control.events.size(); ++n)
    if (const double at = s.control.events[n].time_s; at > s.time.end_s)
      doubts.push_back({fmt::format("control.events[{}].time_s", n),
                        fmt::format("{:.4g} s in a run of {:.4g} s", at, s.time.end_s), "before the end of the run",
                        "it does not come; look at its unit: s"});
  if (constexpr double most = 36000.0; s.time.end_s > most)
    doubts.push_back(
        {"time.end_s", fmt::format("{:.4g} s", s.time.end_s), fmt::format("up to {:g} s, ten hours", most), "in ms? give s"});
  if (s.output.means_over_s > s.time.end_s)
    doubts.push_back({"output.means_over_s", fmt::format("{:.4g} s in a run of {:.4g} s", s.output.means_over_s, s.time.end_s),
                      "up to the length of the run", "look at its unit: s"});
  if (s.sea.fields && s.sea.has_particles() && s.sea.fields->interval_s > 0.0) {
    const double interval = s.sea.fields->interval_s;
    if (interval > s.time.end_s)
      doubts.push_back({"sea.fields.interval_s", fmt::format("{:.4g} s in a run of {:.4g} s", interval, s.time.end_s),
                        "shorter than the run", "only the start is written; look at its unit: s"});
    else if (interval < 0.99 * s.time.window_s)
      doubts.push_back({"sea.fields.interval_s", fmt::format("{:.4g} s with windows of {:.4g} s", interval, s.time.window_s),
                        "a window or more", "fields are written at ends of windows; look at its unit: s"});
  }
  if (const double interval = s.checkpoint.interval_s; interval > 0.0 &&
                                                       s.time.end_s > most_checkpoints * std::max(interval, s.time.window_s) &&
                                                       (s.has_particles() || s.resolves_air()))
    doubts.push_back({"checkpoint.interval_s",
                      fmt::format("{:.4g} s: {:.0f} states of all the water or air are written", interval,
                                  std::floor(s.time.end_s / std::max(interval, s.time.window_s))),
                      fmt::format("up to {:g} in a run", most_checkpoints),
                      "look at its unit: s; checkpoint.wall_interval_s saves by the clock, at little cost"});
  if (constexpr double least = 1.0; s.checkpoint.wall_interval_s > 0.0 && s.checkpoint.wall_interval_s < least)
    doubts.push_back({"checkpoint.wall_interval_s", fmt::format("{:.4g} s", s.checkpoint.wall_interval_s),
                      fmt::format("{:g} s or more; 600 by default", least), "in hours? give s"});
  if (s.sea.settle_s() > 10.0 * s.time.end_s)
    doubts.push_back({"sea.initial.settle_s", fmt::format("{:.4g} s before a run of {:.4g} s", s.sea.settle_s(), s.time.end_s),
                      "up to ten times the run", "look at its unit: s"});
}

/// Of each rotor, by the scene with it alone: what is said of one stands under its own section, what is said of all of them once.
template <class Find>
void doubt_rotors(scene::Doubts& doubts, const FloatingSystem& floating, const Find& find) {
  const std::vector<Scenario> each = by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n) {
    scene::Doubts found;
    find(found, each[n], floating.rotors()[n]);
    for (scene::Doubt& doubt : found) {
      if (doubt.key == "rotor" || doubt.key.starts_with("rotor.")) doubt.key.replace(0, 5, each[n].rotor_section);
      const auto same = [&](const scene::Doubt& other) { return other.key == doubt.key && other.what == doubt.what; };
      if (std::ranges::none_of(doubts, same)) doubts.push_back(doubt);
    }
  }
}

/// Rotors that would touch, and those in the wake of others, which no engineering model has: wakes spread by about a tenth of the
/// way (Jensen 1983, Risoe-M-2411, with a wake decay of 0.1).
void doubt_wakes(scene::Doubts& doubts, const FloatingSystem& floating, const Start& start) {
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
}

/// A window in which the fastest motion has come and gone: rotor and bodies, which exchange loads once a window, miss it.
void doubt_window(scene::Doubts& doubts, const FloatingSystem& floating, const Stability& stability) {
  const Scenario& s = floating.scenario();
  if (!floating.has_interface() || floating.particle_plan()) return;
  constexpr double light = 0.3;
  for (const bodies::Mode& mode : stability.shown().modes)  // fastest first
    if (mode.eigenvalue.imag() > 1e-6 && mode.damping_ratio() < light) {
      if (s.time.window_s > mode.period_s())
        doubts.push_back({"time.window_s",
                          fmt::format("{:.4g} s where {} has a period of {:.4g} s", s.time.window_s, mode.name, mode.period_s()),
                          "less than the period of the fastest motion",
                          "shorten it: rotor and bodies exchange loads once a window"});
      return;
    }
}

/// The axes of a boundary-element code begin at its body.
void doubt_memory(scene::Doubts& doubts, const FloatingSystem& floating) {
  constexpr double most = 0.05;
  if (!floating.sea() || !floating.scenario().sea.potential) return;
  const sea::PotentialBody::Cut cut = floating.sea()->memory_cut();
  if (cut.share > most)
    doubts.push_back(
        {"sea.potential.memory_s",
         fmt::format("{:.4g} s, where the water's memory of {} is at {:.2g} of its largest",
                     floating.scenario().sea.potential->memory_s, bodies::freedom_names[std::size_t(cut.mode)], cut.share),
         fmt::format("so long that {:g} is left", most), "the water forgets waves that are still there"});
}

void doubt_origin(scene::Doubts& doubts, const Scenario& s) {
  if (!s.sea.potential) return;
  const auto body = std::ranges::find(s.bodies, s.sea.potential->body, &scene::Named<bodies::BodyOptions>::name);
  if (body == s.bodies.end()) return;
  const Eigen::Vector3d& point = s.sea.potential->point_m;
  const double aside = (point - body->options.centre_m).head<2>().norm(), usual = std::max(50.0, bodies::extent(body->options));
  if (aside > usual)
    doubts.push_back({"sea.potential.point_m", fmt::format("{:.4g} m aside of body {}", aside, body->name),
                      fmt::format("up to {:.3g} m", usual), "look at its unit: m, and that it is in the scene's coordinates"});
}

/// Radiation and excitation are those of the body as described; still water turns with it.
void doubt_yaw(scene::Doubts& doubts, const Scenario& s) {
  if (!s.sea.potential) return;
  const auto body = std::ranges::find(s.bodies, s.sea.potential->body, &scene::Named<bodies::BodyOptions>::name);
  if (body == s.bodies.end()) return;
  constexpr double most = 5.0;
  const double yaw = tilt_and_yaw(start_motion(body->options).attitude).z() / radians_per_degree;
  if (std::abs(yaw) > most)
    doubts.push_back({"bodies." + body->name + ".rotation_deg", fmt::format("a yaw of {:.4g} degrees in potential flow", yaw),
                      fmt::format("up to {:g} degrees", most),
                      "waves and radiation stay those of the hull as described: describe it turned, with files of that hull"});
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
  sea::BodiesInSea in_sea{.entry_speed = bodies::entry_speed(s.bodies, s.joints, s.beams, s.environment.gravity_m_s2)};
  for (const auto& [name, body] : s.bodies) {
    around.masses_kg[name] = body.mass_kg, around.centres[name] = body.centre_m, around.pieces[name] = bodies::pieces(body);
    if (const Eigen::AlignedBox3d box = bodies::bounds(body); !box.isEmpty())
      around.shapes[name] = box, in_sea.boxes.emplace_back(name, box);
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
  if (s.has_sea()) doubt_damping(all, s), doubt_matrices(all, s), doubt_origin(all, s), doubt_yaw(all, s);
  std::set<std::string> told;
  for (const Scenario& one : by_rotor(s)) append(all, rotor_file_doubts(one, told));
  doubt_times(all, floating);
  doubt_memory(all, floating);
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
  if (!start.state.motions.empty()) doubt_statics(all, floating, start);  // first: rotors of what capsizes are doubted too
  const FullLoads full(floating);
  doubt_rotors(all, floating, [&](scene::Doubts& found, const Scenario& s, const RotorSource& rotor) {
    found = rotor_doubts(s, rotor, start, weight(floating));
  });
  if (start.state.motions.empty()) return all;
  doubt_wakes(all, floating, start);
  doubt_acceleration(all, floating, start);
  doubt_modes(all, floating, stability);
  doubt_rotors(all, floating,
               [&](scene::Doubts& found, const Scenario& s, const RotorSource&) { doubt_tuning(found, s, stability); });
  doubt_displaced_equilibrium(all, floating, start);
  doubt_rotors(all, floating, [&](scene::Doubts& found, const Scenario& s, const RotorSource& rotor) {
    doubt_resonance(found, floating, rotor.loads, blades_of(s), start, stability);
    doubt_lean(found, floating, rotor.loads, start);
  });
  doubt_length(all, floating, stability);
  doubt_fine_step(all, floating, stability);
  doubt_coarse_step(all, floating, stability);
  doubt_window(all, floating, stability);
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
