// Static equilibrium of the loaded system: every body at rest, drivers held at their value of the given time.
// Newton on the independent coordinates with a stiffness by central differences, in mass-weighted coordinates: singular
// directions (no stiffness, no load: yaw without moorings) are found by rank and left where they are; where the stiffness is not
// positive the step is regularised and follows the force instead. Theory: docs/theory/bodies.md, "Statics". Used by src/coupling
// for [start] equilibrium; tested in tests/src/bodies/statics_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/bodies/system.hpp"

namespace spindrift::bodies {

struct EquilibriumOptions {
  int iterations = 200;
  double step_tolerance = 1e-10;  ///< last Newton correction, of the reference length or radians
  double turn_limit = 0.1;        ///< largest turn of a body in one iteration [rad]
  double shift_limit_m = 5.0;     ///< largest displacement of a body in one iteration, or turn_limit of the reference length [m]
  double free_fraction = 1e-8;    ///< stiffness over mass below this fraction of the largest counts as none
  double load_tolerance = 1e-7;   ///< load that a free direction may carry, as a fraction of all loads
};

struct Equilibrium {
  BodiesState state;  ///< at rest apart from drivers; the last iterate where there is a problem
  int iterations = 0;
  double residual = 0.0;                     ///< unbalanced load over all loads
  std::vector<std::string> free_directions;  ///< "yaw of platform": neither stiffness nor load; left as they were
  std::string unstable;                      ///< not empty: a direction in which the equilibrium is unstable
  std::string problem;                       ///< not empty: no equilibrium found, and why
};

Equilibrium find_equilibrium(System& system, const BodiesState& start, double t_s, const EquilibriumOptions& options = {});

}  // namespace spindrift::bodies
