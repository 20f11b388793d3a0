// A rotor's induced velocities follow its load with a lag: Oye's two first-order filters behind the quasi-steady velocity.
// Oye (1990), in Snel & Schepers (1995), ECN-C--94-107; Hansen (2008), Aerodynamics of Wind Turbines, eqs. 9.17 to 9.22. Used by
// src/aero/bem.cpp; tested in tests/kernels/rotor/unsteady_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace spindrift {

/// y(t + h) of tau dy/dt = u - y where u goes on a straight line from u0 to u1: exact, for any step.
inline double lagged(double y, double u0, double u1, double h, double tau) {
  const double decay = std::exp(-h / tau), ramp = -std::expm1(-h / tau) * tau / h;
  return decay * y + (ramp - decay) * u0 + (1.0 - ramp) * u1;
}

struct DynamicInflowOye {
  static constexpr double share = 0.6;  ///< k, of a change that passes the first filter at once

  double near, far;  ///< tau_2, tau_1 [s]

  /// radius: of the element; tip: of the rotor [m]; wind [m/s] along the axis; induction: axial, mean over the disc.
  static DynamicInflowOye at(double radius, double tip, double wind, double induction) {
    constexpr double least_wind = 1.0;  // m/s; without wind the time constants have no end
    const double far = 1.1 / (1.0 - 1.3 * std::clamp(induction, 0.0, 0.5)) * tip / std::max(wind, least_wind);
    return of(radius, tip, far);
  }
  static DynamicInflowOye of(double radius, double tip, double far) {
    const double share_of_tip = radius / tip;
    return {(0.39 - 0.26 * share_of_tip * share_of_tip) * far, far};
  }

  /// One component of an element's induced velocity [m/s].
  struct Induced {
    double steady, middle, now;  ///< quasi-steady, behind the first filter, behind both
  };

  /// After h, at whose end the quasi-steady value is `steady`.
  Induced advance(const Induced& from, double steady, double h) const {
    const double jump = share * far * (steady - from.steady) / h;
    const double middle = lagged(from.middle, from.steady + jump, steady + jump, h, far);
    return {steady, middle, lagged(from.now, from.middle, middle, h, near)};
  }
};

}  // namespace spindrift
