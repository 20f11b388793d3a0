// Jacobians of fluxes by the primitive unknowns (p, u, v, w, T) on both sides: written out for the implicit matrix (Rusanov, Roe
// and low-Mach Roe with their waves frozen; thin-layer viscous terms), and exact for any scheme by dual numbers. Frozen waves:
// d|A|/dq is left out, which is exact for equal states and off by the jump otherwise. Rows of the physical flux's Jacobian are
// sums of few products (docs/theory/gas.md, "Jacobians"), which is what makes them cheap: no 5 x 5 products. Called by
// src/aero/flow; tested in tests/kernels/gas/jacobians_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/dual.hpp"
#include "kernels/gas/flux_osher.hpp"
#include "kernels/gas/flux_roe.hpp"
#include "kernels/gas/flux_roe_low_mach.hpp"
#include "kernels/gas/flux_rusanov.hpp"
#include "kernels/gas/preconditioner.hpp"
#include "kernels/gas/viscous.hpp"

namespace spindrift::gas {

/// Of a flux out of the left cell: by the left and the right state. Residual of the right cell has the opposite sign.
template <class Real>
struct FluxJacobian {
  Block5<Real> left, right;
};

/// One row of a Jacobian: derivatives of a number by (p, u, v, w, T).
template <class Real>
struct Row5 {
  Real p, u, v, w, T;
};

/// What an amount of mass with its derivatives carries (the gas's own velocity and total enthalpy), and a push along n with its
/// work: rows (mass; mass u + push n; mass h + push speed).
template <class Real>
SPINDRIFT_INLINE Block5<Real> carried(const Row5<Real>& mass, const Row5<Real>& push, const Real& u, const Real& v, const Real& w,
                                      const Real& h, const Face<Real>& f, const Real& push_speed) {
  Block5<Real> J;
  const Real a[5] = {Real(1.0), u, v, w, h}, b[5] = {Real(0.0), f.nx, f.ny, f.nz, push_speed};
  const Real m[5] = {mass.p, mass.u, mass.v, mass.w, mass.T}, s[5] = {push.p, push.u, push.v, push.w, push.T};
  for (int column = 0; column < 5; ++column) J.m[0][column] = m[column];
  for (int row = 1; row < 5; ++row)
    for (int column = 0; column < 5; ++column) J.m[row][column] = a[row] * m[column] + b[row] * s[column];
  return J;
}

/// d(physical_flux)/d(p, u, v, w, T) times `factor` (1/2 in a central flux), plus `diagonal` dQ/dW where a scalar dissipation
/// asks.
template <class Real>
SPINDRIFT_INLINE Block5<Real> physical_jacobian(const IdealGas& gas, const Primitive<Real>& q, const Face<Real>& f,
                                                const Real& factor = Real(1.0), const Real& diagonal = Real(0.0)) {
  const Thermo<Real> t = thermo(gas, q);
  const Real area = factor * f.area, volume = area * (normal_velocity(q, f) - f.speed) + diagonal, normal = area * t.rho,
             zero(0.0);
  const Row5<Real> mass{volume * t.rho_p, normal * f.nx, normal * f.ny, normal * f.nz, volume * t.rho_T};
  Block5<Real> J = carried(mass, Row5<Real>{area, zero, zero, zero, zero}, q.u, q.v, q.w, t.h, f, f.speed);
  const Real flow = volume * t.rho;
  J.m[1][1] += flow, J.m[2][2] += flow, J.m[3][3] += flow;
  J.m[4][0] -= diagonal;
  J.m[4][1] += flow * q.u, J.m[4][2] += flow * q.v, J.m[4][3] += flow * q.w, J.m[4][4] += flow * gas.cp();
  return J;
}

/// The matrix of wave_dissipation(), with the waves of the mean state held. `pressure` scales the mass that a pressure jump
/// drives through the face: 1 is Roe's, c over the preconditioner's reference speed that of the preconditioned equations.
template <class Real>
SPINDRIFT_INLINE Block5<Real> dissipation_jacobian(const IdealGas& gas, const RoeMean<Real>& m, const Face<Real>& f,
                                                   const Real& slow, const Real& middle, const Real& fast, const Real& scale,
                                                   const Real& pressure = Real(1.0)) {
  const Real inverse = m.inverse_c, sum = 0.5 * f.area * (fast + slow), difference = 0.5 * f.area * (fast - slow);
  const Real entropy_p = f.area * middle * (m.rho_p - inverse * inverse), entropy_T = f.area * middle * m.rho_T, zero(0.0);
  const Real by_un = difference * inverse * m.rho * scale, push_un = sum * m.rho * scale;
  const Row5<Real> mass{sum * inverse * inverse * pressure + entropy_p, by_un * f.nx, by_un * f.ny, by_un * f.nz, entropy_T};
  const Row5<Real> push{difference * inverse, push_un * f.nx, push_un * f.ny, push_un * f.nz, zero};
  Block5<Real> J = carried(mass, push, m.u, m.v, m.w, m.h, f, m.un);
  const Real shear = f.area * middle * m.rho, n[3] = {f.nx, f.ny, f.nz}, velocity[3] = {m.u, m.v, m.w};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) J.m[row + 1][column + 1] -= shear * n[row] * n[column];
  for (int d = 0; d < 3; ++d) {
    J.m[d + 1][d + 1] += shear;
    J.m[4][d + 1] += shear * (velocity[d] - m.un * n[d]);
  }
  const Real heat = (1.0 / (gas.gamma - 1.0)) * (m.c * m.c);
  J.m[4][0] -= heat * entropy_p;
  J.m[4][4] -= heat * entropy_T;
  return J;
}

template <class Real>
SPINDRIFT_INLINE Block5<Real> combine(const Block5<Real>& a, double factor, const Block5<Real>& b) {
  Block5<Real> sum;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) sum.m[row][column] = a.m[row][column] + factor * b.m[row][column];
  return sum;
}

/// Of a scheme of the Roe family: half of (physical -+ |A|).
template <class Real>
SPINDRIFT_INLINE FluxJacobian<Real> roe_jacobian(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                                 const Face<Real>& f, double entropy_fix, const auto& scale) {
  const RoeMean<Real> m = roe_mean(gas, l, r, f);
  const WaveSpeeds<Real> s = wave_speeds(m, f, entropy_fix);
  const Block5<Real> D = dissipation_jacobian(gas, m, f, s.slow, s.middle, s.fast, scale(m));
  return {combine(physical_jacobian(gas, l, f, Real(0.5)), 0.5, D), combine(physical_jacobian(gas, r, f, Real(0.5)), -0.5, D)};
}

template <class Real>
SPINDRIFT_INLINE FluxJacobian<Real> flux_jacobian(const Roe& scheme, const IdealGas& gas, const Primitive<Real>& l,
                                                  const Primitive<Real>& r, const Face<Real>& f) {
  return roe_jacobian(gas, l, r, f, scheme.entropy_fix, [](const RoeMean<Real>&) { return Real(1.0); });
}
template <class Real>
SPINDRIFT_INLINE FluxJacobian<Real> flux_jacobian(const RoeLowMach& scheme, const IdealGas& gas, const Primitive<Real>& l,
                                                  const Primitive<Real>& r, const Face<Real>& f) {
  return roe_jacobian(gas, l, r, f, scheme.entropy_fix, [&](const RoeMean<Real>& m) { return scheme.scale(m, f); });
}
/// Osher's flux has Roe's matrix between equal states; between others Roe's serves the implicit matrix.
template <OsherOrder order, class Real>
SPINDRIFT_INLINE FluxJacobian<Real> flux_jacobian(const Osher<order>&, const IdealGas& gas, const Primitive<Real>& l,
                                                  const Primitive<Real>& r, const Face<Real>& f) {
  return flux_jacobian(Roe{.entropy_fix = 0.05}, gas, l, r, f);
}
template <class Real>
SPINDRIFT_INLINE FluxJacobian<Real> flux_jacobian(const Rusanov&, const IdealGas& gas, const Primitive<Real>& l,
                                                  const Primitive<Real>& r, const Face<Real>& f) {
  const Real s = 0.5 * f.area * rusanov_speed(gas, l, r, f);
  return {physical_jacobian(gas, l, f, Real(0.5), s), physical_jacobian(gas, r, f, Real(0.5), -s)};
}

/// The Jacobian of any flux between any states, nothing frozen; about ten times the flux and long to compile.
template <class Scheme, class Real>
FluxJacobian<Real> exact_jacobian(const Scheme& scheme, const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                  const Face<Real>& f) {
  using D = Dual<Real, 5>;
  const auto seeded = [](const Primitive<Real>& q) {
    return Primitive<D>{D::variable(q.p, 0), D::variable(q.u, 1), D::variable(q.v, 2), D::variable(q.w, 3), D::variable(q.T, 4)};
  };
  const auto held = [](const Primitive<Real>& q) { return Primitive<D>{D(q.p), D(q.u), D(q.v), D(q.w), D(q.T)}; };
  const Face<D> face{D(f.nx), D(f.ny), D(f.nz), D(f.area), D(f.speed)};
  const auto block = [](const Conserved<D>& flux) {
    Block5<Real> J;
    for (int column = 0; column < 5; ++column) {
      J.m[0][column] = flux.rho.d[column], J.m[1][column] = flux.mx.d[column], J.m[2][column] = flux.my.d[column];
      J.m[3][column] = flux.mz.d[column], J.m[4][column] = flux.E.d[column];
    }
    return J;
  };
  return {block(scheme(gas, seeded(l), held(r), face)), block(scheme(gas, held(l), seeded(r), face))};
}

/// Of the thin-layer viscous flux by the right state, with viscosity and the face's velocity held; by the left state it is minus
/// this. Line n / (n . d) as in face_line(); u, v, w velocities on the face.
template <class Real>
SPINDRIFT_INLINE Block5<Real> thin_layer_jacobian(const Transport<Real>& t, const FaceLine<Real>& line, const Real& u,
                                                  const Real& v, const Real& w, const Face<Real>& f) {
  const Real inverse = line.lift.x * f.nx + line.lift.y * f.ny + line.lift.z * f.nz;  // 1 / (n . d)
  const Real shear = t.mu * f.area * inverse, third = (1.0 / 3.0) * shear, zero(0.0);
  const Real n[3] = {f.nx, f.ny, f.nz}, velocity[3] = {u, v, w};
  Block5<Real> J;
  for (int column = 0; column < 5; ++column) J.m[0][column] = zero, J.m[4][column] = zero;
  for (int row = 0; row < 3; ++row) {
    J.m[row + 1][0] = zero, J.m[row + 1][4] = zero;
    for (int column = 0; column < 3; ++column) {
      const Real entry = -third * n[row] * n[column] - (row == column ? shear : zero);
      J.m[row + 1][column + 1] = entry;
      J.m[4][column + 1] += velocity[row] * entry;
    }
  }
  J.m[4][4] = -t.conductivity * f.area * inverse;
  return J;
}

}  // namespace spindrift::gas
