// spindrift check: validates a scene and says what will be modelled, at what cost and at which limits. Runs nothing.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "kernels/base/failure.hpp"
#include "kernels/rigid/closed_surface.hpp"
#include "src/aero/changing_wind.hpp"
#include "src/aero/first_cells.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/line_growth.hpp"
#include "src/aero/grid/tiling.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/app/commands.hpp"
#include "src/app/cost.hpp"
#include "src/app/forecast.hpp"
#include "src/app/held_output.hpp"
#include "src/app/leave_out.hpp"
#include "src/app/rotor_start.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/smaller_choices.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/doubts.hpp"
#include "src/coupling/first_cells.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/memory_limits.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/saved_air.hpp"
#include "src/coupling/saved_start.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/angle_doubts.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::app {

namespace {

using coupling::FloatingSystem;

/// Of a source of load "rotor.a": "rotor a".
std::string spoken(std::string name) {
  std::ranges::replace(name, '.', ' ');
  return name;
}

void print_models(const FloatingSystem& floating) {
  const coupling::Scenario& s = floating.scenario();
  fmt::print("\nWhat will be modelled\n");
  std::size_t width = 10;
  for (const coupling::RotorSource& rotor : floating.rotors()) width = std::max(width, rotor.name.size() + 2);
  const auto print = [width](const std::string& what, const std::string& how) { fmt::print("  {:<{}}{}\n", what, width, how); };
  print("bodies", coupling::describe_bodies(s));
  const std::vector<coupling::Scenario> each = coupling::by_rotor(s);
  if (each.empty()) print("rotor", coupling::describe_rotor(s));
  for (std::size_t n = 0; n < each.size(); ++n) print(spoken(floating.rotors()[n].name), coupling::describe_rotor(each[n]));
  if (s.has_rotor() && s.aero.model != "prescribed") print("wind", aero::describe_wind(s.wind));
  if (!each.empty())
    if (const std::string spread = floating.rotors()[0].loads.wind().spread(); !spread.empty()) print("", spread);
  print("sea", coupling::describe_sea(s));
  print("moorings", coupling::describe_moorings(s));
}

/// The state of another run that the scene starts from, and where the sea in it comes from.
struct SavedParts {
  std::optional<io::CheckpointReader> sea;
  coupling::NamedState sea_named;
};
/// Throws scene::SceneError where it is not of this scene. Collective.
SavedParts open_saved_parts(MPI_Comm comm, const FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  if (!s.start.air.empty()) coupling::open_air(comm, s);
  if (!s.start.file.empty()) return {coupling::open_start(comm, floating, start.state).file, {"start.file", s.start.file}};
  if (floating.particle_plan() && s.sea.initial && s.sea.initial->state == "file")
    return {coupling::open_sea(comm, floating), {"sea.initial.file", s.sea.initial->file}};
  return {};
}

/// A sea that is laid out to be counted must have as many particles as the saved one; one that is not, about as many.
void require_particles(const SavedParts& saved, const coupling::Scenario& s, const sea::ParticleCensus& census) {
  if (!saved.sea) return;
  const auto values = std::int64_t(census.particles() * census.values_each);
  const std::string why = coupling::other_sea(*saved.sea, values);
  const double has = double(saved.sea->size(coupling::particles_name));
  constexpr double counted_to = 0.1;
  if (!why.empty() && !(census.counted && std::abs(has - double(values)) <= counted_to * double(values)))
    refuse_saved(s, saved.sea_named, why);
  if (census.counted)
    fmt::print("  {:<22}must be those of {} exactly, which a run tells: {:.4g} are in it\n", "", saved.sea_named.key,
               has / double(census.values_each));
}

/// Of a sea of particles: how many, how large, how long. Nothing of it is made but a list of places.
PartCost print_particles(const FloatingSystem& floating, const coupling::Start& start, const SavedParts& saved) {
  const coupling::Scenario& s = floating.scenario();
  const sea::ParticleCensus census = particle_census(*floating.particle_plan(), start.state.motions);
  const sph::Parameters& p = floating.particle_plan()->parameters;
  const double steps_per_window = particle_steps(floating, census);
  fmt::print("\nSea of particles\n");
  if (census.counted)
    fmt::print("  {:<22}about {:.3g} ({:.3g} water, {:.3g} walls, {:.3g} bodies), by columns and volumes\n", "particles",
               double(census.particles()), double(census.water), double(census.walls), double(census.bodies));
  else
    fmt::print("  {:<22}{} ({} water, {} walls, {} bodies)\n", "particles", census.particles(), census.water, census.walls,
               census.bodies);
  require_particles(saved, s, census);
  const bool alone = coupling::has_level_water(s) && s.joints.empty() && s.moorings.empty() && s.beams.empty() && !s.has_rotor();
  for (const sea::ParticleCensus::Body& body : census.floats)
    fmt::print("  {:<22}{:.6g} m3 displaced by its particles, {:.6g} m3 at the start{}\n", body.name, body.volume_m3,
               body.wetted_m3,
               !alone        ? ""
               : body.rise_m ? fmt::format("; it floats {:+.4g} m from there", *body.rise_m)
                             : "; it sinks");
  fmt::print("  {:<22}{:.4g} m/s ({}), {:.3g} m spacing, support {:.3g} m\n", "speed of sound", p.eos.c0,
             floating.particle_plan()->sound_speed_from, p.spacing, p.reach());
  fmt::print("  {:<22}{:.4g} s at rest, set by {}{}; {:.0f} to a window\n", "largest step", census.step_s, census.step_set_by,
             s.time.step_s ? fmt::format("; the scene asks for {} s", *s.time.step_s) : "", steps_per_window);
  return cost_of_particles(floating, census, steps_per_window);
}

/// Statics of the surfaces that a scene takes from files, where they are at the start; in 2-D of their outline in its width.
void print_meshes(const FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  for (std::size_t b = 0; b < s.bodies.size(); ++b)
    for (const scene::MeshOptions& mesh : s.bodies[b].options.meshes) {
      const bool planar = mesh.prism != nullptr;
      const ClosedSurface& surface = planar ? *mesh.prism : *mesh.surface;
      const double share = planar ? s.sea.particles->width_m / surface.box().sizes()[1] : 1.0;
      const Motion& now = start.state.motions[b];
      const Eigen::Vector3d size = mesh.surface->box().sizes();
      const Eigen::Matrix3d inertia = surface.inertia() / surface.volume(), turn = now.attitude.toRotationMatrix();
      const auto place = [&](const Eigen::Vector3d& x) {  // without the last digits of sums that cancel
        const Eigen::Vector3d plain = x.unaryExpr([&](double c) { return std::abs(c) < 1e-9 * size.norm() ? 0.0 : c; });
        return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", plain[0], plain[1], plain[2]);
      };
      const std::string inertia_over_mass =
          planar ? fmt::format("{:.6g} m2 in pitch", inertia(1, 1))
                 : fmt::format("[{:.6g}, {:.6g}, {:.6g}] m2", inertia(0, 0), inertia(1, 1), inertia(2, 2));
      fmt::print("\nMesh {} of {}: {} triangles, {:.6g} x {:.6g} x {:.6g} m{}\n", mesh.name, s.bodies[b].name,
                 mesh.surface->triangles().size(), size[0], size[1], size[2],
                 planar ? fmt::format("; of its outline in the plane y = {:g} m, {:g} m wide", s.bodies[b].options.centre_m[1],
                                      s.sea.particles->width_m)
                        : "");
      fmt::print("  {:<22}{:.6g} m3 about {}; of even density its inertia about there is the mass times {}\n", "volume",
                 share * surface.volume(), place(surface.centre()), inertia_over_mass);
      const Submerged under = submerged(surface, turn, now.position - turn * s.bodies[b].options.centre_m);
      if (!(under.volume > 0.0)) {
        fmt::print("  {:<22}above the water\n", "at the start");
        continue;
      }
      const double over = under.centre[2] - now.position[2];  // of the centre of buoyancy
      fmt::print("  {:<22}{:.6g} m3 ({:.6g} kg) under water, centre of buoyancy {}\n", "at the start", share * under.volume,
                 s.environment.water_density_kg_m3 * share * under.volume, place(under.centre));
      fmt::print("  {:<22}{:.6g} m2; metacentre over the centre of mass: {}{:+.4g} m in pitch\n", "waterplane",
                 share * under.area, planar ? "" : fmt::format("{:+.4g} m in roll, ", over + under.metacentric_radius_roll()),
                 over + under.metacentric_radius_pitch());
    }
}

void print_doubts(scene::Doubts doubts, const scene::Doubts& more) {
  append(doubts, more);
  if (doubts.empty()) return;
  fmt::print("\nDoubts: possible, but it looks like a slip\n");
  for (const scene::Doubt& doubt : doubts) fmt::print("  warning: {}\n", text(doubt));
}

/// A start that cannot be found is refused; what looks like the slip behind it is told first.
coupling::Start start_or_doubts(FloatingSystem& floating, const scene::Doubts& angles, bool prints) {
  try {
    return make_start(floating);
  } catch (const std::exception&) {  // refused, or not to be found
    if (prints) print_doubts(angles, coupling::doubts_as_described(floating));
    throw;
  }
}

/// Of a run that begins with what this check has done, in `start_s` of processor time.
BaseCost base_cost(double start_s) { return {resident_memory() + output_bytes, start_s + output_seconds}; }

/// What moves by steps of its own, the engineering sea with it. Returns its processor time [s].
double print_steps(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Timeline& t = floating.timeline();
  const StepCost cost = measured_steps(floating, start);
  fmt::print("\nSize and cost\n");
  fmt::print("  {:<22}{} windows of {} s, {} step{} each ({})\n", "time", t.windows(), t.window_s(), t.steps_per_window(),
             t.steps_per_window() == 1 ? "" : "s", name(floating.multibody().integrator()));
  fmt::print(
      "  {:<22}{:.3g} core-s: {:.3g} steps of {:.3g} us{} and {:.3g} rows of history of {:.3g} us, measured now\n", "steps",
      cost.core_seconds(), cost.steps, 1e6 * cost.step_s,
      cost.exchanges > 0.0 ? fmt::format(", {:.3g} loads of the rotor of {:.3g} us", cost.exchanges, 1e6 * cost.exchange_s) : "",
      cost.rows, 1e6 * cost.row_s);
  return cost.core_seconds();
}

/// Of a run in which nothing has a solver of its own but the bodies.
void print_cost_of_steps(const coupling::Timeline& t, const BaseCost& base, double steps_s) {
  const double seconds = base.core_seconds + steps_s;
  fmt::print("  {:<22}{:.3g} ({:.3g} s on one core, {:.0f} times real time; {:.3g} s of them to start and for files)\n",
             "predicted core-hours", seconds / 3600.0, seconds, t.windows() * t.window_s() / seconds, base.core_seconds);
  fmt::print("  {:<22}{:.0f} MB\n", "memory", base.bytes / 1e6);
  for (const std::string& warning : beyond_machine(base.bytes, seconds)) fmt::print("  warning: {}\n", warning);
}

void print_equilibrium(FloatingSystem& floating, const bodies::Equilibrium& equilibrium) {
  const bodies::BodiesState& state = equilibrium.state;
  floating.multibody().open_chart(state, 0.0);  // brings dynamic lines to rest there
  const auto bodies = floating.multibody().bodies();
  const std::size_t lines = floating.moorings() ? floating.moorings()->size() : 0;
  const std::size_t junctions = floating.moorings() ? floating.moorings()->junctions() : 0;
  std::size_t width = 14;
  for (const auto& body : bodies) width = std::max(width, body.name.size());
  for (std::size_t line = 0; line < lines; ++line) width = std::max(width, floating.moorings()->name(line).size());
  for (std::size_t j = 0; j < junctions; ++j) width = std::max(width, floating.moorings()->junction_name(j).size());
  fmt::print("\nStatic equilibrium under the mean loads: wind, current, still water (displacements of the reference points)\n");
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const coupling::ReferenceMotion m = coupling::reference_motion(floating, b, state.motions[b]);
    const Eigen::Vector3d degrees = m.angles / radians_per_degree;
    const auto rounded = [](double value) { return 1e-3 * std::round(1e3 * value) + 0.0; };  // + 0: no minus before zero
    const bodies::Reach reach = bodies::reach(floating.scenario().bodies[b].options, state.motions[b]);
    const bool wet = floating.scenario().has_sea() && reach.any && reach.low < 0.0;
    fmt::print("  {:<{}}  x {:+.3f}  y {:+.3f}  z {:+.3f} m   roll {:+.3f}  pitch {:+.3f}  yaw {:+.3f} deg{}\n", bodies[b].name,
               width, rounded(m.displacement.x()), rounded(m.displacement.y()), rounded(m.displacement.z()), rounded(degrees.x()),
               rounded(degrees.y()), rounded(degrees.z()), wet ? fmt::format("   draft {:.3f} m", -reach.low) : "");
  }
  if (!equilibrium.unstable.empty()) fmt::print("  unstable: {}, which leaves this rest by itself\n", equilibrium.unstable);
  if (!floating.moorings()) return;
  const std::vector<moorings::LineTension> tensions = floating.moorings()->tensions(state.motions);
  for (std::size_t line = 0; line < lines; ++line) {
    const double tension = std::abs(tensions[line].fairlead) < 0.5 ? 0.0 : tensions[line].fairlead;  // but for round-off
    fmt::print("  {:<{}}  tension {:.4g} kN{}\n", floating.moorings()->name(line), width, 1e-3 * tension,
               tension < 0.0 ? fmt::format(": it pushes, as no rope does (moorings.{}.tension_only = false)",
                                           floating.moorings()->name(line))
                             : "");
  }
  const std::vector<LineEnd> ends = floating.moorings()->junction_motions(state.motions);
  for (std::size_t j = 0; j < junctions; ++j) {
    const Eigen::Vector3d& at = ends[j].position;
    fmt::print("  {:<{}}  x {:+.3f}  y {:+.3f}  z {:+.3f} m\n", floating.moorings()->junction_name(j), width, at.x(), at.y(),
               at.z());
  }
}

void print_blade_modes(const coupling::Scenario& one, const coupling::RotorSource& rotor) {
  if (!rotor.loads.flexible()) return;
  const aero::FlexibleBlades& blades = *rotor.loads.flexible();
  const double speed = one.rotor.speed;
  const auto hertz = [](const auto& omega) {
    return fmt::format("{:.3f}, {:.3f}, {:.3f} Hz", omega[0] / (2.0 * pi), omega[1] / (2.0 * pi), omega[2] / (2.0 * pi));
  };
  fmt::print("\nBlades {}of {:.0f} kg bend with {} at rest", one.rotors.empty() ? "" : "of " + spoken(rotor.name) + " ",
             blades.mass(), hertz(blades.omega()));
  if (speed != 0.0) fmt::print(", {} at {:.2f} rpm", hertz(blades.omega_turning(speed)), speed / rad_s_per_rpm);
  fmt::print(" (held hub)\n");
}

void print_all_blade_modes(const FloatingSystem& floating) {
  const std::vector<coupling::Scenario> each = coupling::by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n) print_blade_modes(each[n], floating.rotors()[n]);
}

/// Their names; those of equal name get numbers, "surge of float (1)". Modes that do not move are not shown, and not counted.
std::vector<std::string> told_apart(const std::vector<bodies::Mode>& modes) {
  std::map<std::string, int> all, so_far;
  for (const bodies::Mode& mode : modes)
    if (mode.eigenvalue != 0.0) ++all[mode.name];
  std::vector<std::string> names;
  for (const bodies::Mode& mode : modes)
    names.push_back(mode.eigenvalue != 0.0 && all[mode.name] > 1 ? fmt::format("{} ({})", mode.name, ++so_far[mode.name])
                                                                 : mode.name);
  return names;
}

/// Of the body that is let go fastest [m/s2].
double acceleration_at(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::MeanLoads mean(floating);
  double most = 0.0;
  for (const Eigen::Vector3d& a : floating.multibody().evaluate(start.state, 0.0).acceleration) most = std::max(most, a.norm());
  return most;
}

void print_modes(FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability) {
  const bodies::Linearisation& linearisation = stability.shown();
  fmt::print("\nModes about the {}{}\n", stability.at_rest ? "static equilibrium" : "start",
             floating.scenario().is_controlled() ? " (rotor speed and blade pitch held: what control adds is not in them)" : "");
  const std::vector<std::string> names = told_apart(linearisation.modes);
  for (std::size_t n = 0; n < names.size(); ++n)
    if (const bodies::Mode& mode = linearisation.modes[n]; mode.eigenvalue == 0.0)
      continue;
    else if (std::abs(mode.eigenvalue.imag()) > 1e-6)
      fmt::print("  {:<34}period {:8.3f} s ({:.4f} Hz)   damping {:.2f} % of critical\n", names[n], mode.period_s(),
                 1.0 / mode.period_s(), 1e-2 * std::round(1e4 * mode.damping_ratio()) + 0.0);  // + 0: no minus before zero
    else
      fmt::print("  {:<34}rate {:+.3g} 1/s{}\n", names[n], mode.eigenvalue.real(),
                 mode.eigenvalue.real() > 1e-4 ? ", grows by itself" : "");
  if (const Eigen::Index free = linearisation.freedoms_without_stiffness(); free > 0)
    fmt::print("  {} of {} freedoms without stiffness\n", free, linearisation.matrix.rows() / 2);
  if (!floating.beams().empty() && !floating.scenario().start.equilibrium && !stability.at_rest)
    fmt::print("  without the weight that softens beams: it does so in a static equilibrium, and none is known\n");
  constexpr double at_rest = 0.2;  // m/s2
  if (const double a = acceleration_at(floating, start); a > at_rest && !stability.at_rest)
    fmt::print("  the start is no equilibrium (it accelerates by {:.3g} m/s2): with start.equilibrium they may differ\n", a);
  if (floating.particle_plan() && !floating.sea() && !linearisation.modes.empty())
    fmt::print(
        "  without the water's inertia, which is known beforehand where all shapes are cylinders: true periods are longer\n");
  if (floating.sea() && floating.sea()->memory_size() > 0)
    fmt::print(
        "  with the added mass of infinite frequency; the waves that bodies make (radiation memory) damp these and change "
        "periods\n");
  const coupling::TimeOptions& time = floating.scenario().time;
  const std::string asked =
      floating.particle_plan() && !time.step_s ? "leaves it to the sea" : fmt::format("asks for {} s", time.step());
  fmt::print("\nLargest stable step (the scene {}, with {})\n", asked, name(time.integrator));
  for (const Integrator integrator : {Integrator::rk4, Integrator::symplectic, Integrator::explicit_euler}) {
    const bodies::StepLimit limit = step_limit(integrator, stability.linearisation);
    if (std::isinf(limit.step_s))
      fmt::print("  {:<16}any\n", name(integrator));
    else if (limit.step_s == 0.0)
      fmt::print("  {:<16}none: {} is not damped\n", name(integrator), limit.mode);
    else
      fmt::print("  {:<16}{:.4g} s, set by {}\n", name(integrator), limit.step_s, limit.mode);
  }
  if (!floating.particle_plan() || time.step_s)
    for (const bodies::Onset& onset : floating.multibody().watched())
      if (const double pieces = floating.multibody().pieces_at(onset, time.step()); pieces > 1.0)
        fmt::print(
            "  line {}: taut, the masses at its ends swing with {:.3g} 1/s; a step in which it snaps is made in {:.0f} pieces\n",
            onset.name, onset.rate, pieces);
}

/// Blank where there is none.
std::string hertz(double f) { return f > 0.0 ? fmt::format("{:.4f}", f) : "-"; }

/// Of these rotors, "rotor" or "rotors a, b".
void print_frequencies(const std::string& rotors, const coupling::Campbell& c) {
  fmt::print("\nFrequencies [Hz]: {}, waves and platform (wind and most probable waves by sea state after Lee et al. 1985)\n",
             rotors);
  fmt::print("  {:<14}{:>10}{:>10}{:>10}{:>10}{:>10}   within {:.0f} %\n", "", "wind m/s", "height m", "waves", "1P",
             fmt::format("{}P", c.blades), 100.0 * coupling::close);
  for (const coupling::CampbellRow& row : c.rows) {
    fmt::print("  {:<14}{:>10.2f}{:>10.2f}{:>10}{:>10}{:>10}   ", row.name, row.wind_m_s, row.wave_height_m, hertz(row.wave),
               hertz(row.once), hertz(row.passing));
    for (std::size_t i = 0; i < row.together.size(); ++i) fmt::print("{}{}", i ? ", " : "", row.together[i]);
    fmt::print("\n");
  }
  for (double wind : c.meets_waves_m_s) fmt::print("  1P meets the most probable waves at a wind of {:.1f} m/s\n", wind);
}

/// The rotor's, or one table for all rotors that turn alike.
void print_all_frequencies(const FloatingSystem& floating, const coupling::Start& start,
                           const bodies::Linearisation& linearisation) {
  std::vector<std::pair<std::string, coupling::Campbell>> tables;
  const std::vector<coupling::Scenario> each = coupling::by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n) {
    const coupling::RotorSource& rotor = floating.rotors()[n];
    coupling::Campbell c = campbell(each[n], linearisation, rotor.loads.state(0.0, start.state.motions).speed);
    const auto alike = std::ranges::find_if(tables, [&](const auto& table) {
      return std::ranges::equal(table.second.rows, c.rows, {}, &coupling::CampbellRow::once, &coupling::CampbellRow::once);
    });
    if (alike == tables.end())
      tables.emplace_back(spoken(rotor.name), std::move(c));
    else
      alike->first += ", " + spoken(rotor.name);
  }
  for (const auto& [rotors, c] : tables) print_frequencies(rotors, c);
}

void print_coupling(FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability) {
  if (floating.scenario().coupling.scheme == coupling::SchemeKind::monolithic) {
    fmt::print(
        "\nCoupling of rotor and platform: monolithic; the rotor answers in every evaluation of the bodies, nothing lags\n");
    return;
  }

  const double speed = floating.rotor()->state(0.0, start.state.motions).speed;
  const coupling::Campbell c = campbell(floating.scenario(), stability.shown(), speed);
  const coupling::FullLoads full(floating);
  const coupling::LooseVerdict verdict = loose_verdict(floating, start.state, c, stability.linearisation);
  if (verdict.schemes.empty()) {
    fmt::print("\nCoupling of rotor and platform: the bodies cannot move, any scheme will do\n");
    return;
  }
  fmt::print(
      "\nCoupling of rotor and platform (window {} s): mass at the hub {:.3g} kg, thrust falls {:.4g} kN per m/s, fastest {:.3g} "
      "Hz\n",
      floating.timeline().window_s(), verdict.hub_mass_kg, 1e-3 * verdict.slope_N_s_m, verdict.fastest_Hz);
  fmt::print("  1P {} Hz, {}P {} Hz; added mass of the blades' air {:.3g} kg, {:.2g} of the mass at the hub\n",
             hertz(c.rows.back().once), c.blades, hertz(c.rows.back().passing), verdict.air_mass_kg, verdict.mass_ratio());
  bool will_do = false;
  for (const auto& scheme : verdict.schemes) {
    will_do = will_do || scheme.will_do;
    fmt::print(
        "  {:<6}stable for windows {} and added mass up to {:.3g} of the mass; misses {:.2g} % of a load at that frequency: {}\n",
        scheme.name,
        std::isinf(scheme.window_limit_s) ? std::string("of any length") : fmt::format("up to {:.3g} s", scheme.window_limit_s),
        scheme.mass_ratio_limit, 100.0 * scheme.missed, scheme.will_do ? "will do" : "will not do");
  }
  fmt::print("  {}\n", will_do ? "A loose scheme will do."
                               : "No loose scheme will do at this window: iterate (coupling.scheme) or shorten it.");
  if (!c.rows.back().together.empty())
    fmt::print("  Frequencies of this scene lie together: response there is sensitive to phase; compare with a strong scheme.\n");
}

void print_far_sides(const aero::RotorGridOptions& grid) {
  if (const std::string note = far_side_note(grid); !note.empty()) fmt::print("  note: {}\n", note);
}

/// What the walls' first cells will see of the boundary layer, before a run tells.
void print_first_cells(const aero::FirstCells& cells, const char* plate, const std::string& remedy) {
  if (cells.resolved.empty() && cells.by_law.empty()) return;
  fmt::print("\nFirst cells at walls, y+ as on a flat plate of {}\n", plate);
  if (!cells.resolved.empty()) fmt::print("  {:<24}{}\n", "resolved", describe(cells.resolved));
  if (!cells.by_law.empty()) fmt::print("  {:<24}{}\n", "by the law of the wall", describe(cells.by_law));
  const bool lines_known = std::ranges::any_of(cells.resolved, [](const aero::FirstCell& c) { return c.growth > 1.0; });
  if (lines_known)
    fmt::print("  {:<24}{}, up to y+ {:g}\n", "growth off resolved", describe_growth(cells.resolved), aero::wall_layer_y_plus);
  for (const std::string& doubt : doubts_of(cells, remedy)) fmt::print("  warning: {}\n", doubt);
}

/// Makes the grid of a resolved rotor: whether it can be made and shared out is known then. Not of so many cells that it takes
/// more than some seconds.
void try_grid(const aero::ResolvedRotorSetup& setup, int ranks) {
  constexpr long made_at_most = 2'000'000;
  if (aero::resolved_rotor_size(setup).cells << 3 * setup.grid.coarsen > made_at_most) return;
  const std::shared_ptr<const aero::MadeRotorGrid> made = aero::made_rotor_grid(setup);
  aero::require_ranks(std::size_t(aero::rotor_tiling(setup.flow, made->grid, made->edges).size()), ranks);
}

/// Of a resolved rotor on bodies; what is said of its loads elsewhere is by blade elements.
aero::ResolvedRotorSetup resolved_rotor_on(const FloatingSystem& floating, const coupling::Start& start) {
  aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(floating.scenario());
  setup.rotor.speed = floating.rotor()->state(0.0, start.state.motions).speed;
  return setup;
}

PartCost print_air(const FloatingSystem& floating, const coupling::Start& start, bool calibrate) {
  const coupling::Scenario& s = floating.scenario();
  const aero::ResolvedRotorSetup setup = resolved_rotor_on(floating, start);
  const aero::ResolvedRotorSize size = aero::resolved_rotor_size(setup);
  fmt::print("\nResolved air (estimates above take the rotor's load from blade elements)\n");
  fmt::print("  {:<22}{} in {} sector{}, {} rows of faces along each blade\n", "cells", size.cells, size.sectors,
             size.sectors == 1 ? ", which follows the hub along the axis only" : "s", size.stations);
  print_far_sides(setup.grid);
  print_first_cells(expected_first_cells(setup), "the blade's chord", coupling::more_layers(s));
  const bool strong = is_strong(s.coupling.scheme);
  return cost_of_air(setup, size, coupled_pseudo_steps(s), s.start.air_steps, strong ? 2 : 1, calibrate);
}

/// The turbulence model, or what the flow is without one.
std::string friction_of(const aero::FlowOptions& flow) {
  return flow.viscous == "none" ? "inviscid" : flow.turbulence == "none" ? "laminar" : flow.turbulence;
}

void print_resolved_rotor(const coupling::Scenario& s, const scene::Doubts& angles, bool calibrate, int ranks,
                          const BaseCost& base) {
  const aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
  const aero::ResolvedRotorSize size = aero::resolved_rotor_size(setup);
  fmt::print("\nWhat will be modelled\n");
  fmt::print("  {:<10}{}, {}, {}\n", "air", setup.flow.time, friction_of(setup.flow), setup.flow.flux);
  fmt::print("  {:<10}{}\n", "rotor", coupling::describe_rotor(s));
  fmt::print("  {:<10}{} sector{}, {} rows of faces along each blade\n", "grid", size.sectors,
             size.sectors == 1 ? ", periodic" : "s", size.stations);
  print_far_sides(setup.grid);
  print_doubts(angles, coupling::air_doubts(s));
  print_rotor_at_start(s);
  print_first_cells(expected_first_cells(setup), "the blade's chord", coupling::more_layers(s));
  const PartCost cost = cost_of_air(setup, size, expected_pseudo_steps(s), 0.0, 1, calibrate);
  print_cost(std::span(&cost, 1), s.time.end_s, ranks, base, setup.flow.time == "steady");
}

/// What a patch of this name most likely is.
const char* likely_condition(const std::string& patch, bool viscous) {
  const auto has = [&](const char* word) { return patch.find(word) != std::string::npos; };
  if (has("sym")) return "symmetry";
  if (has("wall") || has("solid") || has("blade") || has("wing") || has("foil") || has("body"))
    return viscous ? "no_slip" : "slip";
  return "far_field";
}

bool has_condition(const aero::FlowOptions& o, const std::string& patch) {
  return std::ranges::any_of(o.boundaries, [&](const aero::PatchOptions& b) { return b.patch == patch; });
}

/// Size of a grid that stands, its patches with their conditions; a block to paste where some have none. False then.
bool print_flow_grid(const aero::FlowOptions& o, const aero::MultiBlockGrid& grid, int ranks) {
  std::size_t cells = 0;
  for (const aero::Block& b : grid.blocks) cells += std::size_t(b.ni) * b.nj * b.nk;
  std::map<std::string, long> faces;
  for (const aero::Boundary& b : grid.boundaries)
    faces[b.patch] += long(b.where.high[0] - b.where.low[0]) * (b.where.high[1] - b.where.low[1]);
  fmt::print("  {:<10}{} cells in {} block{}{}\n", "", cells, grid.blocks.size(), grid.blocks.size() == 1 ? "" : "s",
             grid.planar ? ", planar" : "");
  std::vector<std::string> missing;
  fmt::print("\nPatches of the grid\n");
  for (const auto& [patch, count] : faces) {
    const bool given = has_condition(o, patch);
    fmt::print("  {:<22}{} faces{}\n", patch, count, given ? "" : ", no condition yet");
    if (!given) missing.push_back(patch);
  }
  if (missing.empty()) {
    const aero::Tiling tiling = aero::flow_tiling(o, grid);
    aero::patch_conditions(o, tiling);  // a condition for no patch is refused
    aero::require_ranks(std::size_t(tiling.size()), ranks);
    return true;
  }
  fmt::print("\nEach patch needs a condition. To paste under [aero.flow], after a look at each line:\n\nboundaries = [\n");
  for (const auto& [patch, count] : faces)
    fmt::print("  {{patch = \"{}\", condition = \"{}\"}},\n", patch, likely_condition(patch, o.viscous != "none"));
  fmt::print("]\n");
  return false;
}

/// Of an actuator that bodies carry; nothing where patches lack a condition.
std::optional<PartCost> print_actuated_air(const coupling::Scenario& s, int ranks) {
  const aero::MultiBlockGrid grid = aero::flow_grid(*s.aero.flow);
  const auto [rotor, hub_key] = coupling::placed_rotor(s);
  aero::require_rotor_inside(grid, rotor, hub_key);
  aero::require_inflow_plane_inside(grid, s.wind, coupling::wind_site(s));
  fmt::print("\nResolved air (estimates above take the rotor's load from blade elements)\n  {:<10}{}\n", "grid",
             aero::describe_flow_grid(*s.aero.flow));
  if (!print_flow_grid(*s.aero.flow, grid, ranks)) return {};
  return cost_of_flow(s, grid);
}

aero::FirstCells first_cells_of(const coupling::Scenario& s, const aero::MultiBlockGrid& grid) {
  const aero::FlowOptions& o = *s.aero.flow;
  return expected_first_cells(grid, o, flow_setting(o, s.environment.air_density_kg_m3, coupling::flow_wind(s), s.time.window_s));
}

}  // namespace

namespace {

std::string changed_by(const std::optional<double>& change) { return change ? fmt::format("{:+.2g}", *change) : "unknown"; }

/// With quotes for a shell where it needs them.
std::string as_option(const std::string& override_text) {
  const char* quote = override_text.find_first_of("\"[") == std::string::npos ? "" : "'";
  return fmt::format(" --set {0}{1}{0}", quote, override_text);
}

/// As a section of a study may be called.
std::string as_name(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
  return text;
}

/// A study that tells what a trial cannot: its text, to be put into a file.
void print_study(const CheckArguments& arguments, const Trial& trial) {
  const auto listed = [](const std::vector<std::string>& overrides) {
    std::string text;
    for (const std::string& o : overrides) text += fmt::format("{}'{}'", text.empty() ? "" : ", ", o);
    return text;
  };
  fmt::print("\n[study]\nscene = \"{}\"\n", std::filesystem::absolute(arguments.scene).lexically_normal().string());
  if (!arguments.overrides.empty()) fmt::print("set = [{}]\n", listed(arguments.overrides));
  fmt::print("\n[variants.the_scene_itself]\n");
  for (const Omission& o : trial.omissions)
    fmt::print("[variants.{}]\nset = [{}]\n", as_name(o.choice.name), listed(o.choice.overrides));
  fmt::print("\n[reference]\nvariant = \"the_scene_itself\"\n");
  for (const std::string& column : arguments.columns)
    fmt::print("\n[metrics.{}]\ncolumn = \"{}\"\nmeasure = \"{}\"\n", as_name(column), column, trial.steady ? "last" : "mean");
}

/// What could be left out, with its price in the columns asked for.
void print_omissions(const CheckArguments& arguments) {
  const std::vector<std::string>& columns = arguments.columns;
  if (columns.empty()) return;
  std::fflush(stdout);  // what has been said can be read meanwhile
  const double budget_s = arguments.trial_s > 0.0 ? arguments.trial_s : usual_trial_s;
  const Trial trial = try_omissions(arguments.scene, arguments.overrides, columns, budget_s);
  if (!trial.untried.empty()) {
    fmt::print("\nWhat could be left out: not tried, it would take {}\n", trial.untried);
    if (trial.forecast_s > budget_s)
      fmt::print("  a trial has {:g} s; --trial-s {:.0f} gives it as many\n", budget_s, std::ceil(trial.forecast_s));
    fmt::print("  or put this into a file for spindrift study, which can be stopped and goes on:\n");
    print_study(arguments, trial);
    return;
  }
  const std::string length = trial.whole() ? fmt::format("over the whole run, {:g} s", trial.end_s)
                                           : fmt::format("over {:g} of {:g} s, as far as {:g} s of processor time carry",
                                                         trial.length_s, trial.end_s, budget_s);
  const std::string steady = fmt::format("until the march ends, within {:g} s", trial.end_s);
  fmt::print("\nWhat could be left out (tried {}; change of {})\n", trial.steady ? steady : length,
             trial.steady ? "the value there" : "mean and deviation over their last two thirds");
  for (const std::string& why : trial.unlike) fmt::print("  effects unknown, the trial is not like the run: {}\n", why);
  if (!trial.whole() && trial.unlike.empty()) fmt::print("  unknown: no larger than its scatter between parts of the trial\n");
  for (std::size_t c = 0; c < columns.size(); ++c)
    fmt::print("  {:<30}{}: mean {:.4g}, deviation {:.4g}\n", c == 0 ? "the scene itself" : "", columns[c], *trial.own[c].mean,
               *trial.own[c].deviation);
  for (const Omission& o : trial.omissions) {
    if (!o.refused.empty()) {
      fmt::print("  {:<30}cannot be: {}\n", o.choice.name, o.refused);
      continue;
    }
    const double percent = 100.0 * o.saving.error;
    if (o.saving.shows())
      fmt::print("  {:<30}saves {:.0f} % (+- {:.1g}), by", o.choice.name, 100.0 * o.saving.share, percent);
    else
      fmt::print("  {:<30}saves nothing that shows (+- {:.1g} %), by", o.choice.name, percent);
    for (const std::string& text : o.choice.overrides) fmt::print("{}", as_option(text));
    fmt::print("\n");
    if (o.choice.in_plane && std::ranges::any_of(columns, is_out_of_plane))
      fmt::print("  {:<30}bodies stay in the plane: sway, roll and yaw are lost\n", "");
    for (std::size_t c = 0; c < columns.size(); ++c)
      fmt::print("  {:<30}{}: mean {}, deviation {}\n", "", columns[c], changed_by(o.effects[c].mean),
                 changed_by(o.effects[c].deviation));
  }
}

/// Prints all but the verdict and what could be left out; bad_input where patches lack a condition.
int check_as_read(const CheckArguments& arguments, const runtime::World& world, scene::Document& document,
                  coupling::Scenario scenario, double begin_s) {
  coupling::require_memory(scenario, coupling::machine_memory() * world.size);
  if (scenario.has_flow()) require_expected_columns(document, scenario.output, columns_of_air_alone());
  if (scenario.has_flow() && has_resolved_rotor(scenario)) {
    try_grid(coupling::resolved_rotor_setup(scenario), world.size);
    if (world.rank != 0) return done;
    print_resolved_rotor(scenario, scene::angle_doubts(document.echo()), arguments.calibrate, world.size, base_cost(0.0));
    return done;
  }
  if (scenario.has_flow()) {
    const double resident = resident_memory();
    const aero::MultiBlockGrid grid = aero::flow_grid(*scenario.aero.flow);
    if (scenario.has_actuator()) {
      aero::require_rotor_inside(grid, scenario.rotor, "rotor.hub_m");
      aero::require_inflow_plane_inside(grid, scenario.wind, coupling::wind_site(scenario));
    }
    if (world.rank != 0) return done;
    fmt::print("\nWhat will be modelled\n  {:<10}{}, {}, grid {}\n", "air", scenario.aero.flow->time,
               friction_of(*scenario.aero.flow), aero::describe_flow_grid(*scenario.aero.flow));
    if (!print_flow_grid(*scenario.aero.flow, grid, world.size)) return bad_input;
    print_doubts(scene::angle_doubts(document.echo()), coupling::air_doubts(scenario));
    if (scenario.has_actuator()) print_rotor_at_start(scenario);
    print_first_cells(first_cells_of(scenario, grid), "their length", coupling::more_layers(scenario));
    const double start_s = processor_seconds() - begin_s;
    const PartCost cost = cost_of_flow(scenario, grid);
    print_cost(std::span(&cost, 1), scenario.time.end_s, world.size, {resident + output_bytes, start_s + output_seconds},
               scenario.aero.flow->time == "steady");
    return done;
  }
  const coupling::OutputOptions output = scenario.output;
  FloatingSystem floating(std::move(scenario));
  require_expected_columns(document, output, columns_of(floating));
  const scene::Doubts angles = scene::angle_doubts(document.echo());
  const coupling::Start start = start_or_doubts(floating, angles, world.rank == 0);
  const coupling::Stability stability = coupling::stability(floating, start.state);
  if (has_resolved_rotor(floating.scenario())) try_grid(resolved_rotor_on(floating, start), world.size);
  const SavedParts saved = open_saved_parts(world.comm, floating, start);
  const double start_s = processor_seconds() - begin_s;
  scene::Doubts accepted;
  std::optional<scene::SceneError> refusal;  // told below what helps to mend it
  try {
    accepted = require_limits(floating, start.state, stability);
  } catch (const scene::SceneError& e) { refusal = e; }
  if (world.rank == 0) {
    print_models(floating);
    for (const std::string& note : start.notes) fmt::print("  note: {}\n", note);
    for (const std::string& note : coupling::resolution_notes(floating)) fmt::print("  note: {}\n", note);
    print_doubts(angles, coupling::doubts(floating, start, stability));
    if (floating.rotor() && !start.state.motions.empty()) print_rotors_at_start(floating, start);
    if (!start.state.motions.empty()) print_modes(floating, start, stability), print_all_blade_modes(floating);
  }
  if (refusal) throw *refusal;
  if (world.rank != 0) return done;
  print_doubts(accepted, {});
  const BaseCost base = base_cost(start_s);  // before what a census or a grid leaves behind
  if (start.state.motions.empty()) {
    print_meshes(floating, start);
    const PartCost cost = print_particles(floating, start, saved);
    print_cost(std::span(&cost, 1), floating.scenario().time.end_s, world.size, base);
    return done;
  }
  if (floating.rotor()) {
    print_all_frequencies(floating, start, stability.shown());
    print_coupling(floating, start, stability);
  }
  const auto equilibrium_now = [&] {
    const coupling::MeanLoads mean(floating);
    return find_equilibrium(floating.multibody(), start.state, 0.0);
  };
  if (!coupling::has_level_water(floating.scenario()))
    fmt::print("\nStatic equilibrium: not sought, as the water of [[sea.water]] is not level at z = 0 from side to side\n");
  else if (const bodies::Equilibrium found = start.equilibrium ? *start.equilibrium
                                             : stability.rest  ? *stability.rest
                                                               : equilibrium_now();
           found.problem.empty())
    try {
      print_equilibrium(floating, found);
    } catch (const NumericalFailure& failure) {  // of a line that no run has to bring to rest there
      fmt::print("\nStatic equilibrium: {}\n", failure.what());
    }
  else
    fmt::print("\nStatic equilibrium: none found ({})\n", found.problem);
  std::vector<PartCost> parts;
  if (floating.scenario().has_actuator()) {
    const std::optional<PartCost> air = print_actuated_air(floating.scenario(), world.size);
    if (!air) return bad_input;
    parts.push_back(*air);
  } else if (floating.scenario().resolves_air())
    parts.push_back(print_air(floating, start, arguments.calibrate));
  if (floating.particle_plan()) {
    print_meshes(floating, start);
    parts.push_back(print_particles(floating, start, saved));
    print_cost(parts, floating.scenario().time.end_s, world.size, base);
  } else if (const double steps_s = print_steps(floating, start); parts.empty())
    print_cost_of_steps(floating.timeline(), base, steps_s);
  else
    print_cost(parts, floating.scenario().time.end_s, world.size, {base.bytes, base.core_seconds + steps_s});
  return done;
}

}  // namespace

int check(const CheckArguments& arguments, const runtime::World& world) {
  const double begin_s = processor_seconds();
  scene::Document document = load_scene(arguments.scene, arguments.overrides);
  coupling::Scenario scenario = coupling::read_scenario(document);
  HeldOutput held;
  int code = done;
  try {
    code = by_lines_at_rest(document, [&] { return check_as_read(arguments, world, document, std::move(scenario), begin_s); });
  } catch (...) {
    if (!held.empty()) held.release(arguments.scene + ": refused, for the reason at the end\n");
    throw;
  }
  if (world.rank != 0) return code;
  held.release(fmt::format("{}: {}\n", arguments.scene, code == done ? "valid" : "not yet valid, patches lack a condition"));
  if (code == done) print_omissions(arguments);
  return code;
}

}  // namespace spindrift::app
