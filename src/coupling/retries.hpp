// A window that fails numerically is made again from the state at its start with smaller steps: how often, and how much smaller.
// Used by src/run for every simulation, and by the sides of a window; tested in tests/faults/divergence.toml.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/failure.hpp"

namespace spindrift::coupling {

inline constexpr int most_retries = 3;

/// Of a window that smaller steps would not mend: it is not made again.
struct LastingFailure : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

/// Of the n-th retry; 0: as the scene asks.
constexpr int pieces_of_step(int retry) { return 1 << (2 * retry); }         ///< of the bodies' step: 1, 4, 16, 64
constexpr double share_of_substep(int retry) { return 1.0 / (1 << retry); }  ///< of the sea's limit: 1, 1/2, 1/4, 1/8
/// Of the CFL number that the air began with.
constexpr double share_of_cfl(int retry) {
  constexpr double shares[most_retries + 1] = {1.0, 1e-1, 1e-2, 1e-3};
  return shares[retry];
}

}  // namespace spindrift::coupling
