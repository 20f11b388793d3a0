// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/mode_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/aero/operation.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::coupling {

namespace {

/// What holds a rigid motion of this name where it is: the metacentric height for roll and pitch, lines for all others.
std::string what_holds(const std::string& mode) {
  if (mode.starts_with("roll") || mode.starts_with("pitch"))
    return "look at the height of the centre of mass (the metacentric height must be above zero), at the shapes and at the lines";
  return "look at the lines, at the loads that turn with it and at the shapes";
}

/// Of all modes, which come fastest first [1/s]; 0 without any.
double fastest_rate(const Stability& stability) {
  return stability.shown().modes.empty() ? 0.0 : std::abs(stability.shown().modes.front().eigenvalue);
}

/// Where the operating table's power first is its largest [m/s]; 0 without a table or its power.
double rated_wind(const aero::RotorOptions& rotor) {
  if (rotor.operation.empty()) return 0.0;
  const aero::Operation table = aero::read_operation(rotor.operation);
  constexpr double near_rated = 0.99;
  const std::size_t rated = table.first_above(near_rated);
  return rated < table.wind.size() ? table.wind[rated] : 0.0;
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

}  // namespace

/// Modes that grow: what the statics call unstable (metacentric height), and damping of the wrong sign.
scene::Doubts growth_doubts(const FloatingSystem& floating, const Stability& stability) {
  scene::Doubts doubts;
  if (floating.particle_plan()) return doubts;
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
  return doubts;
}

/// Gains of a fixed foundation above rated wind, on a turbine that pitches more slowly than they act (Larsen & Hanson 2007, J.
/// Phys.: Conf. Ser. 75, 012073). The modes, whose rotor keeps speed and pitch, do not show it.
scene::Doubts tuning_doubts(const Scenario& s, const Stability& stability) {
  scene::Doubts doubts;
  if (s.control.model != aero::ControlModel::dtu || s.control.tuning != aero::Tuning::fixed_foundation) return doubts;
  if (s.wind.speed_m_s < rated_wind(s.rotor)) return doubts;
  constexpr double fast_s = 12.0;  // the gains answer within some 10 to 17 s
  for (const bodies::Mode& mode : stability.shown().modes)
    if (mode.name == "pitch of " + s.rotor.body && mode.eigenvalue.imag() > 0.0 && mode.period_s() > fast_s)
      doubts.push_back(
          {"control.tuning",
           fmt::format("gains of a fixed foundation on {}, which pitches in {:.3g} s", s.rotor.body, mode.period_s()),
           fmt::format("\"floating\" where that takes longer than about {:g} s", fast_s),
           "above rated wind such gains take the air's damping away: the platform pitches ever more"});
  return doubts;
}

/// A motion that a flexible beam takes part in, and that the blades meet once or three times a turn.
scene::Doubts resonance_doubts(const FloatingSystem& floating, const aero::RotorLoads& rotor, int blades, const Start& start,
                               const Stability& stability) {
  scene::Doubts doubts;
  if (floating.beams().empty()) return doubts;
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
  return doubts;
}

scene::Doubts step_doubts(const FloatingSystem& floating, const Stability& stability) {
  scene::Doubts all;
  doubt_length(all, floating, stability);
  doubt_fine_step(all, floating, stability);
  doubt_coarse_step(all, floating, stability);
  doubt_window(all, floating, stability);
  return all;
}

}  // namespace spindrift::coupling
