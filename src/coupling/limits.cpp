// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::coupling {

void require_followed_lines(FloatingSystem& floating) {
  const bodies::System& bodies = floating.multibody();
  const TimeOptions& time = floating.scenario().time;
  if (floating.particle_plan() && !time.step_s) return;  // their steps are short, and each is made in pieces
  for (const bodies::Onset& onset : bodies.watched()) {
    const double pieces = bodies.pieces_at(onset, time.step());
    if (pieces <= bodies::System::most_pieces) continue;
    const auto line = std::ranges::find_if(floating.scenario().moorings, [&](const auto& l) { return l.name == onset.name; });
    const moorings::LineOptions& o = line->options;
    if (moorings::line_models().named(o.model).hangs) continue;  // it may sag for ever, however little it stretches
    const char* key = o.stiffness_N_m ? ".stiffness_N_m" : o.axial_stiffness_N ? ".axial_stiffness_N" : ".model";
    refuse(floating, "moorings." + onset.name + key,
           o.stiffness_N_m       ? fmt::format("{:g}", *o.stiffness_N_m)
           : o.axial_stiffness_N ? fmt::format("{:g}", *o.axial_stiffness_N)
                                 : "\"" + o.model + "\"",
           fmt::format("when this line snaps taut, the masses at its ends swing with {:.3g} 1/s, and {} needs {:.3g} pieces of a "
                       "step to follow (time.step_s is {} s, at most {} pieces are made): give a shorter step, a softer line or "
                       "heavier bodies",
                       onset.rate, name(bodies.integrator()), pieces, time.step(), bodies::System::most_pieces));
  }
}

scene::Doubts require_stable_coupling(FloatingSystem& floating, const bodies::BodiesState& state,
                                      const bodies::Linearisation& linearisation) {
  scene::Doubts accepted;
  const CouplingOptions& o = floating.scenario().coupling;
  if (!floating.rotor() || !is_loose(o.scheme) || state.motions.empty()) return accepted;
  const CouplingScheme& chosen = of(o.scheme);
  const FullLoads full(floating);
  const Campbell frequencies = campbell(floating.scenario(), linearisation, floating.rotor()->state(0.0, state.motions).speed);
  const LooseVerdict verdict = loose_verdict(floating, state, frequencies, linearisation);
  const std::string scheme = chosen.judged(o);
  const auto beyond = [&](const char* key, const std::string& value, const std::string& limit, const std::string& why,
                          const std::string& mend) {
    if (!o.accept_unstable)
      refuse(floating, key, value, fmt::format("{}: {}, or say coupling.accept_unstable = true", why, mend));
    accepted.push_back({key, fmt::format("{} {}, accepted", value, why), limit, mend});
  };
  for (const LooseVerdict::Scheme& known : verdict.schemes) {
    if (known.name != scheme) continue;
    const std::string iterate = "iterate (coupling.scheme = \"iqn_ils\")";
    const double window = floating.timeline().window_s();
    if (window > known.window_limit_s)
      beyond("time.window_s", fmt::format("{}", window), fmt::format("below {:.3g} s", known.window_limit_s),
             fmt::format(
                 "is above the limit of {:.3g} s, from which with {} the bodies swing ever more, as the rotor's damping ({:.3g} "
                 "kN per m/s on {:.3g} kg at the hub) answers too late",
                 known.window_limit_s, scheme, 1e-3 * verdict.slope_N_s_m, verdict.hub_mass_kg),
             "shorten it or " + iterate);
    if (verdict.mass_ratio() > known.mass_ratio_limit)
      beyond("coupling.scheme", "\"" + scheme + "\"", fmt::format("air of below {:.3g} of that mass", known.mass_ratio_limit),
             fmt::format("is unstable at any window: the air that the blades carry along is {:.3g} of the mass at the hub, the "
                         "limit is {:.3g}",
                         verdict.mass_ratio(), known.mass_ratio_limit),
             iterate);
  }
  return accepted;
}

/// Of all rotors on a body.
struct BladesCarried {
  int blades = 0;
  double mass = 0.0;  ///< [kg]
};

void require_bending_blades(const FloatingSystem& floating) {
  const std::vector<Scenario> each = by_rotor(floating.scenario());
  std::map<std::string, BladesCarried> carried;  // by body
  for (std::size_t n = 0; n < each.size(); ++n) {
    const aero::FlexibleBlades* blades = floating.rotors()[n].loads.flexible();
    if (!blades) continue;
    const Scenario& s = each[n];
    constexpr double per_step = 1.0;  // radians of the fastest mode: amplitudes go on as parabolas within a step
    const double fastest = blades->omega_turning(s.rotor.speed).back(), step = s.time.step();
    if (step * fastest > per_step)
      refuse(floating, "time.step_s", fmt::format("{}", step),
             fmt::format("is too long for blades whose fastest mode has {:.3g} Hz ({}.blade_structure): at most {:.3g} s",
                         fastest / (2.0 * pi), s.rotor_section, per_step / fastest));
    if (const double sag = blades->sag(s.environment.gravity_m_s2), most = floating.rotors()[n].radius / 3.0; sag > most)
      refuse(
          floating, s.rotor_section + ".blade_structure", "",
          fmt::format("a level blade sinks by {:.3g} m at its tip under its own weight, and its modes hold for bending of up to "
                      "a third of its length, {:.3g} m: look at the units, flap_N_m2 and edge_N_m2 in N m2, mass_kg_m in kg/m",
                      sag, most));
    BladesCarried& all = carried[s.rotor.body];
    all.blades += blades->blades(), all.mass += blades->blades() * blades->mass();
    for (const auto& body : s.bodies)
      if (body.name == s.rotor.body && body.options.mass_kg < all.mass)
        refuse(floating, "bodies." + body.name + ".mass_kg", fmt::format("{}", body.options.mass_kg),
               fmt::format("must be more than that of the {} blades it carries, {:.4g} kg by {}.blade_structure", all.blades,
                           all.mass, s.rotor_section));
  }
}

scene::Doubts require_limits(FloatingSystem& floating, const bodies::BodiesState& state, const Stability& stability) {
  require_room(floating, state);
  require_stable(floating, stability);
  require_followed_lines(floating);
  return require_stable_coupling(floating, state, stability.linearisation);
}

}  // namespace spindrift::coupling
