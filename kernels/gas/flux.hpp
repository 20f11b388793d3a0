// What makes two numerical fluxes interchangeable, and the mean state that the Roe family shares.
// Roe (1981), J. Comput. Phys. 43, 357. A new flux is a new type in a new file that meets the concept.
// Called by kernels/gas/flux_*.hpp and src/aero/flow; laws of all members tested in tests/kernels/gas/flux_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>

#include "kernels/gas/state.hpp"

namespace spindrift::gas {

/// A numerical flux F(left, right, face) out of the left cell, times area: consistent, F(q,q,f) = f(q), and conservative,
/// F(l,r,f) = -F(r,l,-f).
template <class F, class Real = double>
concept FluxScheme = requires(const F scheme, IdealGas gas, const Primitive<Real>& q, const Face<Real>& f) {
  { scheme(gas, q, q, f) } -> std::same_as<Conserved<Real>>;
  { F::name } -> std::convertible_to<std::string_view>;
};

/// Half the sum of the physical fluxes on both sides, of states with known densities.
template <class Real>
SPINDRIFT_INLINE Conserved<Real> central_flux(const IdealGas& gas, const Primitive<Real>& l, const Real& rho_l,
                                              const Primitive<Real>& r, const Real& rho_r, const Face<Real>& f) {
  const Real half = 0.5 * f.area;
  const Real ml = half * (rho_l * (normal_velocity(l, f) - f.speed)), mr = half * (rho_r * (normal_velocity(r, f) - f.speed));
  const Real push = half * (l.p + r.p);
  return {ml + mr, ml * l.u + mr * r.u + push * f.nx, ml * l.v + mr * r.v + push * f.ny, ml * l.w + mr * r.w + push * f.nz,
          ml * total_enthalpy(gas, l) + mr * total_enthalpy(gas, r) + push * f.speed};
}
template <class Real>
SPINDRIFT_INLINE Conserved<Real> central_flux(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                              const Face<Real>& f) {
  return central_flux(gas, l, density(gas, l), r, density(gas, r), f);
}

/// Roe's mean of two states: what the waves of a face are computed with.
template <class Real>
struct RoeMean {
  Real rho, u, v, w, h, c, un;  ///< density, velocity, total enthalpy above the reference, sound speed, normal velocity in space
  Real inverse_c;               ///< 1/c: a division costs as much as ten products
  Real rho_p, rho_T;            ///< rho_r - rho_l = rho_p (p_r - p_l) + rho_T (T_r - T_l), exactly
  Real rho_l, rho_r;            ///< densities of the two states
};
template <class Real>
SPINDRIFT_INLINE RoeMean<Real> roe_mean(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                        const Face<Real>& f) {
  const Real Tl = absolute_temperature(gas, l), Tr = absolute_temperature(gas, r);
  const Real pl = absolute_pressure(gas, l), pr = absolute_pressure(gas, r);
  const Real inverse = 1.0 / (gas.gas_constant * (Tl * Tr));
  RoeMean<Real> m;
  m.rho_l = pl * Tr * inverse, m.rho_r = pr * Tl * inverse;              // one division for both
  const Real root = sqrt(pr * Tl / (pl * Tr)), b = root / (1.0 + root);  // sqrt(rho_r / rho_l): one square root for both
  m.rho = m.rho_l * root;
  m.u = l.u + b * (r.u - l.u), m.v = l.v + b * (r.v - l.v), m.w = l.w + b * (r.w - l.w);
  const Real hl = total_enthalpy(gas, l), hr = total_enthalpy(gas, r);
  m.h = hl + b * (hr - hl);
  m.un = m.u * f.nx + m.v * f.ny + m.w * f.nz;
  const Real k = 0.5 * (m.u * m.u + m.v * m.v + m.w * m.w);
  const Real c2 = (gas.gamma - 1.0) * (m.h + gas.enthalpy_reference() - k);
  m.c = sqrt(c2);
  m.inverse_c = m.c * (1.0 / c2);  // the division does not wait for the root
  m.rho_p = 0.5 * (Tl + Tr) * inverse;
  m.rho_T = -0.5 * (pl + pr) * inverse;
  return m;
}

/// |A| (q_r - q_l) times area, of given speeds |un - c|, |un|, |un + c| and with the jump of the normal velocity in the acoustic
/// waves scaled (1 for Roe; Rieper 2011 below Mach 1).
template <class Real>
SPINDRIFT_INLINE Conserved<Real> wave_dissipation(const IdealGas& gas, const RoeMean<Real>& m, const Primitive<Real>& l,
                                                  const Primitive<Real>& r, const Face<Real>& f, const Real& slow,
                                                  const Real& middle, const Real& fast, const Real& scale) {
  const Real dp = r.p - l.p, du = r.u - l.u, dv = r.v - l.v, dw = r.w - l.w;
  const Real dun = du * f.nx + dv * f.ny + dw * f.nz;
  const Real inverse = m.inverse_c, impulse = m.rho * dun * scale;  // rho c dun, less its c
  const Real sum = 0.5 * (fast + slow), difference = 0.5 * (fast - slow);
  const Real entropy = middle * ((m.rho_p - inverse * inverse) * dp + m.rho_T * (r.T - l.T));
  // Mass carried by all waves, the push of the two acoustic ones, and the shear.
  const Real mass = f.area * ((sum * inverse * dp + difference * impulse) * inverse + entropy);
  const Real push = f.area * (difference * inverse * dp + sum * impulse);
  const Real shear = f.area * (middle * m.rho);
  const Real shear_work = m.u * du + m.v * dv + m.w * dw - m.un * dun;
  const Real heat =
      (1.0 / (gas.gamma - 1.0)) * (m.c * m.c) * (f.area * entropy);  // cp T of the gas that the entropy wave displaces
  return {mass, mass * m.u + push * f.nx + shear * (du - dun * f.nx), mass * m.v + push * f.ny + shear * (dv - dun * f.ny),
          mass * m.w + push * f.nz + shear * (dw - dun * f.nz), mass * m.h + push * m.un + shear * shear_work - heat};
}

}  // namespace spindrift::gas
