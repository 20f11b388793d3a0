// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/staggered.hpp"
#include "kernels/mooring/line_spring_damper.hpp"
#include "kernels/rigid/stability.hpp"
#include "src/coupling/campbell.hpp"
#include "src/coupling/retries.hpp"

namespace spindrift::coupling {

namespace {

/// The place of a point that the scene gives on the body as it describes it; nothing for the earth, which does not move.
std::optional<bodies::Pull> pull_at(const Scenario& s, const bodies::BodiesState& state, const std::string& body,
                                    const Eigen::Vector3d& point) {
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    if (s.bodies[b].name != body) continue;
    const Motion described = described_motion(s.bodies[b].options);
    return bodies::Pull{b, state.motions[b].point(described.attitude.conjugate() * (point - described.position)), {}};
  }
  return std::nullopt;
}

}  // namespace

bodies::StepLimit taut_line_limit(FloatingSystem& floating, const bodies::BodiesState& state) {
  const Scenario& s = floating.scenario();
  bodies::StepLimit limit{std::numeric_limits<double>::infinity(), "", 0.0};
  for (const auto& [name, line] : s.moorings) {
    // The linearisation has the others as they are.
    if (line.model != LineSpringDamper::name || !line.tension_only) continue;
    const std::optional<bodies::Pull> fairlead = pull_at(s, state, line.body, *line.fairlead_m),
                                      anchor = pull_at(s, state, line.anchor_body, *line.anchor_m);
    const Eigen::Vector3d along =
        ((fairlead ? fairlead->point : *line.fairlead_m) - (anchor ? anchor->point : *line.anchor_m)).stableNormalized();
    std::vector<bodies::Pull> pulls;
    if (fairlead) pulls.push_back({fairlead->body, fairlead->point, along});
    if (anchor) pulls.push_back({anchor->body, anchor->point, -along});
    const double inverse_mass = bodies::mobility(floating.multibody(), state, pulls);
    const double stiffness = line.stiffness_N_m ? *line.stiffness_N_m : *line.axial_stiffness_N / line.rest_length_m;
    const double decay = 0.5 * line.damping_N_s_m * inverse_mass;
    const std::complex<double> root = std::sqrt(std::complex<double>(decay * decay - stiffness * inverse_mass));
    for (const std::complex<double> eigenvalue : {-decay + root, -decay - root})
      if (const double step = stability_limit(s.time.integrator, eigenvalue); step < limit.step_s)
        limit = {step, name, eigenvalue};
  }
  return limit;
}

void require_stable_lines(FloatingSystem& floating, const bodies::BodiesState& state) {
  const bodies::StepLimit limit = taut_line_limit(floating, state);
  const TimeOptions& time = floating.scenario().time;
  if (floating.particle_plan() && !time.step_s) {
    constexpr double margin = 0.9;
    if (limit.step_s > 0.0) floating.body_step_limit_s = std::min(floating.body_step_limit_s, margin * limit.step_s);
    return;
  }
  // A window in which rk4 finds its step too long is tried again with pieces of it; the others cannot tell.
  const double step = time.step(), least = time.integrator == Integrator::rk4 ? step / pieces_of_step(most_retries) : step;
  if (least <= limit.step_s) return;
  const auto taut =
      std::ranges::find_if(floating.scenario().moorings, [&](const auto& named) { return named.name == limit.mode; });
  const moorings::LineOptions& line = taut->options;
  refuse(floating, "moorings." + limit.mode + (line.stiffness_N_m ? ".stiffness_N_m" : ".axial_stiffness_N"),
         fmt::format("{:g}", line.stiffness_N_m ? *line.stiffness_N_m : *line.axial_stiffness_N),
         fmt::format("when this line snaps taut, {} needs steps of at most {:.3g} s with the masses at its ends, and a window "
                     "that fails is tried again with {:.3g} s at least (time.step_s is {} s): give a shorter step, a softer "
                     "line or heavier bodies",
                     name(floating.multibody().integrator()), limit.step_s, least, step));
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
  require_stable(floating, stability);
  require_stable_lines(floating, state);
  require_bending_blades(floating);
  return require_stable_coupling(floating, state, stability.linearisation);
}

}  // namespace spindrift::coupling
