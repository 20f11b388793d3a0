// The fourth kind of failure (docs/developer/errors.md): the numerics gave up. Kernels and steps return trouble as data; code
// that can neither repeat nor repair the step throws this, and the program ends with exit code 3 and its state saved. Thrown in
// src/ only; tested where it is thrown. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace spindrift {

/// A run cannot go on: what happened, where (body, joint, block ...), when, and the limit that was broken (0 where there is
/// none).
struct NumericalFailure : std::runtime_error {
  NumericalFailure(const std::string& what, std::string place, long step, double time_s, double limit = 0.0)
      : std::runtime_error(what), place(std::move(place)), step(step), time_s(time_s), limit(limit) {}
  std::string place;
  long step;
  double time_s;
  double limit;
};

}  // namespace spindrift
