// What a scene says to the resolved air: wind, whether there is a rotor in it, that rotor's set-up.
// Used by scenario.cpp, src/run and `spindrift check`; tested through tests/coupled/rotor_run_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/aero/flow/boundary.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/wind.hpp"
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
/// The undisturbed wind of a scene with a rotor.
aero::Wind rotor_wind(const Scenario& scenario);
/// How a step of the resolved air that ends at t takes it: empty where it is steady, which reads no file.
aero::UndisturbedWind wind_until(const aero::Wind& wind, double t);
inline aero::Wind changing_wind(const Scenario& scenario) { return scenario.wind.steady() ? aero::Wind{} : rotor_wind(scenario); }

}  // namespace spindrift::coupling
