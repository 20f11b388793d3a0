// What makes turbulence closures of the eddy-viscosity family interchangeable: transported quantities per mass with a source,
// diffusion coefficients, an eddy viscosity, and values on walls and in the far field. All pointwise, templated on Real.
// The transport itself (mass flux times the upwind value, diffusion by gradients) is the same for all and stands here.
// Called by kernels/turbulence/model_*.hpp and src/aero/flow; tested in tests/kernels/turbulence.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <string_view>

#include "kernels/base/dual.hpp"
#include "kernels/gas/viscous.hpp"

namespace spindrift::turbulence {

using gas::Vector;

/// What a model sees of the flow in a cell: density [kg/m3], laminar viscosity [Pa s], distance to the nearest wall [m],
/// gradients of velocity [1/s] and density [kg/m4]; models that resolve eddies (`sees_grid`) also the cell's longest side and the
/// cube root of its volume [m].
template <class Real>
struct Flow {
  Real rho, mu, distance;
  Vector<Real> u, v, w;
  Vector<Real> density_gradient{Real(0.0), Real(0.0), Real(0.0)};
  Real longest_side = Real(0.0), width = Real(0.0);
};

/// Places for the quantities of a model; one that transports nothing has one unused.
constexpr int slots(int equations) { return equations > 0 ? equations : 1; }

/// n transported quantities per mass in a cell and their gradients.
template <class Real, int n>
struct Turbulence {
  Real q[slots(n)];
  Vector<Real> gradient[slots(n)];
};

/// What the model gives the flow and its own diffusion: eddy viscosity [Pa s], 2/3 rho k [Pa] (0 where the model carries no k or
/// leaves it out of the momentum), diffusion coefficients of its quantities [Pa s].
template <class Real, int n>
struct Closure {
  Real eddy_viscosity, pressure;
  Real diffusivity[slots(n)];
};

/// Rate of rho q per volume and time.
template <class Real, int n>
struct Source {
  Real rate[slots(n)];
};
/// The part of d(rate)/dq that an implicit step may use: eigenvalues with no positive real part.
template <class Real, int n>
struct SourceJacobian {
  Real m[slots(n)][slots(n)];
};

/// What a model of n = M::equations quantities per mass needs for their transport. `lowest` are bounds that updates must respect
/// (an update is shortened, not cut); wall values are for a cell at `distance` from it (at the face); far_field values follow
/// from the stream's properties.
template <class M, class Real = double>
concept Transporting = requires(const M model, const Flow<Real>& flow, const Turbulence<Real, M::equations>& q, Real x) {
  { model.source(flow, q) } -> std::same_as<Source<Real, M::equations>>;
  { model.source_jacobian(flow, q) } -> std::same_as<SourceJacobian<Real, M::equations>>;
  { model.wall(x, x) } -> std::same_as<std::array<Real, M::equations>>;
  { model.far_field(1.0, 1.0, 1.0) } -> std::same_as<std::array<double, M::equations>>;
  { M::lowest } -> std::convertible_to<std::array<double, M::equations>>;
};

/// A closure: an eddy viscosity from the flow and, where there are any, from transported quantities.
template <class M, class Real = double>
concept TurbulenceModel = requires(const M model, const Flow<Real>& flow, const Turbulence<Real, M::equations>& q) {
  { model.closure(flow, q) } -> std::same_as<Closure<Real, M::equations>>;
  { M::name } -> std::convertible_to<std::string_view>;
  { M::sees_grid } -> std::convertible_to<bool>;
}
&&(M::equations == 0 || Transporting<M, Real>);

/// |curl u| and sqrt(2 S:S) [1/s].
template <class Real>
SPINDRIFT_INLINE Real vorticity(const Flow<Real>& f) {
  const Real x = f.w.y - f.v.z, y = f.u.z - f.w.x, z = f.v.x - f.u.y;
  return sqrt(x * x + y * y + z * z + 1e-60);  // the square root has a slope at rest too
}
template <class Real>
SPINDRIFT_INLINE Real strain(const Flow<Real>& f) {
  const Real xy = f.u.y + f.v.x, xz = f.u.z + f.w.x, yz = f.v.z + f.w.y;
  return sqrt(2.0 * (f.u.x * f.u.x + f.v.y * f.v.y + f.w.z * f.w.z) + xy * xy + xz * xz + yz * yz + 1e-60);
}

/// Convective flux of rho q through a face that mass flux [kg/s] passes (out of the left cell), first-order or reconstructed
/// values.
template <class Real>
SPINDRIFT_INLINE Real convected(const Real& mass, const Real& left, const Real& right) {
  const Real zero(0.0);
  return max(mass, zero) * left + min(mass, zero) * right;
}
/// Diffusive flux out of the left cell, of the mean diffusivity of both cells and the gradient on the face.
template <class Real>
SPINDRIFT_INLINE Real diffused(const Real& diffusivity, const Vector<Real>& gradient, const gas::Face<Real>& f) {
  return -diffusivity * f.area * (gradient.x * f.nx + gradient.y * f.ny + gradient.z * f.nz);
}

/// d(rate)/dq by dual numbers, nothing left out, the gradients held.
template <class Model, class Real>
SourceJacobian<Real, Model::equations> exact_source_jacobian(const Model& model, const Flow<Real>& flow,
                                                             const Turbulence<Real, Model::equations>& t) {
  constexpr int n = Model::equations;
  using D = Dual<Real, n>;
  const auto held = [](const Vector<Real>& a) { return Vector<D>{D(a.x), D(a.y), D(a.z)}; };
  const Flow<D> f{
      D(flow.rho),          D(flow.mu),   D(flow.distance), held(flow.u), held(flow.v), held(flow.w), held(flow.density_gradient),
      D(flow.longest_side), D(flow.width)};
  Turbulence<D, n> q;
  for (int k = 0; k < n; ++k) q.q[k] = D::variable(t.q[k], k), q.gradient[k] = held(t.gradient[k]);
  const Source<D, n> s = model.source(f, q);
  SourceJacobian<Real, n> J;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) J.m[row][column] = s.rate[row].d[column];
  return J;
}

}  // namespace spindrift::turbulence
