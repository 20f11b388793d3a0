// The geometry of a pair of particles, which every term of the equations shares: separation, relative velocity, kernel slope.
// Convention of Monaghan (1992), Annu. Rev. Astron. Astrophys. 30: x_ij = x_i - x_j, v_ij = v_i - v_j, grad_i W_ij = slope *
// x_ij.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/wide.hpp"

namespace spindrift::sph {

/// A vector of `dim` components; in 2-D scenes x and z. The last component is the vertical one in both.
template <class Real, int dim>
struct Vec {
  Real c[dim];

  Real& operator[](int k) { return c[k]; }
  const Real& operator[](int k) const { return c[k]; }
  friend Vec operator+(Vec a, const Vec& b) {
    for (int k = 0; k < dim; ++k) a.c[k] += b.c[k];
    return a;
  }
  friend Vec operator-(Vec a, const Vec& b) {
    for (int k = 0; k < dim; ++k) a.c[k] -= b.c[k];
    return a;
  }
  friend Vec operator*(const Real& s, Vec a) {
    for (int k = 0; k < dim; ++k) a.c[k] *= s;
    return a;
  }
  Vec& operator+=(const Vec& b) { return *this = *this + b; }
  Vec& operator-=(const Vec& b) { return *this = *this - b; }
};

template <class Real, int dim>
SPINDRIFT_INLINE Real dot(const Vec<Real, dim>& a, const Vec<Real, dim>& b) {
  Real s = a[0] * b[0];
  for (int k = 1; k < dim; ++k) s += a[k] * b[k];
  return s;
}

template <class Real, int dim>
struct Pair {
  Vec<Real, dim> x, v;  ///< x_i - x_j [m], v_i - v_j [m/s]
  Real r2;              ///< |x|^2, kept above a tiny number so that a particle paired with itself yields zero, not NaN [m2]
  Real v_dot_x;         ///< [m2/s]
  Real slope;           ///< W'(r)/r <= 0, zero beyond the support [1/m^(dim+2)]
};

template <class Kernel, class Real, int dim>
SPINDRIFT_INLINE Pair<Real, dim> make_pair(const Kernel& kernel, const Vec<Real, dim>& x_ij, const Vec<Real, dim>& v_ij) {
  using std::max;
  const Real r2 = max(dot(x_ij, x_ij), Real(1e-30));
  return {x_ij, v_ij, r2, dot(v_ij, x_ij), kernel.slope(r2)};
}

/// 0.01 h^2 of Monaghan (1992), which keeps 1/r^2 finite where particles meet.
template <class Scalar>
constexpr Scalar softening(Scalar h) {
  return Scalar(0.01) * h * h;
}

/// The same, and `inverse` 1 / ((rho_i + rho_j)(r^2 + 0.01 h^2)), which viscosities and density diffusions share.
template <class Kernel, class Real, int dim>
SPINDRIFT_INLINE Pair<Real, dim> make_pair(const Kernel& kernel, const Vec<Real, dim>& x_ij, const Vec<Real, dim>& v_ij,
                                           const Real& density_sum, Real& inverse) {
  using std::max;
  const Real r2 = max(dot(x_ij, x_ij), Real(1e-30));
  const Real softened = r2 + Real(softening(scalar_of<Real>(kernel.h())));
  const auto both = kernel.slope_and_reciprocal(r2, Real(density_sum * softened));
  inverse = both.reciprocal;
  return {x_ij, v_ij, r2, dot(v_ij, x_ij), both.slope};
}

}  // namespace spindrift::sph
