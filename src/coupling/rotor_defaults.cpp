// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/rotor_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/aero/first_cells.hpp"
#include "src/aero/wind.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

/// What of the scene counts here, its mistakes unsaid: they are told where the scene is read.
Scenario look(scene::Document copy) {
  Scenario s;
  s.environment = copy.read(environment_section());
  s.aero = copy.read(aero::aero_section());
  s.rotor = copy.read(aero::rotor_section());
  s.wind = copy.read(aero::wind_section());
  s.wind.speed_m_s = aero::starting_speed(s.wind), s.wind.direction = aero::starting_direction(s.wind);
  s.joints = copy.read_named(bodies::joint_section());
  s.control = copy.read(aero::control_section());
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint && joint.rotation) s.rotor.speed = joint.rotation->rate;
  return s;
}

/// Whether all blades meet the same air and have the same pitch: then one sector stands for them.
bool blades_alike(const Scenario& s) {
  if (!aero::blows_along_axis(placed_rotor(s).rotor, flow_wind(s)) || !aero::wind_profile(s.wind).uniform()) return false;
  if (s.wind.varies_over_rotor() || aero::turns(s.wind)) return false;
  return !s.control.individual_pitch && std::ranges::none_of(s.control.events, [](const aero::EventOptions& event) {
    return event.what == aero::ControlEvent::blade_stuck;
  });
}

}  // namespace

void add_rotor_defaults(scene::Document& document) {
  std::vector<std::string> defaults;
  try {
    Scenario s = look(document);
    if (!has_resolved_rotor(s) || !s.aero.flow) return;
    const bool carried = document.given("bodies");
    if (carried) defaults.push_back("aero.flow.time=\"bdf2\"");
    const bool steps = document.given("aero.flow.time") ? s.aero.flow->time != "steady" : carried;
    if (steps) defaults.push_back("aero.flow.drop=1e-3");
    defaults.insert(defaults.end(), {"aero.flow.preconditioner=\"coarse\"", "aero.flow.cfl=2.0", "aero.flow.cfl_max=1000.0"});
    defaults.push_back(blades_alike(s) ? "aero.grid.sectors=\"one\"" : "aero.grid.sectors=\"all\"");
    if (s.aero.grid->y_plus && !document.given("aero.grid.kinematic_viscosity_m2_s")) {
      s.aero.grid->kinematic_viscosity_m2_s = s.aero.kinematic_viscosity(s.environment.air_density_kg_m3);
      defaults.push_back(fmt::format("aero.grid.kinematic_viscosity_m2_s={}", s.aero.grid->kinematic_viscosity_m2_s));
    }
    if (aero::suits_wall_law(resolved_rotor_setup(s))) defaults.push_back("aero.flow.blades=\"wall_function\"");
  } catch (const scene::SceneError&) {  // told where the file is read
  }
  document.add_defaults(defaults);
}

}  // namespace spindrift::coupling
