// The state at t = 0: constraints met, and where the scene asks for it in static equilibrium. What is wrong is said by joint and
// body. Used by src/run and by `spindrift check`; tested in tests/src/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/bodies/linearise.hpp"
#include "src/bodies/statics.hpp"
#include "src/coupling/floating_system.hpp"

namespace spindrift::coupling {

struct Start {
  bodies::BodiesState state;
  int degrees_of_freedom = 0;
  std::vector<std::string> notes;                  ///< redundant constraints, free directions
  std::optional<bodies::Equilibrium> equilibrium;  ///< where start.equilibrium asks for it
};

/// Throws scene::SceneError where joints contradict each other or no equilibrium exists.
Start make_start(FloatingSystem& floating);

/// Stability of the bodies' integrator about the state, under the mean loads.
struct Stability {
  bodies::Linearisation linearisation;
  bodies::StepLimit limit;
  /// Where beams do not start in equilibrium: the one that was sought, and the linearisation there if it was found. Weight
  /// softens a beam by the compression that only this state has.
  std::optional<bodies::Equilibrium> rest = {};
  std::optional<bodies::Linearisation> at_rest = {};
  /// The one whose modes are told and compared with what shakes.
  const bodies::Linearisation& shown() const { return at_rest ? *at_rest : linearisation; }
};
Stability stability(FloatingSystem& floating, const bodies::BodiesState& state);

/// Throws scene::SceneError where time.step_s exceeds the limit, naming the mode.
void require_stable(FloatingSystem& floating, const Stability& stability);

}  // namespace spindrift::coupling
