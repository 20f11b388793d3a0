// The physical time of a march: how long its steps are and how much past there is. Owned by FlowSolver, read by its parts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// Most past levels that are kept.
inline constexpr int most_levels = 4;

struct PhysicalTime {
  int order = 0;                             ///< 0 steady, 1 BDF1, 2 BDF2, 3 BDF3
  int levels = 0;                            ///< past ones that are kept
  double dt = 0.0;                           ///< length of this step [s]
  std::array<double, most_levels> before{};  ///< of those before it, the last one first [s]
  std::array<double, most_levels> ago{};     ///< from the past levels to the end of the step that is being made [s]
  std::int64_t steps = 0;                    ///< since the start
  TimeWeights weights{};                     ///< of the step that is being made

  bool unsteady() const { return order > 0; }
  /// Lengths of steps that the next one needs.
  int lengths() const { return std::max(1, levels - 1); }
  /// A step begins: weights by how much past there is.
  void begin_step() {
    const int reach = int(std::min<std::int64_t>(order, steps + 1));
    weights = backward_difference(reach, reach > 1 ? dt / before[0] : 1.0, reach > 2 ? before[0] / before[1] : 1.0);
    ago[0] = dt;
    for (std::size_t n = 1; n < ago.size(); ++n) ago[n] = ago[n - 1] + before[n - 1];
    std::copy_backward(before.begin(), before.end() - 1, before.end());
    before[0] = dt;
    ++steps;
  }
};

}  // namespace spindrift::aero
