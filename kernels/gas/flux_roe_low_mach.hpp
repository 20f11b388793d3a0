// Low-Mach Roe flux: Rieper (2011), J. Comput. Phys. 230, 5263, eq. 14: in the acoustic waves of Roe's flux the jump of the
// normal velocity is multiplied by the local Mach number where that is below one. The artificial viscosity of pressure on
// velocity then scales with rho |u| and not rho c, so its error does not grow as 1/M; the pressure jump in the mass flux, which
// ties even cells to odd ones, stays whole. On moving grids |u| is the velocity relative to the grid, so that a wing in a wind
// and a wing that flies have the same flux. Called by src/aero/flow; tested in tests/kernels/gas/flux_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/flux_roe.hpp"

namespace spindrift::gas {

struct RoeLowMach {
  static constexpr std::string_view name = "roe_low_mach";
  double entropy_fix = 0.1;  ///< as of Roe
  double mach_floor = 0.0;   ///< least scaling; 0 is Rieper's scheme
  static constexpr bool sees_tangential_speed = true;

  /// min(1, (|un| + |ut|) / c), both relative to the face.
  template <class Real>
  SPINDRIFT_INLINE Real scale(const RoeMean<Real>& m, const Face<Real>& f) const {
    const Real u = m.u - f.vx, v = m.v - f.vy, w = m.w - f.vz, un = u * f.nx + v * f.ny + w * f.nz;
    const Real tangential = sqrt(max(u * u + v * v + w * w - un * un, 0.0));
    return min(max((abs(m.un - f.speed) + tangential) * m.inverse_c, mach_floor), 1.0);
  }

  template <class Real>
  SPINDRIFT_INLINE Conserved<Real> operator()(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                              const Face<Real>& f) const {
    const RoeMean<Real> m = roe_mean(gas, l, r, f);
    const WaveSpeeds<Real> s = wave_speeds(m, f, entropy_fix);
    return central_flux(gas, l, m.rho_l, r, m.rho_r, f) -
           0.5 * wave_dissipation(gas, m, l, r, f, s.slow, s.middle, s.fast, scale(m, f));
  }
};
static_assert(FluxScheme<RoeLowMach>);

}  // namespace spindrift::gas
