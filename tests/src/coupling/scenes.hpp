// Small scenes for the tests of the coupling, written as a user would.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/coupling/scenario.hpp"

namespace spindrift::coupling::test {

inline Scenario scenario(const std::string& text, const std::vector<std::string>& overrides = {}) {
  scene::Document document = scene::parse(text, "test.toml", SPINDRIFT_SOURCE_DIR, overrides);
  return read_scenario(document);
}

/// A buoy of 1 m radius that floats half under: mass rho pi R^2 2 m, on a vertical spring to the bed.
inline const char* const buoy = R"(
[time]
end_s = 2.0
window_s = 0.1
step_s = 0.02
[environment]
gravity_m_s2 = 10.0
water_density_kg_m3 = 1000.0
[sea]
model = "hydrostatic"
[bodies.buoy]
mass_kg = 6283.185307179586
inertia_kg_m2 = [1.0e4, 1.0e4, 1.0e4]
centre_m = [0.0, 0.0, -1.5]
[[bodies.buoy.cylinders]]
name = "hull"
start_m = [0.0, 0.0, -2.0]
end_m = [0.0, 0.0, 2.0]
diameter_m = 2.0
[moorings.chain]
body = "buoy"
fairlead_m = [0.0, 0.0, -2.0]
anchor_m = [0.0, 0.0, -20.0]
rest_length_m = 18.0
stiffness_N_m = 1.0e4
tension_only = false
)";

}  // namespace spindrift::coupling::test
