// Local Lax-Friedrichs flux on a moving face (Rusanov 1961), the most dissipative scheme of the family.
// Robust start-up choice; use Osher or low-Mach Roe for results.
// Called by src/aero/flow; tested in tests/kernels/gas/flux_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/flux.hpp"

namespace spindrift::gas {

/// Largest speed of a wave relative to the face, of both sides.
template <class Real>
SPINDRIFT_INLINE Real rusanov_speed(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                    const Face<Real>& f) {
  return max(abs(normal_velocity(l, f) - f.speed) + sound_speed(gas, l),
             abs(normal_velocity(r, f) - f.speed) + sound_speed(gas, r));
}

struct Rusanov {
  static constexpr std::string_view name = "rusanov";
  template <class Real>
  SPINDRIFT_INLINE Conserved<Real> operator()(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                              const Face<Real>& f) const {
    const Real s = 0.5 * f.area * rusanov_speed(gas, l, r, f);
    return central_flux(gas, l, r, f) - s * (conserved(gas, r) - conserved(gas, l));
  }
};
static_assert(FluxScheme<Rusanov>);

}  // namespace spindrift::gas
