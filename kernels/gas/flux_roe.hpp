// Roe's flux on a moving face: Roe (1981), J. Comput. Phys. 43, 357; entropy fix of Harten & Hyman (1983), J. Comput. Phys. 50,
// 235, in the parabolic form of Harten (1983), J. Comput. Phys. 49, 357, eq. 3.15, on the acoustic speeds. Called by
// src/aero/flow; tested in tests/kernels/gas/flux_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/flux.hpp"

namespace spindrift::gas {

/// |x| rounded off below `width` to (x^2 + width^2) / (2 width); `inverse` = 1/width.
template <class Real>
SPINDRIFT_INLINE Real harten_abs(const Real& x, const Real& width, const Real& inverse) {
  const Real a = abs(x);
  return select(a < width, 0.5 * (x * x * inverse + width), a);
}

/// Speeds of the three families of waves relative to the face, rounded off by `entropy_fix` times c; the contact's only where
/// asked, because it would spread shear layers.
template <class Real>
struct WaveSpeeds {
  Real slow, middle, fast;
};
template <class Real>
SPINDRIFT_INLINE WaveSpeeds<Real> wave_speeds(const RoeMean<Real>& m, const Face<Real>& f, double entropy_fix) {
  const double fix = entropy_fix > 1e-12 ? entropy_fix : 1e-12;
  const Real un = m.un - f.speed, width = fix * m.c, inverse = (1.0 / fix) * m.inverse_c;
  return {harten_abs(un - m.c, width, inverse), abs(un), harten_abs(un + m.c, width, inverse)};
}

struct Roe {
  static constexpr std::string_view name = "roe";
  double entropy_fix = 0.1;  ///< width of Harten's rounding, in sound speeds; 0 none

  template <class Real>
  SPINDRIFT_INLINE Conserved<Real> operator()(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                              const Face<Real>& f) const {
    const RoeMean<Real> m = roe_mean(gas, l, r, f);
    const WaveSpeeds<Real> s = wave_speeds(m, f, entropy_fix);
    return central_flux(gas, l, m.rho_l, r, m.rho_r, f) -
           0.5 * wave_dissipation(gas, m, l, r, f, s.slow, s.middle, s.fast, Real(1.0));
  }
};
static_assert(FluxScheme<Roe>);

}  // namespace spindrift::gas
