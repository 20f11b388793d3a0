// The physical time of a march: how long its steps are and how much past there is. Owned by FlowSolver, read by its parts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

struct PhysicalTime {
  int order = 0;                  ///< 0 steady, 1 BDF1, 2 BDF2
  double dt = 0.0, before = 0.0;  ///< length of this step, and of the one before it [s]
  double older = 0.0;             ///< from the level before the last one to the end of the step that is being made [s]
  std::int64_t steps = 0;         ///< since the start
  TimeWeights weights{};          ///< of the step that is being made

  bool unsteady() const { return order > 0; }
  /// A step begins: weights by how much past there is.
  void begin_step() {
    const bool second = order > 1 && steps > 0;
    weights = second ? bdf2(dt / before) : bdf1;
    older = dt + before;
    before = dt;
    ++steps;
  }
};

}  // namespace spindrift::aero
