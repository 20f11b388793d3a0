// Low-Mach preconditioning of the pseudo-time in (p, u, v, w, T), and the change of variables it generalises.
// Weiss & Smith (1995), AIAA J. 33, 2050: dQ/dW with the compressibility of the gas replaced by that of one whose sound speed is
// the reference speed U_r; Turkel (1987), J. Comput. Phys. 72, 277, for the family. The steady state is not touched. Called by
// src/aero/flow and boundary.hpp; tested in tests/kernels/gas/preconditioner_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/state.hpp"

namespace spindrift::gas {

/// A 5 x 5 matrix by rows; rows in the order rho mx my mz E, columns p u v w T.
template <class Real>
struct Block5 {
  Real m[5][5];
};

/// Preconditioned waves relative to the face: un (1 - alpha) -+ sqrt(alpha^2 un^2 + U_r^2).
template <class Real>
struct PreconditionedSpeeds {
  Real slow, fast;
};
/// un relative to the face; c2, r2 the squares of the sound speed and the reference speed. r2 = c2 gives un -+ c.
template <class Real>
SPINDRIFT_INLINE PreconditionedSpeeds<Real> preconditioned_speeds(const Real& un, const Real& c2, const Real& r2) {
  const Real half_gap = 0.5 * (1.0 - r2 / c2) * un, root = sqrt(half_gap * half_gap + r2), middle = un - half_gap;
  return {middle - root, middle + root};
}

/// Square of the reference speed: the larger of the gas's own speed and a floor, which keeps stagnation points regular; at most
/// c.
template <class Real>
SPINDRIFT_INLINE Real reference_speed_squared(const Real& speed_squared, const Real& floor_squared, const Real& c2) {
  return min(max(speed_squared, floor_squared), c2);
}

/// What both matrices need of a state: density, its derivatives, total enthalpy above the reference.
template <class Real>
struct Thermo {
  Real rho, rho_p, rho_T, h;
};
template <class Real>
SPINDRIFT_INLINE Thermo<Real> thermo(const IdealGas& gas, const Primitive<Real>& q) {
  const Real inverse_T = 1.0 / absolute_temperature(gas, q), rho_p = inverse_T * (1.0 / gas.gas_constant);
  const Real rho = absolute_pressure(gas, q) * rho_p;
  return {rho, rho_p, -rho * inverse_T, total_enthalpy(gas, q)};
}
/// The same with the compressibility 1/U_r^2 - rho_T/(rho cp) of Weiss & Smith; at U_r = c it is rho_p.
template <class Real>
SPINDRIFT_INLINE Thermo<Real> preconditioned(const IdealGas& gas, Thermo<Real> t, const Real& r2) {
  t.rho_p = 1.0 / r2 - t.rho_T / (t.rho * gas.cp());
  return t;
}

/// dQ/dW: from changes of (p, u, v, w, T) to those of (rho, mx, my, mz, E). With preconditioned(): the matrix of the pseudo-time.
template <class Real>
SPINDRIFT_INLINE Block5<Real> conserved_by_primitive(const IdealGas& gas, const Thermo<Real>& t, const Primitive<Real>& q) {
  const Real o(0.0), one(1.0);
  return {{{t.rho_p, o, o, o, t.rho_T},
           {t.rho_p * q.u, t.rho, o, o, t.rho_T * q.u},
           {t.rho_p * q.v, o, t.rho, o, t.rho_T * q.v},
           {t.rho_p * q.w, o, o, t.rho, t.rho_T * q.w},
           {t.rho_p * t.h - one, t.rho * q.u, t.rho * q.v, t.rho * q.w, t.rho_T * t.h + t.rho * gas.cp()}}};
}

/// Applies the inverse of the above to a change of conserved variables (or a residual).
template <class Real>
SPINDRIFT_INLINE Primitive<Real> primitive_change(const IdealGas& gas, const Thermo<Real>& t, const Primitive<Real>& q,
                                                  const Conserved<Real>& c) {
  const Real mx = c.mx - q.u * c.rho, my = c.my - q.v * c.rho, mz = c.mz - q.w * c.rho;
  const Real heat = c.E - t.h * c.rho - (q.u * mx + q.v * my + q.w * mz);  // rho cp dT - dp
  const Real capacity = t.rho * gas.cp(), inverse = 1.0 / (t.rho_p * capacity + t.rho_T), lighter = 1.0 / t.rho;
  return {(capacity * c.rho - t.rho_T * heat) * inverse, mx * lighter, my * lighter, mz * lighter,
          (c.rho + t.rho_p * heat) * inverse};
}

/// Applies conserved_by_primitive without forming it.
template <class Real>
SPINDRIFT_INLINE Conserved<Real> conserved_change(const IdealGas& gas, const Thermo<Real>& t, const Primitive<Real>& q,
                                                  const Primitive<Real>& d) {
  const Real rho = t.rho_p * d.p + t.rho_T * d.T;
  return {rho, rho * q.u + t.rho * d.u, rho * q.v + t.rho * d.v, rho * q.w + t.rho * d.w,
          rho * t.h + t.rho * (q.u * d.u + q.v * d.v + q.w * d.w + gas.cp() * d.T) - d.p};
}

}  // namespace spindrift::gas
