// What a scene could do with less of, as overrides of its keys: coarser, shorter, looser, or another model. Each scene is offered
// the choices of what costs it most: particles, resolved air, else bodies and engineering loads. Called by leave_out.cpp; tested
// in tests/coupled/leave_out_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/coupling/scenario.hpp"
#include "src/scene/document.hpp"

namespace spindrift::app {

using Overrides = std::vector<std::string>;
Overrides operator+(Overrides a, const Overrides& b);

struct SmallerChoice {
  std::string name;       ///< "longer step"
  Overrides overrides;    ///< what makes it: "time.step_s=0.1"
  bool in_plane = false;  ///< bodies keep to a plane: sway, roll and yaw are lost
};

/// `scenario`: what the document says; of particles with their speed of sound, where the document leaves it to the program.
std::vector<SmallerChoice> smaller_choices(const coupling::Scenario& scenario, const scene::Document& document);

/// Whether a column of history is one of those that are lost where bodies keep to the plane of x and z.
bool is_out_of_plane(std::string_view column);

}  // namespace spindrift::app
