// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/floating_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/rigid/rotation.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/recorder.hpp"

namespace spindrift::coupling {

namespace {

double volume(const bodies::BodyOptions& body) {
  double sum = 0.0;
  for (const bodies::CylinderOptions& c : body.cylinders) sum += make_cylinder(c, body).volume();
  for (const bodies::BoxOptions& b : body.boxes) sum += make_box(b, body).volume();
  for (const bodies::SphereOptions& s : body.spheres) sum += make_sphere(s, body).volume();
  for (const scene::MeshOptions& m : body.meshes) sum += m.surface->volume();
  return sum;
}

/// A joint or beam with this body at one end.
bool ties(const auto& joint_or_beam, const std::string& body) {
  return std::ranges::find(joint_or_beam.options.bodies, body) != joint_or_beam.options.bodies.end();
}

/// A driver, or a fixed joint, holds it to the earth: nothing else has to carry it.
bool held_by_earth(const Scenario& s, const std::string& name) {
  return std::ranges::any_of(s.joints, [&](const auto& joint) {
    const bodies::JointOptions& o = joint.options;
    return ties(joint, name) && ties(joint, "earth") && (o.type == JointType::fixed || o.rotation || o.translation);
  });
}

/// A body that the water does not touch at the start, and that nothing else carries: it falls, and no engineering sea has the
/// slam.
void doubt_above_water(scene::Doubts& doubts, const Scenario& s, const std::string& name, const bodies::Reach& reach) {
  if (s.has_particles() || reach.low <= 0.0 || s.environment.gravity_m_s2 == 0.0) return;
  const auto ties_it = [&name = name](const auto& tie) { return ties(tie, name); };
  const bool moored = std::ranges::any_of(
      s.moorings, [&](const auto& line) { return line.options.body == name || line.options.anchor_body == name; });
  const bool by_matrices = std::ranges::any_of(s.sea.matrices, [&](const auto& m) { return m.body == name; }) ||
                           (s.sea.potential && s.sea.potential->body == name);
  if (moored || by_matrices || std::ranges::any_of(s.joints, ties_it) || std::ranges::any_of(s.beams, ties_it)) return;
  doubts.push_back({"bodies." + name, fmt::format("is wholly above the water at the start, from z = {:.4g} m up", reach.low),
                    "in the water, or held by a joint, beam or line",
                    "look at the heights of its shapes (still water is z = 0) and at displacement_m"});
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

/// The water's memory of the hull, cut off while it still acts, in time or by the files' last frequency; waves beyond that.
void doubt_memory(scene::Doubts& doubts, const FloatingSystem& floating) {
  constexpr double most = 0.05;
  const sea::PotentialBody* body = floating.sea() ? floating.sea()->potential() : nullptr;
  if (!body) return;
  const sea::PotentialOptions& o = *floating.scenario().sea.potential;
  if (const sea::PotentialBody::CutDamping& cut = body->cut_damping();
      o.radiation != "none" && cut.share > sea::PotentialBody::died_out)
    doubts.push_back({"sea.potential.radiation_file",
                      fmt::format("damping of {} at {:.2g} of its largest at the last frequency, {:.4g} rad/s",
                                  bodies::freedom_names[std::size_t(cut.mode)], cut.share, cut.omega),
                      fmt::format("frequencies until {:g} is left", sea::PotentialBody::died_out),
                      "the memory lacks what is beyond: added mass and damping are the file's up to some 0.7 of that frequency"});
  if (const sea::PotentialBody::Unexcited& lost = body->unexcited(); lost.share > most)
    doubts.push_back({"sea.potential.excitation_file",
                      fmt::format("{:.0f} % of the waves' energy in waves shorter than {:.4g} s, its shortest",
                                  100.0 * lost.share, lost.period_s),
                      fmt::format("up to {:.0f} %", 100.0 * most), "they press on nothing; take shorter periods into the file"});
  const sea::PotentialBody::Cut& cut = body->cut();
  if (cut.share > most)
    doubts.push_back(
        {"sea.potential.memory_s",
         fmt::format("{:.4g} s, where the water's memory of {} is at {:.2g} of its largest",
                     floating.scenario().sea.potential->memory_s, bodies::freedom_names[std::size_t(cut.mode)], cut.share),
         fmt::format("so long that {:g} is left", most), "the water forgets waves that are still there"});
}

/// Coefficients of another scale, or over something else than periods: water that goes with a hull weighs about as much as it
/// displaces, and waves that are long beside it lift it as still water does.
void doubt_scale(scene::Doubts& doubts, const FloatingSystem& floating) {
  const sea::PotentialBody* water = floating.sea() ? floating.sea()->potential() : nullptr;
  if (!water) return;
  const Scenario& s = floating.scenario();
  constexpr double least = 0.02, most = 50.0;
  const double gravity = std::abs(s.environment.gravity_m_s2), density = s.environment.water_density_kg_m3;
  const double mass = weight(floating) / std::max(gravity, 1e-9);
  if (const double share = water->infinite_added_mass().diagonal().head<3>().maxCoeff() / mass; share < least || share > most)
    doubts.push_back({"sea.potential.radiation_file", fmt::format("an added mass of {:.2g} times the mass of what floats", share),
                      fmt::format("{:g} to {:g} times", least, most),
                      "look at sea.potential.length_m, by which the file is scaled"});
  const auto body = std::ranges::find(s.bodies, s.sea.potential->body, &scene::Named<bodies::BodyOptions>::name);
  double stiffness = water->heave_stiffness();
  for (const bodies::CylinderOptions& c : body->options.cylinders)
    if (!water->linear_hydrostatics() && c.start_m.z() * c.end_m.z() < 0.0)
      stiffness += density * gravity * 0.25 * pi * c.diameter_m * c.diameter_m * (c.end_m - c.start_m).norm() /
                   std::abs(c.end_m.z() - c.start_m.z());
  constexpr double smallest = 0.5, greatest = 1.5, is_long = 0.3;
  const auto& [omega, heave] = water->long_waves();
  const double size = std::max(bodies::extent(body->options), 2.0 * std::cbrt(mass / density));
  if (omega == 0.0 || stiffness <= 0.0 || omega * omega / gravity * 0.5 * size > is_long) return;
  if (heave < smallest * stiffness || heave > greatest * stiffness)
    doubts.push_back({"sea.potential.excitation_file",
                      fmt::format("{:.4g} N/m of heave in its longest waves, of {:.4g} s, where still water has {:.4g} N/m",
                                  heave, 2.0 * pi / omega, stiffness),
                      "about as much", "look at sea.potential.length_m, and whether its first column has periods, in s"});
}

/// The axes of a boundary-element code begin at its body.
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

}  // namespace

double weight(const FloatingSystem& floating) {
  double mass = 0.0;
  for (const auto& body : floating.scenario().bodies) mass += body.options.mass_kg;
  for (const bodies::Beam& beam : floating.beams())
    for (const beam::Station& share : beam.link.stations) mass += share.mass;
  return mass * std::abs(floating.scenario().environment.gravity_m_s2);
}

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
      if (gap < least * spacing && gap > 1e-6 && !held_by_earth(s, name))
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

void doubt_linear_loads(scene::Doubts& doubts, const FloatingSystem& floating) {
  const Scenario& s = floating.scenario();
  doubt_damping(doubts, s), doubt_matrices(doubts, s), doubt_origin(doubts, s), doubt_yaw(doubts, s);
  doubt_memory(doubts, floating), doubt_scale(doubts, floating);
}

scene::Doubts acceleration_doubts(FloatingSystem& floating, const Start& start) {
  scene::Doubts doubts;
  if (floating.particle_plan()) return doubts;  // its water is not there yet
  const bodies::Evaluation& now = floating.multibody().evaluate(start.state, 0.0);
  if (!now.report.ok()) return doubts;
  // A tower that is not bent yet lets what stands on it fall at first, and lurch.
  constexpr double free_fall = 1.2, on_a_beam = 3.0;
  const double gravity = std::max(std::abs(floating.scenario().environment.gravity_m_s2), 1.0);
  const auto all = floating.multibody().bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const bool carried =
        std::ranges::any_of(floating.scenario().beams, [&](const auto& beam) { return ties(beam, all[b].name); });
    const double a = now.acceleration[b].norm(), bound = gravity * (carried ? on_a_beam : free_fall);
    if (a <= bound) continue;
    std::size_t worst = 0;
    for (std::size_t s = 0; s < now.by_source.size(); ++s)
      if (now.by_source[s][b].force.norm() > now.by_source[worst][b].force.norm()) worst = s;
    const double largest = now.by_source[worst][b].force.norm();
    const std::string by = largest < 0.5 * a * all[b].mass
                               ? "its joints, from other bodies"
                               : fmt::format("{} ({:.3g} N)", floating.multibody().loads()[worst].name, largest);
    doubts.push_back({"bodies." + all[b].name, fmt::format("starts with an acceleration of {:.4g} m/s2, mostly by {}", a, by),
                      fmt::format("up to {:.3g} m/s2{}", bound, carried ? "" : ", a free fall"),
                      "look at the units of mass, sizes and stiffness, or start in equilibrium"});
  }
  return doubts;
}

scene::Doubts displaced_equilibrium_doubts(const FloatingSystem& floating, const Start& start) {
  scene::Doubts doubts;
  if (!start.equilibrium) return doubts;
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
  return doubts;
}

scene::Doubts statics_doubts(FloatingSystem& floating, const Start& start) {
  scene::Doubts doubts;
  if (!has_level_water(floating.scenario())) return doubts;
  const auto found_now = [&] {
    const MeanLoads mean(floating);
    return find_equilibrium(floating.multibody(), start.state, 0.0);
  };
  const bodies::Equilibrium found = start.equilibrium ? *start.equilibrium : found_now();
  if (!found.problem.empty()) return doubts;
  doubt_top_heavy(doubts, floating, start, found);
  if (floating.particle_plan() && !start.equilibrium) return doubts;  // its water is not there yet
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
  return doubts;
}

}  // namespace spindrift::coupling
