// Limits on the explicit step, after Monaghan (1992), section 10, and Monaghan & Kos (1999), J. Waterw. Port C. 125, eq. 10:
//   acoustic dt <= C h / (c0 + |v|max),  force dt <= C sqrt(h / |a|max),  viscous dt <= 0.125 h^2 / nu,
// and of a light floating body, whose particles carry the water's added mass: dt <= 2 sqrt(w n) d / c0 for n layers of relative
// weight w, of which src/sea takes half.
// Called by src/sea/sph; tested in tests/kernels/sph/step_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace spindrift::sph {

struct StepLimits {
  double acoustic, force, viscous;                        ///< [s]
  double body = std::numeric_limits<double>::infinity();  ///< of the lightest floating body [s]
  double smallest() const { return std::min({acoustic, force, viscous, body}); }
  const char* name() const {
    const double limit = smallest();
    return limit == body ? "light body" : limit == viscous ? "viscous" : limit == force ? "force" : "acoustic";
  }
};

inline StepLimits step_limits(double cfl, double h, double c0, double max_speed, double max_acceleration, double viscosity_m2_s) {
  const double none = std::numeric_limits<double>::infinity();
  return {cfl * h / (c0 + max_speed), max_acceleration > 0.0 ? cfl * std::sqrt(h / max_acceleration) : none,
          viscosity_m2_s > 0.0 ? 0.125 * h * h / viscosity_m2_s : none};
}

/// Largest stable step [s] of a floating body of `layers` particles across and weight relative to water, spacing [m].
inline double step_limit_body(double relative_weight, double layers, double spacing, double c0) {
  return 2.0 * std::sqrt(relative_weight * layers) * spacing / c0;
}

}  // namespace spindrift::sph
