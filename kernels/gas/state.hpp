// The state of a calorically perfect gas: primitive and conserved variables, faces, gas properties, the physical flux.
// Pressure and temperature are kept above a reference, so that the pressure of a flow at Mach 1e-5 (1e-10 of the static one) has
// all its digits; the energy is the one that belongs to it (docs/theory/gas.md, "Variables"). With references of zero: textbook
// ones. Called by everything in kernels/gas and src/aero/flow; tested in tests/kernels/gas/state_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kernels/base/wide_math.hpp"

namespace spindrift::gas {

/// What the solver stores and reconstructs: p [Pa] above IdealGas::pressure_reference, velocity [m/s], T [K] above
/// IdealGas::temperature_reference.
template <class Real>
struct Primitive {
  Real p, u, v, w, T;
};

/// Amounts per volume, or their flux through a face: mass rho [kg/m3], momentum [kg/(m2 s)], and energy [J/m3] reduced by
/// enthalpy_reference per mass and raised by pressure_reference per volume: E = rho (cp T + |u|^2 / 2) - p with p, T as above.
/// A sum of conservation laws and constants, so conserved as exactly as the total energy itself.
template <class Real>
struct Conserved {
  Real rho, mx, my, mz, E;
};

/// Unit normal out of the left cell [-], area [m2], normal velocity of the moving face [m/s]; and its velocity, of which fluxes
/// whose dissipation knows a local Mach number see the tangential part.
template <class Real>
struct Face {
  Real nx, ny, nz, area, speed;
  Real vx = Real(0.0), vy = Real(0.0), vz = Real(0.0);
};

/// Sutherland's law mu = mu0 (T/T0)^1.5 (T0 + S) / (T + S); S as NASA's TMR uses it (198.6 R).
struct Viscosity {
  double mu0 = 1.716e-5;  ///< [Pa s] at T0
  double T0 = 273.11;     ///< [K]
  double S = 110.33;      ///< [K]
  bool constant = false;  ///< mu = mu0 at any temperature (incompressible reference cases)
};

struct IdealGas {
  double gamma = 1.4;
  double gas_constant = 287.05;  ///< [J/(kg K)]
  double prandtl = 0.72;         ///< laminar
  double prandtl_turbulent = 0.9;
  double pressure_reference = 0.0;     ///< [Pa] what Primitive::p is measured from
  double temperature_reference = 0.0;  ///< [K] what Primitive::T is measured from
  Viscosity viscosity{};

  double cp() const { return gamma * gas_constant / (gamma - 1.0); }
  double cv() const { return gas_constant / (gamma - 1.0); }
  double enthalpy_reference() const { return cp() * temperature_reference; }
};

template <class Real>
SPINDRIFT_INLINE Real absolute_pressure(const IdealGas& gas, const Primitive<Real>& q) {
  return q.p + gas.pressure_reference;
}
template <class Real>
SPINDRIFT_INLINE Real absolute_temperature(const IdealGas& gas, const Primitive<Real>& q) {
  return q.T + gas.temperature_reference;
}
template <class Real>
SPINDRIFT_INLINE Real density(const IdealGas& gas, const Primitive<Real>& q) {
  return absolute_pressure(gas, q) / (gas.gas_constant * absolute_temperature(gas, q));
}
template <class Real>
SPINDRIFT_INLINE Real sound_speed(const IdealGas& gas, const Primitive<Real>& q) {
  return sqrt((gas.gamma * gas.gas_constant) * absolute_temperature(gas, q));
}
/// Half the square of the velocity [J/kg].
template <class Real>
SPINDRIFT_INLINE Real kinetic(const Primitive<Real>& q) {
  return 0.5 * (q.u * q.u + q.v * q.v + q.w * q.w);
}
/// Total enthalpy [J/kg] above that of the reference temperature at rest.
template <class Real>
SPINDRIFT_INLINE Real total_enthalpy(const IdealGas& gas, const Primitive<Real>& q) {
  return gas.cp() * q.T + kinetic(q);
}
template <class Real>
SPINDRIFT_INLINE Real normal_velocity(const Primitive<Real>& q, const Face<Real>& f) {
  return q.u * f.nx + q.v * f.ny + q.w * f.nz;
}

template <class Real>
SPINDRIFT_INLINE Conserved<Real> conserved(const IdealGas& gas, const Primitive<Real>& q) {
  const Real rho = density(gas, q);
  return {rho, rho * q.u, rho * q.v, rho * q.w, rho * total_enthalpy(gas, q) - q.p};
}
/// Inverse of conserved(); the pressure keeps digits down to about 1e-15 of the absolute pressure only.
template <class Real>
SPINDRIFT_INLINE Primitive<Real> primitive(const IdealGas& gas, const Conserved<Real>& c) {
  const Real inverse = 1.0 / c.rho;
  Primitive<Real> q{Real(0.0), c.mx * inverse, c.my * inverse, c.mz * inverse, Real(0.0)};
  // Of the gas at the reference temperature: what its pressure differs from the reference.
  const Real base = c.rho * (gas.gas_constant * gas.temperature_reference) - gas.pressure_reference;
  q.T = ((c.E + base) * inverse - kinetic(q)) * (1.0 / gas.cv());
  q.p = c.rho * (gas.gas_constant * q.T) + base;
  return q;
}

/// Dynamic viscosity [Pa s].
template <class Real>
SPINDRIFT_INLINE Real viscosity(const IdealGas& gas, const Real& absolute_temperature) {
  const Viscosity& law = gas.viscosity;
  if (law.constant) return Real(law.mu0);
  const Real theta = absolute_temperature * (1.0 / law.T0);
  return (law.mu0 * (1.0 + law.S / law.T0)) * (theta * sqrt(theta)) / (theta + law.S / law.T0);
}

/// Flux of mass, momentum and energy out through a moving face where the gas has state q (times the face's area).
/// The face does work p speed, and what it sweeps over is left behind.
template <class Real>
SPINDRIFT_INLINE Conserved<Real> physical_flux(const IdealGas& gas, const Primitive<Real>& q, const Face<Real>& f) {
  const Real mass = f.area * (density(gas, q) * (normal_velocity(q, f) - f.speed)), push = f.area * q.p;
  return {mass, mass * q.u + push * f.nx, mass * q.v + push * f.ny, mass * q.w + push * f.nz,
          mass * total_enthalpy(gas, q) + push * f.speed};
}

template <class Real>
SPINDRIFT_INLINE Conserved<Real> operator+(const Conserved<Real>& a, const Conserved<Real>& b) {
  return {a.rho + b.rho, a.mx + b.mx, a.my + b.my, a.mz + b.mz, a.E + b.E};
}
template <class Real>
SPINDRIFT_INLINE Conserved<Real> operator-(const Conserved<Real>& a, const Conserved<Real>& b) {
  return {a.rho - b.rho, a.mx - b.mx, a.my - b.my, a.mz - b.mz, a.E - b.E};
}
template <class Real>
SPINDRIFT_INLINE Conserved<Real> operator*(const std::type_identity_t<Real>& s, const Conserved<Real>& a) {
  return {s * a.rho, s * a.mx, s * a.my, s * a.mz, s * a.E};
}
template <class Real>
SPINDRIFT_INLINE Primitive<Real> operator+(const Primitive<Real>& a, const Primitive<Real>& b) {
  return {a.p + b.p, a.u + b.u, a.v + b.v, a.w + b.w, a.T + b.T};
}
template <class Real>
SPINDRIFT_INLINE Primitive<Real> operator-(const Primitive<Real>& a, const Primitive<Real>& b) {
  return {a.p - b.p, a.u - b.u, a.v - b.v, a.w - b.w, a.T - b.T};
}
template <class Real>
SPINDRIFT_INLINE Primitive<Real> operator*(const std::type_identity_t<Real>& s, const Primitive<Real>& a) {
  return {s * a.p, s * a.u, s * a.v, s * a.w, s * a.T};
}

template <class Mask, class Real>
SPINDRIFT_INLINE Primitive<Real> select_state(const Mask& mask, const Primitive<Real>& yes, const Primitive<Real>& no) {
  return {select(mask, yes.p, no.p), select(mask, yes.u, no.u), select(mask, yes.v, no.v), select(mask, yes.w, no.w),
          select(mask, yes.T, no.T)};
}

// Rows of component-major arrays: component c of a cell is c * stride further on. Order p u v w T and rho mx my mz E.
template <class Real>
SPINDRIFT_INLINE Real load_number(const scalar_of<Real>* from) {
  if constexpr (std::is_arithmetic_v<Real>)
    return *from;
  else
    return Real::load(from);
}
template <class Real>
SPINDRIFT_INLINE void store_number(scalar_of<Real>* to, const Real& x) {
  if constexpr (std::is_arithmetic_v<Real>)
    *to = x;
  else
    x.store(to);
}
template <class Real>
SPINDRIFT_INLINE Primitive<Real> load_primitive(const scalar_of<Real>* from, std::size_t stride) {
  return {load_number<Real>(from), load_number<Real>(from + stride), load_number<Real>(from + 2 * stride),
          load_number<Real>(from + 3 * stride), load_number<Real>(from + 4 * stride)};
}
template <class Real>
SPINDRIFT_INLINE void store_primitive(scalar_of<Real>* to, std::size_t stride, const Primitive<Real>& q) {
  store_number(to, q.p), store_number(to + stride, q.u), store_number(to + 2 * stride, q.v);
  store_number(to + 3 * stride, q.w), store_number(to + 4 * stride, q.T);
}
template <class Real>
SPINDRIFT_INLINE Conserved<Real> load_conserved(const scalar_of<Real>* from, std::size_t stride) {
  return {load_number<Real>(from), load_number<Real>(from + stride), load_number<Real>(from + 2 * stride),
          load_number<Real>(from + 3 * stride), load_number<Real>(from + 4 * stride)};
}
template <class Real>
SPINDRIFT_INLINE void store_conserved(scalar_of<Real>* to, std::size_t stride, const Conserved<Real>& c) {
  store_number(to, c.rho), store_number(to + stride, c.mx), store_number(to + 2 * stride, c.my);
  store_number(to + 3 * stride, c.mz), store_number(to + 4 * stride, c.E);
}

}  // namespace spindrift::gas
