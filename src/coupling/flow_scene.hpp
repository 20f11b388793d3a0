// What a scene says to the resolved air: wind, whether there is a rotor in it, that rotor's set-up.
// Used by scenario.cpp, src/run and `spindrift check`; tested through tests/coupled/rotor_run_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/aero/changing_wind.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

inline bool has_resolved_rotor(const Scenario& s) { return s.aero.model == "blade_resolved" && s.aero.grid.has_value(); }
/// The undisturbed wind with aero.flow.incidence_deg [m/s].
Eigen::Vector3d flow_wind(const Scenario& scenario);
/// Of a scene with a resolved rotor, which is where [rotor] puts it.
aero::ResolvedRotorSetup resolved_rotor_setup(const Scenario& scenario);

/// The rotor as it is described, with the hub and axis of its bearing where it has one, and the key that puts the hub there.
struct PlacedRotor {
  aero::RotorOptions rotor;
  std::string hub_key;
};
PlacedRotor placed_rotor(const Scenario& scenario);
/// [m], of the turbine file's blades or rotor.diameter_m; 0 where the scene has neither.
double rotor_radius(const Scenario& scenario);
aero::WindSite wind_site(const Scenario& scenario);
/// Where it is steady no file is read.
inline aero::ChangingWind changing_wind(const Scenario& scenario) {
  return scenario.wind.steady() ? aero::ChangingWind() : aero::ChangingWind(scenario.wind, wind_site(scenario));
}

}  // namespace spindrift::coupling
