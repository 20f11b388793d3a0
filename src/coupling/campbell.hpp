// Frequencies of rotor, waves and platform side by side, and whether a loose scheme will do: the "Campbell" diagram of Leble &
// Barakos (2016), section 2.4, with the most probable wind and waves by sea state after Lee, Bales & Sowby (1985). A loose scheme
// is judged by its stability with the air's added mass and with the rotor's aerodynamic damping, and by the part of a load that
// it misses at the fastest frequency at work. Printed by `spindrift check`; tested in tests/src/coupling/campbell_test.cpp.
// Theory: docs/theory/coupling.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kernels/coupling/staggered.hpp"
#include "src/bodies/linearise.hpp"
#include "src/coupling/floating_system.hpp"

namespace spindrift::coupling {

/// Open-ocean North Atlantic: middle of the wind range, mean significant height, most probable modal period.
struct SeaState {
  int number;
  double wind_m_s, height_m, period_s;
};
inline constexpr double m_s_per_knot = 1852.0 / 3600.0;
inline constexpr std::array<SeaState, 5> sea_states{{{2, 8.5 * m_s_per_knot, 0.3, 7.5},
                                                     {3, 13.5 * m_s_per_knot, 0.88, 7.5},
                                                     {4, 19.0 * m_s_per_knot, 1.88, 8.8},
                                                     {5, 24.5 * m_s_per_knot, 3.25, 9.7},
                                                     {6, 37.5 * m_s_per_knot, 5.0, 12.4}}};

/// One operating point: what turns and what shakes [Hz].
struct CampbellRow {
  std::string name;                   ///< "sea state 4", "this scene"
  double wind_m_s, wave_height_m;     ///< 0 where there is none
  double wave, once, passing;         ///< waves, 1P, blades passing (3P of three); 0 where there is none
  std::vector<std::string> together;  ///< pairs within `close` of each other: "1P and waves"
};
inline constexpr double close = 0.1;

struct Campbell {
  int blades = 3;
  std::vector<CampbellRow> rows;
  std::vector<std::pair<std::string, double>> platform;  ///< name and frequency [Hz] of the modes that oscillate
  std::vector<double> meets_waves_m_s;                   ///< winds at which 1P crosses the waves of the sea states
};
/// Of the rotor of one of by_rotor; 3 where no turbine file tells.
int blades_of(const Scenario& scenario);
/// `scenario`: one of by_rotor; `speed`: its rotor's own [rad/s].
Campbell campbell(const Scenario& scenario, const bodies::Linearisation& linearisation, double speed);

/// Part of a load going as exp(i omega t) that a scheme's assumption misses, at its worst within a window.
double missed_part(const Staggering& scheme, double omega, double window);

/// How a loose scheme fares on the floating system.
struct LooseVerdict {
  double hub_mass_kg = 0.0;  ///< effective mass of the hub's axial motion, water included
  double air_mass_kg = 0.0;  ///< that blades moving across their chords carry along, where a turbine file tells
  double slope_N_s_m = 0.0;  ///< thrust lost per m/s downwind
  double mass_ratio() const { return hub_mass_kg > 0.0 ? air_mass_kg / hub_mass_kg : 0.0; }
  double fastest_Hz = 0.0;  ///< of waves, blades passing and platform modes that oscillate, no stretching or twisting of a beam
  struct Scheme {
    std::string name;
    double window_limit_s;    ///< above it the floating system grows under the rotor's damping; infinite where there is none
    double missed;            ///< at the scene's window
    double mass_ratio_limit;  ///< of added mass over mass; above it no window is short enough
    bool will_do;             ///< below half of both limits, and less than `acceptable` missed
  };
  std::vector<Scheme> schemes;  ///< the loose ones: cps, cps2, css1; the scene's own by its options
};
inline constexpr double acceptable = 0.02;
/// `linearisation`: about `state`, the rotor's load in it.
LooseVerdict loose_verdict(FloatingSystem& floating, const bodies::BodiesState& state, const Campbell& campbell,
                           const bodies::Linearisation& linearisation);

}  // namespace spindrift::coupling
