// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace spindrift {

/// From 0 at t = 0 to 1 at t = 1 with level ends, 3 t^2 - 2 t^3; constant beyond.
inline double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace spindrift
