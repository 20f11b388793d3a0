// SPDX-License-Identifier: Apache-2.0
#include "src/app/check_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "kernels/base/failure.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/recorder.hpp"

namespace spindrift::app {

using coupling::FloatingSystem;

namespace {

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

/// Their names; those of equal name get numbers from the lowest frequency on, "bending in x of tower (1)". Modes that do not move
/// are not shown, and not counted. @pre fastest first, as a linearisation has them
std::vector<std::string> told_apart(const std::vector<bodies::Mode>& modes) {
  std::map<std::string, int> all, so_far;
  for (const bodies::Mode& mode : modes)
    if (mode.eigenvalue != 0.0) ++all[mode.name];
  std::vector<std::string> names(modes.size());
  for (std::size_t n = modes.size(); n-- > 0;) {
    const bodies::Mode& mode = modes[n];
    names[n] = mode.eigenvalue != 0.0 && all[mode.name] > 1 ? fmt::format("{} ({})", mode.name, ++so_far[mode.name]) : mode.name;
  }
  return names;
}

/// Of the body that is let go fastest [m/s2].
double acceleration_at(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::MeanLoads mean(floating);
  double most = 0.0;
  for (const Eigen::Vector3d& a : floating.multibody().evaluate(start.state, 0.0).acceleration) most = std::max(most, a.norm());
  return most;
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

/// Nothing where no body can move by itself.
void print_mode_lines(FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability) {
  const bodies::Linearisation& linearisation = stability.shown();
  if (linearisation.modes.empty()) return;
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
  if (floating.particle_plan() && !floating.sea())
    fmt::print(
        "  without the water's inertia, which is known beforehand where all shapes are cylinders: true periods are longer\n");
  if (floating.sea() && floating.sea()->memory_size() > 0)
    fmt::print(
        "  with the added mass of infinite frequency; the waves that bodies make (radiation memory) damp these and change "
        "periods\n");
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

}  // namespace

std::string spoken(std::string name) {
  std::ranges::replace(name, '.', ' ');
  return name;
}

void print_statics(FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability) {
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
}

void print_modes(FloatingSystem& floating, const coupling::Start& start, const coupling::Stability& stability) {
  print_mode_lines(floating, start, stability);
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
  print_all_blade_modes(floating);
}

void print_frequencies_and_coupling(FloatingSystem& floating, const coupling::Start& start,
                                    const coupling::Stability& stability) {
  print_all_frequencies(floating, start, stability.shown());
  print_coupling(floating, start, stability);
}

}  // namespace spindrift::app
