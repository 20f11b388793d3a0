// Dual numbers: a value with its derivatives in n directions, carried through any kernel templated on Real. Gives the exact
// Jacobian of a flux (n = 10), or the product of a Jacobian and a vector (n = 1), without a step size to choose. Forward
// differentiation after Griewank & Walther (2008), Evaluating Derivatives, ch. 3. At a selection (max, select) it follows the
// branch taken. Called by kernels/gas/jacobians.hpp and src/aero/flow; tested in tests/kernels/base/dual_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "kernels/base/wide_math.hpp"

namespace spindrift {

template <class Real, int n>
struct Dual {
  Real value;
  Real d[n];

  Dual() = default;
  SPINDRIFT_INLINE Dual(const Real& v) : value(v) {
    for (int k = 0; k < n; ++k) d[k] = Real(0.0);
  }
  template <class S>
  requires(std::is_arithmetic_v<S> && !std::same_as<S, Real>) SPINDRIFT_INLINE Dual(S v) : Dual(Real(v)) {}

  /// The value with derivative 1 in direction k.
  static Dual variable(const Real& v, int k) {
    Dual x(v);
    x.d[k] = Real(1.0);
    return x;
  }

  /// f(value) whose slope is f'(value).
  SPINDRIFT_INLINE Dual chain(const Real& f, const Real& slope) const {
    Dual r;
    r.value = f;
    for (int k = 0; k < n; ++k) r.d[k] = slope * d[k];
    return r;
  }

  friend SPINDRIFT_INLINE Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value + b.value;
    for (int k = 0; k < n; ++k) r.d[k] = a.d[k] + b.d[k];
    return r;
  }
  friend SPINDRIFT_INLINE Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value - b.value;
    for (int k = 0; k < n; ++k) r.d[k] = a.d[k] - b.d[k];
    return r;
  }
  friend SPINDRIFT_INLINE Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value * b.value;
    for (int k = 0; k < n; ++k) r.d[k] = a.d[k] * b.value + a.value * b.d[k];
    return r;
  }
  friend SPINDRIFT_INLINE Dual operator/(const Dual& a, const Dual& b) {
    const Real inverse = 1.0 / b.value;
    Dual r;
    r.value = a.value / b.value;
    for (int k = 0; k < n; ++k) r.d[k] = (a.d[k] - r.value * b.d[k]) * inverse;
    return r;
  }
  SPINDRIFT_INLINE Dual operator-() const { return chain(-value, Real(-1.0)); }
  SPINDRIFT_INLINE Dual& operator+=(const Dual& b) { return *this = *this + b; }
  SPINDRIFT_INLINE Dual& operator-=(const Dual& b) { return *this = *this - b; }
  SPINDRIFT_INLINE Dual& operator*=(const Dual& b) { return *this = *this * b; }
  friend auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend auto operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend auto operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend auto operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

  // With a constant: no products with zero.
  template <class S>
  requires(std::is_arithmetic_v<S>) friend SPINDRIFT_INLINE Dual operator*(S a, const Dual& b) {
    return b.chain(a * b.value, Real(a));
  }
  template <class S>
  requires(std::is_arithmetic_v<S>) friend SPINDRIFT_INLINE Dual operator*(const Dual& b, S a) {
    return b.chain(a * b.value, Real(a));
  }
  friend SPINDRIFT_INLINE Dual operator*(const Real& a, const Dual& b) requires(!std::is_arithmetic_v<Real>) {
    return b.chain(a * b.value, a);
  }
  friend SPINDRIFT_INLINE Dual operator*(const Dual& b, const Real& a) requires(!std::is_arithmetic_v<Real>) {
    return b.chain(a * b.value, a);
  }
};

template <class Mask, class Real, int n>
SPINDRIFT_INLINE Dual<Real, n> select(const Mask& mask, const Dual<Real, n>& yes, const std::type_identity_t<Dual<Real, n>>& no) {
  Dual<Real, n> r;
  r.value = select(mask, yes.value, no.value);
  for (int k = 0; k < n; ++k) r.d[k] = select(mask, yes.d[k], no.d[k]);
  return r;
}
template <class Real, int n>
Dual<Real, n> max(const Dual<Real, n>& a, const std::type_identity_t<Dual<Real, n>>& b) {
  return select(a.value > b.value, a, b);
}
template <class Real, int n>
Dual<Real, n> min(const Dual<Real, n>& a, const std::type_identity_t<Dual<Real, n>>& b) {
  return select(a.value < b.value, a, b);
}
template <class Real, int n>
Dual<Real, n> abs(const Dual<Real, n>& a) {
  return select(a.value < Real(0.0), -a, a);
}
template <class Real, int n>
Dual<Real, n> sqrt(const Dual<Real, n>& a) {
  const Real root = sqrt(a.value);
  return a.chain(root, 0.5 / root);
}
template <class Real, int n>
Dual<Real, n> log(const Dual<Real, n>& a) {
  return a.chain(log(a.value), 1.0 / a.value);
}
template <class Real, int n>
Dual<Real, n> log1p(const Dual<Real, n>& a) {
  return a.chain(log1p(a.value), 1.0 / (1.0 + a.value));
}
template <class Real, int n>
Dual<Real, n> exp(const Dual<Real, n>& a) {
  const Real e = exp(a.value);
  return a.chain(e, e);
}
template <class Real, int n>
Dual<Real, n> expm1(const Dual<Real, n>& a) {
  const Real e = expm1(a.value);
  return a.chain(e, e + 1.0);
}

/// The number without its derivatives.
template <class Real, int n>
const Real& value_of(const Dual<Real, n>& x) {
  return x.value;
}

}  // namespace spindrift
