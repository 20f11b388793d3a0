// States of the gas on boundary faces and in the ghost cells behind them; the flux through a boundary face is physical_flux() of
// the face state. Characteristic conditions are written for the pair of waves a+, a- of the (preconditioned) equations, so that
// one form serves Mach 1e-5 to supersonic: Whitfield & Janus (1984), AIAA 84-1552; preconditioned: Darmofal, Moinier & Giles
// (2000), J. Comput. Phys. 160, 369. All on moving faces; `f` points out of the flow; `inside` is the state of the cell (or
// extrapolated). Called by src/aero/flow; tested in tests/kernels/gas/boundary_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/muscl.hpp"
#include "kernels/gas/preconditioner.hpp"
#include "kernels/gas/state.hpp"
#include "kernels/gas/viscous.hpp"

namespace spindrift::gas {

/// State with the same tangential velocity and another normal one [m/s in space], p and T given.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> with_normal_velocity(const Primitive<Real>& q, const Face<Real>& f, const Real& un,
                                                      const Real& p, const Real& T) {
  const Real shift = un - normal_velocity(q, f);
  return {p, q.u + shift * f.nx, q.v + shift * f.ny, q.w + shift * f.nz, T};
}

/// Characteristic far field: what leaves comes from `inside`, what enters from `outside`. `reference_speed` is that of the
/// preconditioner: the sound speed gives the physical characteristics; the speed that the pseudo-time uses gives a
/// boundary that does not reflect its waves at low Mach number. The steady state of a uniform stream is the same.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> far_field(const IdealGas& gas, const Primitive<Real>& inside, const Primitive<Real>& outside,
                                           const Face<Real>& f, const Real& reference_speed) {
  const Real ui = normal_velocity(inside, f), ue = normal_velocity(outside, f);
  const Primitive<Real> m = 0.5 * (inside + outside);
  const Real rho = density(gas, m), un = 0.5 * (ui + ue) - f.speed,
             c2 = (gas.gamma * gas.gas_constant) * absolute_temperature(gas, m);
  const Real r2 = min(reference_speed * reference_speed, c2);
  const PreconditionedSpeeds<Real> s = preconditioned_speeds(un, c2, r2);
  // p + rho a u holds along each wave, with a = speed of the wave - un r2 / c2.
  const Real drift = un * r2 / c2, plus = rho * (s.fast - drift), minus = rho * (s.slow - drift);
  const auto out_plus = s.fast > Real(0.0), out_minus = s.slow > Real(0.0), out = un > Real(0.0);
  // Relative to `outside`, so that a uniform stream is returned bit by bit.
  const Real dp = inside.p - outside.p, du = ui - ue, zero(0.0);
  const Real wave_plus = select(out_plus, dp + plus * du, zero), wave_minus = select(out_minus, dp + minus * du, zero);
  const Real shift = (wave_plus - wave_minus) / (plus - minus);
  const Real p = outside.p + (wave_plus - plus * shift);
  const Primitive<Real> upstream = select_state(out, inside, outside);
  // Along the path of the gas the entropy holds: dT = dp / (rho cp).
  return with_normal_velocity(upstream, f, ue + shift, p, upstream.T + (p - upstream.p) / (rho * gas.cp()));
}
template <class Real>
SPINDRIFT_INLINE Primitive<Real> far_field(const IdealGas& gas, const Primitive<Real>& inside, const Primitive<Real>& outside,
                                           const Face<Real>& f) {
  return far_field(gas, inside, outside, f, Real(sound_speed(gas, outside)));
}

/// Inflow of known velocity and temperature: the pressure is the flow's own, but where it comes faster than sound.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> inflow_velocity(const IdealGas& gas, const Primitive<Real>& inside,
                                                 const Primitive<Real>& outside, const Face<Real>& f) {
  const auto supersonic = normal_velocity(outside, f) - f.speed <= -sound_speed(gas, outside);
  return {select(supersonic, outside.p, inside.p), outside.u, outside.v, outside.w, outside.T};
}

/// A gas at rest that flows in: absolute values.
struct Reservoir {
  double pressure, temperature;  ///< stagnation values [Pa, K], absolute
  double x, y, z;                ///< direction of the inflow, unit vector
};
/// Subsonic inflow from a reservoir, the speed by the pressure inside: isentropic to inside.p, at most to Mach 1; at rest where
/// the pressure inside exceeds the reservoir's.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> inflow_reservoir(const IdealGas& gas, const Primitive<Real>& inside,
                                                  const Reservoir& reservoir) {
  const double z = (gas.gamma - 1.0) / gas.gamma, p0 = reservoir.pressure - gas.pressure_reference;
  const double sonic = reservoir.pressure * (power_minus_one(2.0 / (gas.gamma + 1.0) - 1.0, 1.0 / z));
  const Real p = min(max(inside.p, p0 + sonic), p0);
  const Real drop = power_minus_one((p - p0) * (1.0 / reservoir.pressure), z);  // T/T0 - 1
  const Real speed = sqrt(max((-2.0 * gas.cp() * reservoir.temperature) * drop, 1e-300));
  return {p, speed * reservoir.x, speed * reservoir.y, speed * reservoir.z,
          (reservoir.temperature - gas.temperature_reference) + reservoir.temperature * drop};
}

/// Outflow of known pressure; the rest is the flow's own. Where the gas comes back in, it brings the temperature of `outside` and
/// its normal velocity only; where it leaves faster than sound, the pressure is the flow's own too.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> outflow_pressure(const IdealGas& gas, const Primitive<Real>& inside,
                                                  const Primitive<Real>& outside, const Face<Real>& f) {
  const Real un = normal_velocity(inside, f), relative = un - f.speed, c = sound_speed(gas, inside);
  const auto leaves = relative >= Real(0.0), supersonic = relative >= c;
  const Primitive<Real> q{select(supersonic, inside.p, outside.p), inside.u, inside.v, inside.w, inside.T};
  return select_state(leaves, q, Primitive<Real>{outside.p, un * f.nx, un * f.ny, un * f.nz, outside.T});
}

/// The ghost cell behind a slip wall or symmetry plane: the mirror image.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> mirrored(const Primitive<Real>& inside, const Face<Real>& f) {
  return with_normal_velocity(inside, f, 2.0 * f.speed - normal_velocity(inside, f), inside.p, inside.T);
}
/// The ghost cell behind an adiabatic wall that moves with (u, v, w) [m/s], to which the gas sticks: the wall's velocity is the
/// mean of inside and ghost; no gradient of pressure and temperature across.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> no_slip_ghost(const Primitive<Real>& inside, const Vector<Real>& wall) {
  return {inside.p, 2.0 * wall.x - inside.u, 2.0 * wall.y - inside.v, 2.0 * wall.z - inside.w, inside.T};
}
/// Temperature of the ghost cell behind a wall that is held at `wall` [K, absolute]: the wall's is the mean of inside and ghost.
/// At least a tenth of the wall's.
template <class Real>
SPINDRIFT_INLINE Real isothermal_ghost(const IdealGas& gas, const Real& inside, double wall) {
  return max((2.0 * (wall - gas.temperature_reference)) - inside, 0.1 * wall - gas.temperature_reference);
}

/// Convective flux through a wall face: nothing but pressure and its work on the moving wall; p [Pa] above the reference.
template <class Real>
SPINDRIFT_INLINE Conserved<Real> wall_flux(const Real& p, const Face<Real>& f) {
  const Real push = p * f.area;
  return {Real(0.0), push * f.nx, push * f.ny, push * f.nz, push * f.speed};
}

}  // namespace spindrift::gas
