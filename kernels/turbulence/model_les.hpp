// Eddy viscosities of large-eddy simulation, from the resolved velocity gradient and the cell's width: Smagorinsky (1963), Mon.
// Weather Rev. 91, 99, and WALE (Nicoud & Ducros 1999, Flow Turbul. Combust. 62, 183, eq. 13), which vanishes in pure shear and
// as the cube of the distance at walls. Nothing is transported. Called by src/aero/flow; tested in
// tests/kernels/turbulence/model_les_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/turbulence/model.hpp"

namespace spindrift::turbulence {

/// nu_t = (Cs Delta)^2 |S|. Cs after Lilly (1967) for a sharp cut in the inertial range: (2 / (3 C_K))^(3/4) / pi with C_K = 1.5.
struct Smagorinsky {
  static constexpr int equations = 0;
  static constexpr std::string_view name = "les_smagorinsky";
  static constexpr bool sees_grid = true;
  static constexpr double constant = 0.173;

  template <class Real>
  SPINDRIFT_INLINE Closure<Real, 0> closure(const Flow<Real>& f, const Turbulence<Real, 0>&) const {
    const Real length = constant * f.width;
    return {f.rho * length * length * strain(f), Real(0.0), {}};
  }
};

/// nu_t = (Cw Delta)^2 (Sd:Sd)^(3/2) / ((S:S)^(5/2) + (Sd:Sd)^(5/4)), Sd the symmetric part of the squared gradient without
/// trace.
struct Wale {
  static constexpr int equations = 0;
  static constexpr std::string_view name = "les_wale";
  static constexpr bool sees_grid = true;
  static constexpr double constant =
      0.5;  ///< their choice for isotropic turbulence: 0.55 to 0.60 with Cs 0.18; 0.5 in their tests

  template <class Real>
  SPINDRIFT_INLINE Closure<Real, 0> closure(const Flow<Real>& f, const Turbulence<Real, 0>&) const {
    const auto row = [&](const Vector<Real>& a) {  // of the squared gradient
      return Vector<Real>{a.x * f.u.x + a.y * f.v.x + a.z * f.w.x, a.x * f.u.y + a.y * f.v.y + a.z * f.w.y,
                          a.x * f.u.z + a.y * f.v.z + a.z * f.w.z};
    };
    const Vector<Real> a = row(f.u), b = row(f.v), c = row(f.w);
    const Real third = (1.0 / 3.0) * (a.x + b.y + c.z), xx = a.x - third, yy = b.y - third, zz = c.z - third;
    const Real xy = 0.5 * (a.y + b.x), xz = 0.5 * (a.z + c.x), yz = 0.5 * (b.z + c.y);
    const Real turning = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
    const Real rate = strain(f), strained = 0.5 * rate * rate;
    // As numbers of the order of one: the powers of either alone would overflow or vanish.
    const Real unit = strained + sqrt(turning + 1e-60), s = strained / unit, d = turning / (unit * unit);
    const Real root = sqrt(d + 1e-60), fourth = sqrt(root);
    const Real length = constant * f.width;
    return {f.rho * length * length * sqrt(unit) * (d * root) / (s * s * sqrt(s + 1e-60) + d * fourth), Real(0.0), {}};
  }
};
static_assert(TurbulenceModel<Smagorinsky> && TurbulenceModel<Wale>);

}  // namespace spindrift::turbulence
