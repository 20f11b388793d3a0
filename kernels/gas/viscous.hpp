// Viscous stress and heat flux through a face, gradients at faces and in cells. Newtonian fluid, Stokes' hypothesis, Fourier's
// law; eddy viscosity by Boussinesq. Central differences; face gradient with the direct difference along the line of centres,
// which couples neighbours (Mathur & Murthy 1997, Numer. Heat Transfer B 31, 195; Blazek, CFD Principles and Applications, 5.4).
// Called by src/aero/flow; tested in tests/kernels/gas/viscous_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/state.hpp"

namespace spindrift::gas {

template <class Real>
struct Vector {
  Real x, y, z;
};
template <class Real>
SPINDRIFT_INLINE Real dot(const Vector<Real>& a, const Vector<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
SPINDRIFT_INLINE Vector<Real> mean(const Vector<Real>& a, const Vector<Real>& b) {
  return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)};
}

/// Gradients [1/s, K/m] of velocity and temperature.
template <class Real>
struct Gradients {
  Vector<Real> u, v, w, T;
};

/// Green-Gauss: the sum over a cell's faces of value times outward area vector, over the volume; this adds one pair of opposite
/// faces with their area vectors in the same direction (along the index).
template <class Real>
SPINDRIFT_INLINE void add_face_pair(Vector<Real>& gradient, const Real& low, const Vector<Real>& low_area, const Real& high,
                                    const Vector<Real>& high_area) {
  gradient.x += high * high_area.x - low * low_area.x;
  gradient.y += high * high_area.y - low * low_area.y;
  gradient.z += high * high_area.z - low * low_area.z;
}

/// How a face gradient is made: d is the vector from the left centre to the right one; n its unit normal. The part of the mean
/// gradient along d gives way to the direct difference, put along n / (n . d).
template <class Real>
struct FaceLine {
  Vector<Real> d;
  Vector<Real> lift;  ///< n / (n . d)
};
template <class Real>
SPINDRIFT_INLINE FaceLine<Real> face_line(const Vector<Real>& d, const Face<Real>& f) {
  const Real inverse = 1.0 / (d.x * f.nx + d.y * f.ny + d.z * f.nz);
  return {d, {f.nx * inverse, f.ny * inverse, f.nz * inverse}};
}
template <class Real>
SPINDRIFT_INLINE Vector<Real> face_gradient(const Vector<Real>& left, const Vector<Real>& right, const Real& difference,
                                            const FaceLine<Real>& line) {
  const Vector<Real> m = mean(left, right);
  const Real missing = difference - dot(m, line.d);
  return {m.x + missing * line.lift.x, m.y + missing * line.lift.y, m.z + missing * line.lift.z};
}
template <class Real>
SPINDRIFT_INLINE Gradients<Real> face_gradients(const Gradients<Real>& left, const Gradients<Real>& right,
                                                const Primitive<Real>& l, const Primitive<Real>& r, const FaceLine<Real>& line) {
  return {face_gradient(left.u, right.u, r.u - l.u, line), face_gradient(left.v, right.v, r.v - l.v, line),
          face_gradient(left.w, right.w, r.w - l.w, line), face_gradient(left.T, right.T, r.T - l.T, line)};
}
/// Thin layer: nothing but the difference across the face.
template <class Real>
SPINDRIFT_INLINE Gradients<Real> thin_layer_gradients(const Primitive<Real>& l, const Primitive<Real>& r,
                                                      const FaceLine<Real>& line) {
  const auto along = [&](const Real& difference) {
    return Vector<Real>{difference * line.lift.x, difference * line.lift.y, difference * line.lift.z};
  };
  return {along(r.u - l.u), along(r.v - l.v), along(r.w - l.w), along(r.T - l.T)};
}

/// Viscosity and conductivity at a face, of laminar and eddy viscosity [Pa s].
template <class Real>
struct Transport {
  Real mu, conductivity;
};
template <class Real>
SPINDRIFT_INLINE Transport<Real> transport(const IdealGas& gas, const Real& laminar, const Real& eddy) {
  return {laminar + eddy, laminar * (gas.cp() / gas.prandtl) + eddy * (gas.cp() / gas.prandtl_turbulent)};
}

/// Viscous flux out of the left cell, so that it adds to the convective one; u, v, w are the face's velocities.
/// `turbulent_pressure` is 2/3 rho k where a model carries k [Pa], else 0.
template <class Real>
SPINDRIFT_INLINE Conserved<Real> viscous_flux(const Transport<Real>& t, const Gradients<Real>& g, const Real& u, const Real& v,
                                              const Real& w, const Face<Real>& f, const Real& turbulent_pressure = Real(0.0)) {
  const Real spread = (2.0 / 3.0) * (g.u.x + g.v.y + g.w.z), shear = t.mu * f.area;
  // Rows of the stress tensor times n: mu (grad u + grad u^T - 2/3 div u) n - 2/3 rho k n.
  const Real bulk = shear * spread + turbulent_pressure * f.area;
  const Real tx = shear * (2.0 * g.u.x * f.nx + (g.u.y + g.v.x) * f.ny + (g.u.z + g.w.x) * f.nz) - bulk * f.nx;
  const Real ty = shear * ((g.u.y + g.v.x) * f.nx + 2.0 * g.v.y * f.ny + (g.v.z + g.w.y) * f.nz) - bulk * f.ny;
  const Real tz = shear * ((g.u.z + g.w.x) * f.nx + (g.v.z + g.w.y) * f.ny + 2.0 * g.w.z * f.nz) - bulk * f.nz;
  const Real heat = t.conductivity * f.area * (g.T.x * f.nx + g.T.y * f.ny + g.T.z * f.nz);
  return {Real(0.0), -tx, -ty, -tz, -(tx * u + ty * v + tz * w + heat)};
}

}  // namespace spindrift::gas
